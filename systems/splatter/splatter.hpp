#pragma once
// Splatter on marked objects (shells) and mist along their outlines (fins): Tatarchuk and Isidoro 2006, section 3.4.

#include <vector>

#include "engine/ecs/registry.hpp"
#include "engine/graph/graph.hpp"
#include "systems/chart.hpp"
#include "systems/drops/painting.hpp"
#include "systems/frame.hpp"
#include "systems/ladder.hpp"

namespace petrichor {

std::vector<PassOffer> splatter_passes(const DropPainting&);
void extract_splatter(const Registry&, Frame&);
Result<void> chart_halos(const ChartRun&);
Ladder splatter_ladder();
Ladder halos_ladder();

}  // namespace petrichor
