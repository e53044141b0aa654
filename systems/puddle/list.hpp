#pragma once
// FramePuddles for the shaders: rows about the camera, and a grid that tells which puddles are near a place.

#include <vector>

#include "systems/puddle/puddle_shared.h"
#include "systems/puddle_frame.hpp"

namespace petrichor {

struct PuddleList {
  PuddleListGpu head;
  std::vector<PuddleGpu> puddles;
  std::vector<std::uint32_t> cells;  // two each
};

// Only puddles with water. Where more than eight meet in a cell, the nearest to the camera stay.
PuddleList list_puddles(const FramePuddles&, const glm::dvec3& camera_m);

}  // namespace petrichor
