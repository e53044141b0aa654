#pragma once
// The field's cells as leaning columns: each follows its class's fall, so that all of its drops land in one small
// patch.

#include "systems/drops/layers.hpp"

namespace petrichor {

// Whether drops of this class splash on any surface at all.
bool may_splash(const RainClass&);

// Of every class that may splash: a layer's box counts columns along x and z, and levels along y; corner and first_cell
// are of its lowest cell in the first column. expected.z: metres out to which it is wanted; .w: drops per m3.
// Smaller drops than least_mm are left out.
RainLayers splash_columns(const FrameRain&, const FrameCamera&, int width, int height, float reach_m, float least_mm,
                          float secondary_reach_m);

}  // namespace petrichor
