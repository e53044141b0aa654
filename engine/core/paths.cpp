#include "engine/core/paths.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>
#include <utility>

namespace petrichor {
namespace {

namespace fs = std::filesystem;

std::string reason(int error) {
  return std::error_code(error, std::generic_category()).message();
}

fs::path environment_path(const char* name) {
  const char* value = std::getenv(name);
  return value ? fs::path(value) : fs::path();
}

fs::path user_dir(const char* variable, const char* below_home) {
  if (const fs::path base = environment_path(variable); base.is_absolute()) return base / "petrichor";
  if (const fs::path home = environment_path("HOME"); home.is_absolute()) return home / below_home / "petrichor";
  std::error_code ignored;
  fs::path temporary = fs::temp_directory_path(ignored);
  if (temporary.empty()) temporary = "/tmp";
  return temporary / fmt::format("petrichor-{}", ::getuid());
}

// What to do about an error of writing, where there is something to say.
const char* advice(int error) {
  switch (error) {
    case EACCES:
    case EPERM:
    case EROFS:
      return "; choose a folder that you may write to";
    case ENOSPC:
    case EDQUOT:
      return "; free some space or choose another disk";
    case EISDIR:
      return "; name a file, not a folder";
    default:
      return "";
  }
}

tl::unexpected<Error> cannot_write(const fs::path& path, int error) {
  return failure(fmt::format("cannot write {}: {}{}", path.string(), reason(error), advice(error)));
}

// Closes on every way out.
struct Descriptor {
  int number;
  explicit Descriptor(int n) : number(n) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
  int close() { return ::close(std::exchange(number, -1)); }
};

// 0 or errno.
int write_all(int descriptor, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return errno;
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return 0;
}

Result<void> write_in_place(const fs::path& path, std::span<const std::byte> bytes) {
  Descriptor file(::open(path.c_str(), O_WRONLY | O_CLOEXEC));
  if (file.number < 0) return cannot_write(path, errno);
  if (const int error = write_all(file.number, bytes)) return cannot_write(path, error);
  if (file.close() != 0) return cannot_write(path, errno);
  return {};
}

}  // namespace

fs::path executable_folder() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  return error ? fs::path() : program.parent_path();
}

std::vector<fs::path> data_roots() {
  std::vector<fs::path> roots;
  const auto add = [&](const fs::path& root) {
    if (root.empty()) return;
    const fs::path whole = fs::absolute(root).lexically_normal();
    if (std::find(roots.begin(), roots.end(), whole) == roots.end()) roots.push_back(whole);
  };
  add(environment_path("PETRICHOR_DATA"));
  if (const fs::path folder = executable_folder(); !folder.empty()) {
    add(folder);
    add(folder / ".." / "share" / "petrichor");
  }
#ifdef PETRICHOR_SOURCE_DIR
  add(PETRICHOR_SOURCE_DIR);
#endif
  return roots;
}

Result<fs::path> find_data(const fs::path& relative) {
  std::error_code ignored;
  std::string looked;
  if (relative.is_absolute()) {
    if (fs::exists(relative, ignored)) return relative;
    return failure(fmt::format("{} does not exist", relative.string()));
  }
  for (const fs::path& root : data_roots()) {
    if (fs::path found = root / relative; fs::exists(found, ignored)) return found;
    looked += fmt::format("\n  {}", root.string());
  }
  return failure(fmt::format("cannot find {}; looked in{}\nSet PETRICHOR_DATA to the folder that holds it.",
                             relative.string(), looked));
}

fs::path user_config_dir() {
  return user_dir("XDG_CONFIG_HOME", ".config");
}
fs::path user_cache_dir() {
  return user_dir("XDG_CACHE_HOME", ".cache");
}
fs::path user_state_dir() {
  return user_dir("XDG_STATE_HOME", ".local/state");
}

Result<std::string> read_whole_file(const fs::path& path) {
  const auto cannot = [&](int error) {
    return failure(fmt::format("cannot read {}: {}", path.string(), reason(error)));
  };
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.number < 0) return cannot(errno);
  struct stat info {};
  if (::fstat(file.number, &info) != 0) return cannot(errno);
  if (S_ISDIR(info.st_mode)) return cannot(EISDIR);
  std::string text;
  if (S_ISREG(info.st_mode)) text.reserve(static_cast<std::size_t>(info.st_size) + 1);
  char block[1 << 16];
  for (;;) {
    const ssize_t got = ::read(file.number, block, sizeof block);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return cannot(errno);
    if (got == 0) return text;
    text.append(block, static_cast<std::size_t>(got));
  }
}

Result<void> write_whole_file(const fs::path& asked, std::span<const std::byte> bytes) {
  std::error_code error;
  const fs::file_status status = fs::status(asked, error);
  if (fs::is_directory(status)) return cannot_write(asked, EISDIR);
  if (fs::exists(status) && !fs::is_regular_file(status)) return write_in_place(asked, bytes);
  // Through a symbolic link, so that the link stays and its target changes.
  fs::path path = asked;
  for (int links = 0; fs::is_symlink(fs::symlink_status(path, error)); ++links) {
    if (links == 40) return cannot_write(asked, ELOOP);  // as many as Linux follows
    path = path.parent_path() / fs::read_symlink(path, error);
    if (error) return cannot_write(asked, error.value());
  }
  if (path.has_parent_path()) {
    fs::create_directories(path.parent_path(), error);
    if (error) return cannot_write(path, error.value());
  }
  static std::atomic<unsigned> serial{0};
  fs::path beside = path;
  beside += fmt::format(".{}-{}.part", ::getpid(), serial++);
  Descriptor file(::open(beside.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (file.number < 0) return cannot_write(path, errno);
  int failed = 0;
  if (fs::exists(status)) {  // the new file keeps the old one's permissions
    if (::fchmod(file.number, static_cast<mode_t>(status.permissions()) & 07777) != 0) failed = errno;
  }
  if (!failed) failed = write_all(file.number, bytes);
  if (file.close() != 0 && !failed) failed = errno;
  if (!failed && ::rename(beside.c_str(), path.c_str()) != 0) failed = errno;
  if (failed) {
    ::unlink(beside.c_str());
    return cannot_write(path, failed);
  }
  return {};
}

Result<void> write_whole_file(const fs::path& path, std::string_view text) {
  return write_whole_file(path, std::as_bytes(std::span(text.data(), text.size())));
}

}  // namespace petrichor
