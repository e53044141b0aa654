#pragma once
// The passes of what lies between surfaces and eye.

#include <vector>

#include "engine/graph/graph.hpp"

namespace petrichor {

// sky:        colour (rgba16f), cd/m2: nothing but sky.
// airlight:   airlight (rgba16f, scale 1/4): lamps glowing in mist and in rain too far to be drawn; alpha: metres to
// the
//             surface behind. Runs only where something scatters. Needs light_lists before it, which chooses the
//             lights.
// atmosphere: modifies colour: extinction and the mist's own light.
std::vector<PassOffer> atmosphere_passes();

}  // namespace petrichor
