#pragma once
// Times of named spans of GPU work. On a real GPU, timestamp queries, read some frames later without a
// stall. On software OpenGL those mean nothing: there, in a profiling frame, wall time between glFinishes.

#include <string>
#include <string_view>
#include <vector>

#include "engine/gpu/objects.hpp"

namespace petrichor {

struct Timing {
  std::string name;
  double milliseconds;
};

class FrameTimer {
 public:
  explicit FrameTimer(bool software_gl);
  ~FrameTimer();
  FrameTimer(const FrameTimer&) = delete;
  FrameTimer& operator=(const FrameTimer&) = delete;

  // profile: on software OpenGL, whether this frame pays for glFinish around spans. On hardware ignored.
  void begin_frame(bool profile);
  void begin(std::string_view name);
  void end();
  void end_frame();
  // The newest frame whose times are all known; empty where none is. Each frame is handed out once.
  std::vector<Timing> collect();
  bool gpu_times_are_real() const { return !software_; }

 private:
  struct Impl;
  bool software_;
  Impl* impl_;
};

}  // namespace petrichor
