#pragma once
// The optics of drops on the GPU, shared by all techniques: the phase function as a buffer, and what drops show of the
// sky.

#include <array>

#include "engine/gpu/objects.hpp"
#include "engine/gpu/shader.hpp"
#include "systems/frame.hpp"

namespace petrichor {

struct RainOptics {
  Buffer phase;  // floats, RAIN_PHASE_BINS; binding RAIN_OPTICS_BINDING
  FrameSky sky;  // that ambient was made for
  bool known = false;
  std::array<glm::vec3, 4> ambient{};
};

// Makes what is missing or stale, and binds the phase function.
void bind_rain_optics(RainOptics&, const Frame&);
// Uniform ambient[4] of systems/rainfall/ambient.glsl; the program must be in use.
void set_rain_ambient(const RainOptics&, const Program&);

}  // namespace petrichor
