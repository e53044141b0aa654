#pragma once
// Pass rain_light: the light of lamps on falling drops, in a coarse volume of the view (light_volume.glsl).

#include <memory>

#include "engine/graph/graph.hpp"
#include "systems/drops/optics.hpp"

namespace petrichor {

// Slot rain_light: an rgba16f array, as many slices as it has layers.
PassOffer rain_light_pass(std::shared_ptr<RainOptics>);
// Fills such a volume with shader "fill", for the particles whose optics are bound.
void fill_light_volume(PassContext&, const char* slot);

}  // namespace petrichor
