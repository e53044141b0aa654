#pragma once
// Orthographic depth maps of the scene, seen from where the precipitation comes from: what is sheltered, and where a
// drop's path first meets something (design, section 5). Effect::occlusion says how many and along which falls.

#include <vector>

#include "engine/ecs/registry.hpp"
#include "engine/graph/graph.hpp"
#include "systems/frame.hpp"
#include "systems/ladder.hpp"
#include "systems/occlusion/placement.hpp"

namespace petrichor {

// frame.wind: the scene's wind, of which the maps of OcclusionRung::jittered know the gusts.
void extract_wind(const Registry&, Frame&);

// occlusion_map: runs where it rains or snows. Slot occlusion_map: depth32f, square, of fixed size, persistent, with
// layers (1 to OCCLUSION_MAPS; maps is capped by them). A map is redrawn when its direction, its place or the geometry
// changed. Parameters:
//   maps           of jittered; 8
//   side_m         of each map; 128
//   step_m         the camera's way after which a map moves; 16
//   tolerance_deg  directions are held to a lattice this fine; 0.5
//   bias_m         added to what a map's steepness makes of half a texel; 0.02
//   published      1: depths are compared as Chen prints it, without any bias; 0
std::vector<PassOffer> occlusion_passes();

Ladder occlusion_ladder();

}  // namespace petrichor
