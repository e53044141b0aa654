#pragma once
// A picture of what the rungs of shelter see: a section through the roof of the chart's street.

#include "systems/occlusion/chart.hpp"
#include "systems/occlusion/stage.hpp"

namespace petrichor {

// Writes occlusion-section.png and .svg: by x and height the share of the rain kept away, by each rung and by rays;
// without gnuplot occlusion-section.csv alone. The stage holds shelter_street(); frame.wind and frame.rain say the
// weather.
Result<void> draw_shelter_section(const ChartRun&, OcclusionStage&, const std::vector<FallTruth>&);

}  // namespace petrichor
