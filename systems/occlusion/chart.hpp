#pragma once
// The chart of `petrichor chart occlusion`: what maps of shelter cost and how far they are from rays.

#include <functional>

#include "components/weather.hpp"
#include "systems/chart.hpp"
#include "systems/frame.hpp"

namespace petrichor {

// The rain of an emitter in a wind, at a time (systems/rainfall knows how).
using RainAt = std::function<FrameRain(const Emitter&, const Wind&, double time_s)>;

// What falls over the time, for truths: velocities of all classes at `moments` times, with shares of the water (sum 1).
struct FallTruth {
  glm::vec3 velocity_mps;
  float water;
};
std::vector<FallTruth> falls_over_time(const RainAt&, const Emitter&, const Wind&, int moments);

// Writes occlusion.csv (a street of awnings, a house, a bridge and an arcade) and, where content/city.glb is there,
// occlusion-city.csv; with gnuplot their pictures.
Result<void> chart_occlusion(const ChartRun&, const RainAt&);

}  // namespace petrichor
