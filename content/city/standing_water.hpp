#pragma once
// Where rain stands in the streets: the carriageway's height field filled to its spill levels.

#include <glm/glm.hpp>
#include <vector>

namespace petrichor::city {

inline constexpr float water_cell_m = 0.25f;

struct Basin {
  glm::vec2 minimum_m{0.0f};  // x and z
  glm::vec2 maximum_m{0.0f};
  float maximum_depth_m = 0.0f;
  float area_m2 = 0.0f;
  float level_m = 0.0f;
};

struct StandingWater {
  int size = 0;                 // cells along x and along z, from -street_end_m
  std::vector<float> ground_m;  // at cell centres; infinite off the carriageway
  std::vector<float> level_m;   // of the water surface; the ground where dry
  std::vector<Basin> basins;    // largest first
  std::vector<glm::vec2> gullies;

  float depth_at(float x, float z) const;  // bilinear
};

// Priority-Flood (Barnes, Lehman, Mulla 2014, algorithm 1): water leaves at the gullies and the street ends.
StandingWater flood_streets();

}  // namespace petrichor::city
