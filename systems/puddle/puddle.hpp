#pragma once
// Water that stands in hollows (Tatarchuk and Isidoro 2006, section 4; shared physics, section 9).

#include <vector>

#include "engine/ecs/registry.hpp"
#include "engine/graph/graph.hpp"
#include "systems/chart.hpp"
#include "systems/frame.hpp"
#include "systems/ladder.hpp"

namespace petrichor {

std::vector<PassOffer> puddle_passes();
void simulate_puddles(Registry&, double time_s, double step_s);
void extract_puddles(const Registry&, Frame&);
Result<void> chart_puddles(const ChartRun&);
Ladder puddles_ladder();

}  // namespace petrichor
