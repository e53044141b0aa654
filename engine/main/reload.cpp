#include "engine/main/reload.hpp"

namespace petrichor {
namespace {

std::filesystem::file_time_type time_of(const std::filesystem::path& file) {
  std::error_code error;
  const auto time = std::filesystem::last_write_time(file, error);
  return error ? std::filesystem::file_time_type{} : time;  // gone counts as a change, too
}

}  // namespace

void FileWatch::watch(const std::vector<std::filesystem::path>& files) {
  seen_.clear();
  for (const auto& file : files) seen_.push_back({file, time_of(file)});
}

bool FileWatch::changed() {
  bool any = false;
  for (Seen& seen : seen_) {
    const auto now = time_of(seen.file);
    any |= now != seen.time;
    seen.time = now;
  }
  return any;
}

}  // namespace petrichor
