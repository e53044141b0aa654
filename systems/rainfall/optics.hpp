#pragma once
// The optics of drops on the GPU, shared by all techniques: the phase function as a buffer, and what drops show of the
// sky.

#include <array>
#include <memory>

#include "engine/gpu/objects.hpp"
#include "engine/gpu/shader.hpp"
#include "systems/frame.hpp"

namespace petrichor {

struct StreakTable;     // systems/rainfall/streaks/table.hpp
struct StreakTableGpu;  // systems/rainfall/streaks/gpu.hpp

struct RainOptics {
  Buffer phase;  // floats, RAIN_PHASE_BINS; binding RAIN_OPTICS_BINDING
  FrameSky sky;  // that ambient was made for
  bool known = false;
  std::array<glm::vec3, 4> ambient{};
  std::shared_ptr<const StreakTableGpu> streaks;     // see bind_streak_table
  std::shared_ptr<const StreakTable> streaks_of;
};

// Makes what is missing or stale, and binds the phase function.
void bind_rain_optics(RainOptics&, const Frame&);
// Uniform ambient[4] of systems/rainfall/ambient.glsl; the program must be in use.
void set_rain_ambient(const RainOptics&, const Program&);

}  // namespace petrichor
