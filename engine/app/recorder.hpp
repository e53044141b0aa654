#pragma once
// Where rendered frames go: PNG or EXR pictures (OpenImageIO), or a film (a pipe to ffmpeg). Every file is
// written beside its name and renamed when whole, so that a failure never leaves half of one.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "engine/core/result.hpp"

namespace petrichor {

enum class RecordKind { png, exr, film };

struct RecordTarget {
  RecordKind kind;
  std::filesystem::path file;  // may hold one %d or %0Nd, for pictures
  bool numbered = false;       // whether it does
};

// Decides by the extension and checks the pattern. `frames` is how many are to come: more than one into one
// unnumbered picture is an error.
Result<RecordTarget> record_target(const std::filesystem::path& out, std::int64_t frames);
std::filesystem::path numbered_file(const std::filesystem::path& pattern, std::int64_t number);

// A picture as it is read back: rows from the bottom, as OpenGL gives them.
struct Picture {
  int width = 0, height = 0;
  std::span<const std::uint8_t> rgba8;  // png and film: width * height * 4
  std::span<const float> rgba32f;       // exr: linear, width * height * 4
};

class Recorder {
 public:
  virtual ~Recorder() = default;
  virtual Result<void> add(std::int64_t frame_number, const Picture&) = 0;
  // Makes the file whole. Without it (an error on the way) nothing is left behind.
  virtual Result<void> finish() = 0;
};

Result<std::unique_ptr<Recorder>> make_recorder(const RecordTarget&, int width, int height, double fps);

}  // namespace petrichor
