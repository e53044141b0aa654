#pragma once
// The water that stands in one frame. Filled by systems/puddle.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace petrichor {

struct FramePuddles {
  // A hollow in view, with or without water.
  struct Puddle {
    glm::mat4 world_from_puddle{1.0f};  // rigid; y = 0 is the brim
    glm::vec2 half_size_m{0.5f};        // along its x and z
    float level_m = 0.0f;               // of the water above the hollow's deepest point; 0: dry
    float depth_m = 0.0f;               // of the hollow: the brim's level
    float ripple_influence = 1.0f;      // p_i, s_o, theta_o
    float ripple_scale = 1.0f, ripple_turn_rad = 0.0f;
    bool by_height = false;  // depth by the ground's height; else by the material's mask
  };
  std::vector<Puddle> puddles;  // the nearest first
  float published = 0.0f;       // share of the rung masks: all are full, and ripples blend by the mask as printed
  bool any_water = false;       // stands in view
};

}  // namespace petrichor
