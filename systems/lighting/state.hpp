#pragma once
// What the passes of light keep on the GPU.

#include "engine/gpu/objects.hpp"
#include "systems/lighting/environment.hpp"
#include "systems/lighting/probes.hpp"
#include "systems/lighting/shadow_maps.hpp"

namespace petrichor {

struct LightingState {
  ShadowMaps shadows;
  Environment environment;
  Probes probes;
  Buffer chosen_lights;
  Buffer tiles;              // TILES_BINDING
  unsigned list_length = 0;  // tiles that each of its lists can hold
};

}  // namespace petrichor
