#pragma once
// Planar mirrors and moving probes of one frame. Filled by systems/mirror.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace petrichor {

struct FrameMirrors {
  struct Probe {
    glm::dvec3 place_m{0.0};
    float radius_m = 3.0f;  // surfaces within it mirror this probe
  };
  std::vector<Probe> probes;
};

}  // namespace petrichor
