#pragma once
// Planar mirrors for panes and still puddles, and cube maps about moving objects (Tatarchuk and Isidoro 2006,
// section 6.3).

#include <vector>

#include "engine/ecs/registry.hpp"
#include "engine/graph/graph.hpp"
#include "systems/chart.hpp"
#include "systems/frame.hpp"
#include "systems/ladder.hpp"

namespace petrichor {

std::vector<PassOffer> mirror_passes();
void extract_mirrors(const Registry&, Frame&);
Ladder probes_ladder();

// Planar mirrors (mirrors-water, mirrors-ripples, mirrors-pane) and probes against rays in the street of street.hpp, by
// the passes of geometry, lighting and mirrors that are given: error by what the passes mirrors and probes take.
Result<void> chart_mirrors(const ChartRun&, const std::vector<PassOffer>& passes);
Result<void> chart_probes(const ChartRun&, const std::vector<PassOffer>& passes);

}  // namespace petrichor
