#pragma once
// Where rain stands in the streets: the carriageway's height field filled to its spill levels.

#include <glm/glm.hpp>
#include <vector>

namespace petrichor::city {

inline constexpr float water_cell_m = 0.25f;

// A hollow as it is when full.
struct Basin {
  glm::vec2 minimum_m{0.0f};  // x and z
  glm::vec2 maximum_m{0.0f};
  float maximum_depth_m = 0.0f;
  float area_m2 = 0.0f;
  float volume_m3 = 0.0f;
  float catchment_m2 = 0.0f;  // of the street, its own area included: what runs into it before any other basin
  float level_m = 0.0f;       // of its brim
};

struct StandingWater {
  int size = 0;                 // cells along x and along z, from -street_end_m
  std::vector<float> ground_m;  // at cell centres; infinite off the carriageway
  std::vector<float> level_m;   // of the water surface when all is full; the ground where none can stand
  std::vector<float> depth_m;   // of the ground below the brim of its basin; negative beside one, no_puddle_m elsewhere
  std::vector<Basin> basins;    // those that matter, largest first
  std::vector<glm::vec2> gullies;

  float depth_at(float x, float z) const;  // depth_m, bilinear
};

// Water leaves at the gullies and the street ends.
StandingWater flood_streets();

}  // namespace petrichor::city
