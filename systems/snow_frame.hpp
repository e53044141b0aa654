#pragma once
// The falling snow of one frame. Filled by systems/rainfall/snow.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace petrichor {

struct SnowClass {
  float diameter_mm;      // largest dimension of the flake
  float fall_speed_mps;
  float flakes_per_m3;    // now
  float base_flakes_per_m3;
  glm::dvec3 origin_m;    // the class's frame, in the world
  glm::vec3 velocity_mps;
};

struct FrameSnow {
  float snow_mm_per_hour = 0.0f;  // of water
  std::uint32_t seed = 1;
  float drawn_distance_m = 0.0f;
  float extinction_per_m = 0.0f;  // geometric, of all flakes
  glm::vec3 mean_velocity_mps{0.0f};
  std::vector<SnowClass> classes;
};

}  // namespace petrichor
