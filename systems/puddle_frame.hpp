#pragma once
// The water that stands in one frame. Filled by systems/puddle.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace petrichor {

struct FramePuddles {
  struct Puddle {
    glm::mat4 world_from_puddle{1.0f};  // rigid
    glm::vec2 half_size_m{0.5f};        // along its x and z
    float level_m = 0.0f;               // of the water above the hollow's deepest point
    float depth_m = 0.0f;               // of the hollow: the spill's level
  };
  std::vector<Puddle> puddles;
};

}  // namespace petrichor
