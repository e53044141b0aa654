#pragma once
// The passes that light surfaces. All are pure functions of the frame: what they keep between frames (shadow maps,
// captures) is only ever the same again.

#include <memory>
#include <vector>

#include "engine/graph/graph.hpp"

namespace petrichor {

struct LightingState;  // systems/lighting/state.hpp

// shadow_maps:  shadow_atlas (rgba32f 2048x2048, persistent), redrawn where a caster or the scene changed.
// environment:  environment (rgba16f 448x65): the captured surroundings, read by environment.glsl.
// probes:       probes (rgba16f 448x65, 4 layers): what moving objects mirror (frame.mirrors), read by
//               systems/mirror/probe.glsl; binds its block.
// light_lists:  light_lists (rgba32ui, scale 1/8): the lights that each tile of pixels sees; also binds the block of
//               chosen lights (CHOSEN_LIGHTS_BINDING) for the passes after it.
// shade:        colour (rgba16f), cd/m2: every surface lit, and the sky where there is none.
// The state is for tests; leave it empty.
std::vector<PassOffer> lighting_passes(std::shared_ptr<LightingState> state = {});

}  // namespace petrichor
