#pragma once
// The truth of splatter: the same impacts, their crowns integrated through every pixel.

#include <glm/glm.hpp>
#include <vector>

#include "systems/frame.hpp"
#include "systems/splatter/splatter_shared.h"

namespace petrichor {

// cd/m2 of the rings on one marked thing against black, by pixel, from one point lamp. distances_m (axial; infinite:
// nothing) and normals (world): of the surface in each pixel, the camera's own picture. Crowns are not baked, but
// evaluated at `heights` heights and `moments` moments of the exposure; rings of all ages, at any distance. Shared with
// the technique: where drops strike, and the model of a crown; and that the surface under one is a plane.
std::vector<double> draw_rings(const Frame&, const CatcherGpu&, const FrameLight& lamp, int width, int height,
                               const std::vector<float>& distances_m, const std::vector<glm::vec3>& normals,
                               double slot_s, int heights = 40, int moments = 24);

}  // namespace petrichor
