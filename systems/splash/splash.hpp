#pragma once
// Splashes of the rain and of drips where they land (Tatarchuk and Isidoro 2006, section 3.3).

#include <vector>

#include "engine/ecs/registry.hpp"
#include "engine/graph/graph.hpp"
#include "systems/chart.hpp"
#include "systems/drops/painting.hpp"
#include "systems/frame.hpp"
#include "systems/ladder.hpp"

namespace petrichor {

std::vector<PassOffer> splash_passes(const DropPainting&);
void extract_splashes(const Registry&, Frame&, double time_s);
Result<void> chart_splashes(const ChartRun&);
Ladder splashes_ladder();

}  // namespace petrichor
