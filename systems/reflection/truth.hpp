#pragma once
// What the street's ground really mirrors: GGX integrated by rays (Embree) over lamps, lit panels, walls, posts and sky
// (physics 10b).

#include <memory>
#include <vector>

#include "systems/frame.hpp"
#include "systems/reflection/stage.hpp"

namespace petrichor {

// Radiance, cd/m2, rows from the bottom, of pixels on surfaces that mirror (roughness below 0.6); alpha 1 there, 0
// elsewhere; the mean over the pixel. samples: facets a pixel, stratified. Lamps are spheres, evaluated directly at 64
// points of their discs.
// Walls and posts are Lambert's, in the light of the lamps alone.
std::vector<glm::vec4> reflection_truth(const StageScene&, const Frame&, int samples, std::uint32_t seed = 1);

}  // namespace petrichor
