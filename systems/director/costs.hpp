#pragma once
// What the director knows of costs: the chart's figures, rescaled by what this machine measures.

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "systems/ladder.hpp"
#include "systems/techniques.hpp"

namespace petrichor {

struct PassTime {
  std::string name;
  double ms = 0.0;
};

// The last few figures; their median stands for them.
struct CostSamples {
  std::array<double, 7> ms{};
  int count = 0, next = 0;
};

constexpr std::size_t resolution_rungs = static_cast<std::size_t>(ResolutionRung::count);

struct DirectorCosts {
  std::vector<Ladder> ladders;  // one for each Effect, in its order
  // [effect][rung][rung of resolution]: milliseconds
  std::array<std::vector<std::array<CostSamples, resolution_rungs>>, effect_count> measured;
  // What a frame costs at each resolution, apart from the effects, as a share of full size.
  std::array<double, resolution_rungs> scale{}, chart_scale{};
  CostSamples beside;  // of a frame whose passes a GPU timed: the CPU's share, which no rung changes
  int trust = 2;       // in the timer: at most 3, from 2 on it is believed
  int doubt = 0;       // changes in a row that it did not foretell: > 0 effects cost more than it says, < 0 less
  int caught = 0;      // how often it lost its trust by that
};

// A rung that the director may choose: stable, and with figures.
bool usable(const Rung&);
// Another rung is no more wrong on the chart, and cheaper there by so much that what this machine measures under
// changing load must not reverse it: the director leaves such a rung alone too.
bool outdone(const Ladder&, const Rung&);

DirectorCosts make_costs(std::vector<Ladder> ladders);

// A table of the present estimates, of effects that are in the picture; 0 for the others.
struct CostTable {
  std::array<std::vector<std::array<double, resolution_rungs>>, effect_count> ms;
};
// level_ms: of the whole frame as it is drawn now, by `techniques` (0: not known).
CostTable cost_table(const DirectorCosts&, const Techniques&, const std::array<double, effect_count>& coverage,
                     double level_ms);

// Takes the times of passes of a frame drawn by `techniques` (no cross-fade) in frame_ms. A timer that reports nonsense
// (not finite, negative, a sum that has nothing to do with the frame) loses trust and is not believed. gpu_times: they
// are a GPU's own, so their sum may be much less than the frame, whose rest is the CPU's.
void learn_passes(DirectorCosts&, const Techniques&, const std::array<double, effect_count>& coverage,
                  std::span<const PassTime>, double frame_ms, bool gpu_times);
// A change of rungs was expected to turn frames of before_ms into expected_ms, and they became after_ms; frames vary by
// the share `noise` anyway. Load that comes from elsewhere makes climbs and drops alike dearer than expected; a timer
// that lies about effects errs the other way at drops. So it is distrusted after surprises in a row that say the same.
void learn_change(DirectorCosts&, const std::array<int, effect_count>& from, const std::array<int, effect_count>& to,
                  const std::array<double, effect_count>& coverage, double before_ms, double expected_ms,
                  double after_ms, double noise);

double median_of(std::vector<double> values);  // 0 for none

}  // namespace petrichor
