#pragma once
// The passes from light to picture.

#include <vector>

#include "engine/graph/graph.hpp"
#include "systems/ladder.hpp"

namespace petrichor {

// bloom:     bloom (rgba16f, scale 1/2, mips 6): what the lens scatters; runs where the camera has any.
// tonemap:   display (rgba16f; alpha: luminance) from colour and bloom by exposure and film curve.
// tonemap8:  the same, dithered to the 8-bit picture: the end of a frame without antialiasing.
// antialias: the 8-bit picture from display: edges smoothed, dithered.
std::vector<PassOffer> image_passes();

Ladder antialias_ladder();
// Pixels that are drawn, of those that are shown: the picture is enlarged by whoever shows it (engine/main).
Ladder resolution_ladder();

}  // namespace petrichor
