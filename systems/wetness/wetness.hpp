#pragma once
// Wet surfaces: films of water on everything that rain reaches (shared physics, section 9).

#include <vector>

#include "engine/ecs/registry.hpp"
#include "engine/graph/graph.hpp"
#include "systems/chart.hpp"
#include "systems/frame.hpp"
#include "systems/ladder.hpp"

namespace petrichor {

std::vector<PassOffer> wetness_passes();
void simulate_wetness(Registry&, double time_s, double step_s);
void extract_wetness(const Registry&, Frame&, double time_s);
Result<void> chart_wetness(const ChartRun&);
Ladder wetness_ladder();

}  // namespace petrichor
