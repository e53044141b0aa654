#pragma once
// The crown sequence: modelled, not filmed. A sheet that rises from a ring, its rim, jets out of the rim and the drops
// that they shed, seen from several elevations; and a low corona of jets without a sheet for ground without a film.

#include <cstdint>
#include <vector>

#include "systems/splash/splash_shared.h"

namespace petrichor {

// Elevations of the eye above the surface, degrees; splash_draw.comp.glsl knows them too.
constexpr float crown_views_deg[CROWN_VIEWS] = {5.0f, 25.0f, 50.0f, 80.0f};

// Of a crown at phase 0 to 1 of its life, in greatest radii: radius of the ring, height of the rim, share of the sheet
// that has not torn yet. The radius grows with the square root of time until phase 0.35 (Yarin and Weiss).
struct CrownShape {
  float radius, height, sheet;
};
CrownShape crown_shape(bool film, float phase);

// One picture, CROWN_SIDE squared texels from the bottom up, rgba each: opacity a, a times the drop's Fresnel term
// (0.95 (1 - n.v)^4 + 0.05), a (1 + n_x)/2, a (1 + n_y)/2; n the unit normal of what is seen, in the picture's axes.
// take: which of several rims and jets.
std::vector<float> crown_picture(bool film, float elevation_deg, float phase, int take = 0);

// All of them: CROWN_KINDS x CROWN_VIEWS x CROWN_PHASES layers of 16-bit rgba. Layer p of a sequence is the mean over
// its life with the phases after (p + 1) / CROWN_PHASES left out, so a difference of two is the sum over an exposure,
// exact however long that is.
std::vector<std::uint16_t> bake_crowns();

}  // namespace petrichor
