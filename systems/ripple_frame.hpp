#pragma once
// The ripples of one frame. Filled by systems/ripple.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace petrichor {

struct FrameRipples {
  double time_s = 0.0;
};

}  // namespace petrichor
