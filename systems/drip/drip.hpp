#pragma once
// Drips from ledges, gutters and wires (Tatarchuk and Isidoro 2006, section 3.2; shared physics, section 8).

#include <vector>

#include "engine/assets/model.hpp"
#include "engine/ecs/registry.hpp"
#include "engine/graph/graph.hpp"
#include "systems/chart.hpp"
#include "systems/drops/painting.hpp"
#include "systems/frame.hpp"
#include "systems/ladder.hpp"

namespace petrichor {

std::vector<PassOffer> drip_passes(const DropPainting&);
void simulate_drips(Registry&, const std::vector<std::shared_ptr<const Model>>&, double time_s, double step_s);
void extract_drips(const Registry&, Frame&, double time_s);
Result<void> chart_drips(const ChartRun&);
Ladder drips_ladder();

}  // namespace petrichor
