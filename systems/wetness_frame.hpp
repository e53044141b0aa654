#pragma once
// How wet the world is in one frame. Filled by systems/wetness.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace petrichor {

struct FrameWetness {
  float film_mm = 0.0f;  // on open level ground
};

}  // namespace petrichor
