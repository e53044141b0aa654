#pragma once
// Pass layered_composite: falling rain as layers in one pass over the picture (Tatarchuk and Isidoro 2006, 3.1).

#include <memory>
#include <vector>

#include "engine/graph/graph.hpp"
#include "systems/drops/optics.hpp"

namespace petrichor {

// Slots colour (modified), depth, occlusion_map, environment, rain_light (read, optional). After fog and glass.
std::vector<PassOffer> layered_passes(std::shared_ptr<RainOptics>);

}  // namespace petrichor
