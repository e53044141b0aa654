#pragma once
// Near drops: speed against accuracy, and Rana's Table 1 measured again. Both need a current OpenGL context.

#include <vector>

#include "engine/core/bench_row.hpp"
#include "engine/core/result.hpp"
#include "systems/chart.hpp"

namespace petrichor {

// On the street of near_street.hpp: column means of streaks against traced ones, for maps of several sizes and for the
// closed form, by what the passes near_environment and near_drops take while the camera stands.
Result<void> chart_near_drops(const ChartRun&);

// Table 1: 1000 to 50,000 drops in view as streaks (1/60 s) and as drops (an exposure of 0.1 ms), by closed form and by
// maps, 1280x720 on GPUs and 640x360 in software: pass near_drops ("near_drops/closed_form/streaks"), and what a
// capture of the world takes when the camera moves ("near_drops/capture").
Result<std::vector<BenchRow>> bench_near_drops(int frames, bool software_gl);

}  // namespace petrichor
