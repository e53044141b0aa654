#pragma once
// Long reflections on wet ground (Tatarchuk and Isidoro 2006, section 6.3; shared physics, section 10).

#include <vector>

#include "engine/ecs/registry.hpp"
#include "engine/graph/graph.hpp"
#include "systems/chart.hpp"
#include "systems/frame.hpp"
#include "systems/ladder.hpp"

namespace petrichor {

std::vector<PassOffer> reflection_passes();
Result<void> chart_reflections(const ChartRun&);
Ladder reflections_ladder();

}  // namespace petrichor
