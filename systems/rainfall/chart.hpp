#pragma once
// Milliseconds against error of the ways to draw falling rain. Needs a current OpenGL context.

#include "systems/chart.hpp"

namespace petrichor {

// Every rung of the ladder, with its published settings and several budgets, in three scenes (day street, night lamps,
// storm), against every drop at 64 instants of the exposure (32 in software). Rain is random, so pictures are compared by what is fair
// (systems/rainfall/studio.hpp); the floor is what two truths of other seeds differ by. Writes rainfall-day,
// rainfall-night and rainfall-storm.
Result<void> chart_rainfall(const ChartRun&);

}  // namespace petrichor
