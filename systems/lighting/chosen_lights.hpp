#pragma once
// Which of the frame's lights the passes of light work with, and where each one's shadow map is.

#include <cstdint>
#include <span>
#include <vector>

#include "systems/frame.hpp"
#include "systems/lighting/lighting_shared.h"

namespace petrichor {

// How far a light's shadow map reaches, m. Farther receivers count as lit.
float shadow_reach_m(const FrameLight&);

// Indices into frame.lights, ascending, of those that get a shadow map: all casters, or, where there are more than
// MAXIMUM_SHADOWS, the nearest to the camera's position rounded to 8 m (so that a choice lasts while one walks, and
// yet depends on nothing but the frame).
std::vector<std::size_t> shadow_casters(const Frame&);

// Lights relative to the frame's camera, shadow casters first, then by illuminance at the camera; the weakest beyond
// MAXIMUM_LIGHTS are left out. shadow_slots: per light of the frame its tile in the atlas or -1; empty: no shadows.
// A pure function of its arguments.
ChosenLights choose_lights(const Frame&, std::span<const int> shadow_slots);

// A number that changes with anything that lights the scene: lights, sky.
std::uint64_t lighting_hash(const Frame&);

}  // namespace petrichor
