#pragma once
// The passes that draw the scene's surfaces.

#include <vector>

#include "engine/graph/graph.hpp"

namespace petrichor {

// gbuffer: depth, albedo, normal and emissive (formats in systems/geometry/gbuffer.glsl) of all opaque and masked
//   surfaces. Texels of the sky keep depth 0 and emissive 0.
// glass: blended surfaces, far to near, over a lit picture.
std::vector<PassOffer> geometry_passes();

}  // namespace petrichor
