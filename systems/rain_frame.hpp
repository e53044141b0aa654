#pragma once
// The falling rain of one frame, as the passes need it. Filled by systems/rainfall.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace petrichor {

// One size class of the drop field (design section 4): it falls as one rigid frame.
struct RainClass {
  float diameter_mm;
  float fall_speed_mps;
  float drops_per_m3;          // now
  float drops_per_m3_maximum;  // of the field that is thinned to drops_per_m3
  float cell_edge_m;
  glm::dvec3 origin_m;         // the class's frame, in the world, at the frame's time
  glm::vec3 velocity_mps;      // wind of this class minus fall
};

struct FrameRain {
  float rain_mm_per_hour = 0.0f;
  std::uint32_t seed = 1;
  float drawn_distance_m = 0.0f;     // after the budget of drops
  std::int32_t maximum_drops = 0;
  float extinction_per_m = 0.0f;     // geometric, of all drops (Q = 1)
  float drawn_extinction_per_m = 0.0f;  // of the classes that are drawn
  glm::vec3 mean_velocity_mps{0.0f};  // mass-weighted: the direction of the occlusion map
  std::vector<RainClass> classes;
};

}  // namespace petrichor
