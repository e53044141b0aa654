#pragma once
// The optics of drops on the GPU, shared by all techniques: the phase function as a buffer, and what drops show of the
// sky.

#include <array>
#include <memory>
#include <vector>

#include "engine/gpu/objects.hpp"
#include "engine/gpu/shader.hpp"
#include "systems/frame.hpp"

namespace petrichor {

struct StreakTable;     // systems/rainfall/streaks/table.hpp
struct StreakTableGpu;  // systems/rainfall/streaks/gpu.hpp

// Of drops, or of flakes.
struct ParticleOptics {
  Buffer phase;  // floats, RAIN_PHASE_BINS; binding RAIN_OPTICS_BINDING
  FrameSky sky;  // that ambient was made for
  bool known = false;
  std::array<glm::vec3, 4> ambient{};
};
struct RainOptics : ParticleOptics {
  std::shared_ptr<const StreakTableGpu> streaks;  // see bind_streak_table
  std::shared_ptr<const StreakTable> streaks_of;
};

// As systems/sky.glsl; cd/m2 along a unit direction.
glm::dvec3 sky_radiance(const FrameSky&, const glm::dvec3& direction);
// Makes what is missing or stale, and binds the phase function.
void bind_optics(ParticleOptics&, const Frame&, std::vector<float> (*make_phase)(),
                 std::array<glm::vec3, 4> (*make_ambient)(const FrameSky&));
void bind_rain_optics(RainOptics&, const Frame&);
// Uniform ambient[4] of systems/drops/ambient.glsl; the program must be in use.
void set_ambient(const ParticleOptics&, const Program&);

}  // namespace petrichor
