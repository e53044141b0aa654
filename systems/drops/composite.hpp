#pragma once
// Lays sums of drops or of flakes (sums.hpp) over the picture: what passes rain_composite and snow_composite share.

#include "engine/graph/graph.hpp"
#include "systems/drops/optics.hpp"
#include "systems/drops/sums.hpp"

namespace petrichor {

// Slots and shaders of such a pass.
void offer_composite(PassOffer&, bool snow);
// And what it does; its sums are at zero afterwards. near_extinction: optical depth of what is too near to be drawn
// singly. Nothing where nobody has drawn into sums of the picture's size.
void lay_over(RainSums&, PassContext&, const ParticleOptics&, float near_extinction);

}  // namespace petrichor
