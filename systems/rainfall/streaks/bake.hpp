#pragma once
// Bakes the streak table by tracing drops.

#include <functional>
#include <span>

#include "systems/rainfall/streaks/table.hpp"

namespace petrichor {

struct StreakBake {
  StreakGrid grid{9, 13, 13};
  StreakDrop drop;
  int along = 16, oscillations = 8, across = 8;
  int rays = 16000;  // for each view elevation and shape
  int threads = 2;
};
StreakBake fine_streak_bake();

// The same bytes for the same settings, whatever the threads. progress gets 0 to 1, from one thread at a time.
StreakTable bake_streaks(const StreakBake&, const std::function<void(double)>& progress = {});

// Nodes for lamps alone; elevations from `lowest_deg` to 90. The azimuth from 0 to 180.
struct LampGrid {
  int light, azimuth;
  double lowest_deg = -90.0;
};

// Light of one view elevation, for charts and tests: power[(light * azimuth nodes + azimuth) * oscillations * along +
// ...] and across[... * across]: integrals over the node's tent (1 at the node, 0 at its neighbours) of radiance per
// irradiance; along is spread over the time the drop takes to fall by its own height.
struct ViewLight {
  std::vector<double> power, across;
  std::vector<double> area;   // of the drop's picture over that of the sphere's disc: oscillations x along
  std::vector<double> turns;  // power by sin(turn / 2), drop_phase_bins, lamps on both sides; the sum over all moments
};
// One for each grid. Only those oscillations from `first` to `last` (excluded) are traced.
std::vector<ViewLight> trace_view(const StreakBake&, double view_elevation, std::span<const LampGrid>, int first,
                                  int last);
// Integrals of the same tents of a phase function (as make_drop_phase()), and of 1.
struct TentWeights {
  std::vector<double> phase, solid_angle;
};
TentWeights tent_weights(double view_elevation, const LampGrid&, std::span<const float> phase);
// Where a ring of nodes stands for one direction, the zenith or the nadir: its mean to all of it. `width` values a
// node.
void join_poles(std::vector<double>& values, const LampGrid&, std::size_t width);

// Calls task(i) for 0 <= i < count on some threads.
void for_each_task(int count, int threads, const std::function<void(int)>& task,
                   const std::function<void(double)>& progress);

}  // namespace petrichor
