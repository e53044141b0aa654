#pragma once
// The drips of one frame. Filled by systems/drip; splashes and ripples read the landings.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace petrichor {

// A drop in the air, or hanging.
struct FrameDrip {
  glm::dvec3 place_m;      // world, when the shutter closes
  glm::vec3 velocity_mps;  // 0: it hangs
  float diameter_mm;
  float stretch;       // height over width of its shape
  std::uint32_t seed;  // of its looks
};

// A drop that has landed within the last landing_memory_s.
struct DripLanding {
  glm::dvec3 place_m;  // world, on the surface
  double time_s;       // when
  float diameter_mm;
  glm::vec3 velocity_mps;  // at the impact
  std::uint32_t seed;
};
constexpr double landing_memory_s = 1.0;

struct FrameDrips {
  std::vector<FrameDrip> drops;
  std::vector<DripLanding> landings;  // by time, the oldest first
};

}  // namespace petrichor
