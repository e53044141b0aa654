#pragma once
// Long reflections on wet ground (Tatarchuk and Isidoro 2006, section 6.3; shared physics, section 10).

#include <functional>
#include <vector>

#include "engine/core/bench_row.hpp"
#include "engine/ecs/registry.hpp"
#include "engine/graph/graph.hpp"
#include "systems/chart.hpp"
#include "systems/frame.hpp"
#include "systems/ladder.hpp"

namespace petrichor {

// reflections:      reflections (rgba16f, half size): radiance mirrored, and the share of the lobe that it replaces.
// reflections_over: colour, full size; the one place where planar mirrors, moving probes, rays and stand-ins, and the
//                   captured surroundings meet, in this order.
std::vector<PassOffer> reflection_passes();
// The rungs against rays, on a street at night at three roughnesses. passes: all there are.
Result<void> chart_reflections(const ChartRun&, const std::function<std::vector<PassOffer>()>& passes);
// Rows reflections/RUNG, of that street: both passes.
Result<std::vector<BenchRow>> bench_reflections(const std::function<std::vector<PassOffer>()>& passes, int width,
                                                int height, int frames, bool software_gl);
Ladder reflections_ladder();

}  // namespace petrichor
