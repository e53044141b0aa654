#pragma once
// Passes double_cone (rain) and snow_cone: one compute pass over the picture each.

#include <memory>
#include <vector>

#include "engine/graph/graph.hpp"
#include "systems/drops/optics.hpp"

namespace petrichor {

std::vector<PassOffer> cone_passes(std::shared_ptr<RainOptics>);

}  // namespace petrichor
