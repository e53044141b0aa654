#pragma once
// Where the city holds and sheds water. Marked in the content now; the systems that drip, fill and run
// come with later work.
#include <glm/glm.hpp>

namespace petrichor {

// An edge that water drips from: a line of length_m along the entity's +x.
struct DripSource {
  float length_m = 1.0f;
  float catchment_depth_m = 0.3f;  // roof or ledge behind the edge, measured along the fall of water
  float lip_radius_mm = 2.0f;
};

// A hollow where water stands: a rectangle in the entity's x and z.
struct Puddle {
  glm::vec2 size_m{1.0f, 1.0f};
  float maximum_depth_mm = 12.0f;
  float catchment_ratio = 3.0f;  // catchment area over puddle area
};

// A glass surface that droplets sit on and run down: a rectangle in the entity's x and y.
struct GlassPane {
  glm::vec2 size_m{1.0f, 1.0f};
  float advancing_angle_deg = 60.0f;
  float receding_angle_deg = 30.0f;
};

}  // namespace petrichor
