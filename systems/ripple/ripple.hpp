#pragma once
// Ripples on standing water (Tatarchuk and Isidoro 2006, section 4; shared physics, section 5).

#include <vector>

#include "engine/ecs/registry.hpp"
#include "engine/graph/graph.hpp"
#include "systems/chart.hpp"
#include "systems/frame.hpp"
#include "systems/ladder.hpp"

namespace petrichor {

std::vector<PassOffer> ripple_passes();
void simulate_ripples(Registry&, double time_s, double step_s);
void extract_ripples(const Registry&, Frame&, double time_s);
Result<void> chart_ripples(const ChartRun&);
Ladder ripples_ladder();

}  // namespace petrichor
