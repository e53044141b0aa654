#pragma once
// What splatters and mists: marked instances of one frame. Filled by systems/splatter.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace petrichor {

struct FrameSplatter {
  std::vector<std::uint32_t> instances;  // indices in Frame::instances
};

}  // namespace petrichor
