#pragma once
// `petrichor chart snow`: the ways to draw falling snow, light and heavy.

#include "engine/core/result.hpp"
#include "systems/chart.hpp"

namespace petrichor {

// Besides the statistics of the rain's chart (studio.hpp) it compares how things move: how a picture is correlated with
// later ones, shifted by so many pixels. Flakes fall at their own speeds and sway; a scrolling texture moves as one.
Result<void> chart_snow(const ChartRun&);

}  // namespace petrichor
