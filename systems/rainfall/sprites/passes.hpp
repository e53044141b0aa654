#pragma once
// Pass rain_sprites: particles in a box about the camera, animated and drawn by compute into the sums of drops, which
// rain_composite lays over the picture.

#include <memory>
#include <vector>

#include "engine/graph/graph.hpp"
#include "systems/frame.hpp"
#include "systems/drops/optics.hpp"
#include "systems/rainfall/sprites/sprites_shared.h"
#include "systems/drops/sums.hpp"

namespace petrichor {

std::vector<PassOffer> sprites_passes(std::shared_ptr<RainOptics>, std::shared_ptr<RainSums>);

// Particles drawn in the frame just executed; waits for the GPU. 0 where that frame drew none.
std::uint32_t sprites_drawn(const Frame&);

// published: what the particles of the newest frame hold, for tests. Waits for the GPU.
std::vector<SpriteStateGpu> read_sprite_states();

}  // namespace petrichor
