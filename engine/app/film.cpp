#include "engine/app/film.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <sstream>
#include <vector>

extern char** environ;

namespace petrichor {
namespace {

namespace fs = std::filesystem;

bool on_path(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((fs::path(folder.empty() ? "." : folder) / program).c_str(), X_OK) == 0) return true;
  return false;
}

struct Descriptor {
  int number;
  ~Descriptor() {
    if (number >= 0) close(number);
  }
};

class FilmRecorder final : public Recorder {
 public:
  FilmRecorder(fs::path file, int width, int height) : file_(std::move(file)), width_(width), height_(height) {
    beside_ = file_;
    beside_.replace_filename("." + file_.stem().string() + ".part" + file_.extension().string());
    log_ = beside_;
    log_ += ".log";
  }

  ~FilmRecorder() override {
    if (pipe_ >= 0) close(pipe_);
    if (child_ > 0) {
      kill(child_, SIGTERM);
      waitpid(child_, nullptr, 0);
    }
    std::error_code ignored;
    fs::remove(beside_, ignored);
    fs::remove(log_, ignored);
  }

  Result<void> start(double fps) {
    if (!on_path("ffmpeg"))
      return failure(
          fmt::format("{}: ffmpeg is not installed, so no film can be written. Install the package ffmpeg, or write "
                      "pictures: --out {}",
                      file_.string(), (file_.parent_path() / (file_.stem().string() + "_%04d.png")).string()));
    // ffmpeg would say it less well, and later.
    const Descriptor writable{open(log_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644)};
    if (writable.number < 0)
      return failure(fmt::format("cannot write {}: {}; choose a folder that you may write to", file_.string(),
                                 std::strerror(errno)));
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
      return failure(fmt::format("cannot make a pipe to ffmpeg: {}", std::strerror(errno)));
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, writable.number, STDERR_FILENO);
    // In a process group of its own: Ctrl-C is ours to handle.
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    posix_spawnattr_setpgroup(&attributes, 0);
    const bool webm = file_.extension() == ".webm";
    std::vector<std::string> words = {
        "ffmpeg",
        "-nostdin",
        "-hide_banner",
        "-loglevel",
        "error",
        "-y",
        "-f",
        "rawvideo",
        "-pixel_format",
        "rgba",
        "-video_size",
        fmt::format("{}x{}", width_, height_),
        "-framerate",
        fmt::format("{}", fps),
        "-i",
        "pipe:0",
        // Rows come from the bottom; 4:2:0 needs even sides.
        "-vf",
        "vflip,pad=ceil(iw/2)*2:ceil(ih/2)*2:color=black,scale=out_color_matrix=bt709:out_range=tv",
        "-pix_fmt",
        "yuv420p",
        "-color_primaries",
        "bt709",
        "-color_trc",
        "bt709",
        "-colorspace",
        "bt709",
    };
    if (webm)
      words.insert(words.end(), {"-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0"});
    else
      words.insert(words.end(), {"-c:v", "libx264", "-crf", "16", "-movflags", "+faststart"});
    words.push_back(beside_.string());
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    const int error = posix_spawnp(&child_, "ffmpeg", &actions, &attributes, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    posix_spawnattr_destroy(&attributes);
    close(ends[0]);
    pipe_ = ends[1];
    if (error != 0) {
      child_ = -1;
      return failure(fmt::format("ffmpeg cannot be started: {}", std::strerror(error)));
    }
    std::signal(SIGPIPE, SIG_IGN);  // a dead ffmpeg is an error of write(), not our end
    return {};
  }

  Result<void> add(std::int64_t, const Picture& picture) override {
    std::span<const std::uint8_t> rest = picture.rgba8;
    while (!rest.empty()) {
      const ssize_t sent = write(pipe_, rest.data(), rest.size());
      if (sent < 0 && errno == EINTR) continue;
      if (sent <= 0) return end();
      rest = rest.subspan(static_cast<std::size_t>(sent));
    }
    return {};
  }

  Result<void> finish() override {
    if (auto ended = end(); !ended) return ended;
    std::error_code error;
    fs::rename(beside_, file_, error);
    if (error) return failure(fmt::format("{}: cannot be written: {}", file_.string(), error.message()));
    return {};
  }

 private:
  Result<void> end() {
    close(pipe_);
    pipe_ = -1;
    int status = 0;
    waitpid(child_, &status, 0);
    child_ = -1;
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
    std::stringstream said;
    said << std::ifstream(log_).rdbuf();
    return failure(
        fmt::format("{}: ffmpeg failed: {}", file_.string(), said.str().empty() ? "it said nothing" : said.str()));
  }

  fs::path file_, beside_, log_;
  int width_, height_;
  int pipe_ = -1;
  pid_t child_ = -1;
};

}  // namespace

Result<std::unique_ptr<Recorder>> make_film_recorder(const fs::path& file, int width, int height, double fps) {
  auto recorder = std::make_unique<FilmRecorder>(file, width, height);
  if (auto started = recorder->start(fps); !started) return tl::unexpected(started.error());
  return recorder;
}

}  // namespace petrichor
