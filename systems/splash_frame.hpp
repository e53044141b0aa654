#pragma once
// The splashes of one frame. Filled by systems/splash.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace petrichor {

struct FrameSplashes {
  float reach_m = 20.0f;               // single splashes out to here
  std::int32_t most_splashes = 20000;  // alive at once, on average; beyond it the less important are left out
};

}  // namespace petrichor
