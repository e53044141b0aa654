#pragma once
// How true ripples are: slopes of a stage against the exact solution of the same drops.

#include <vector>

#include "systems/ripple/stage.hpp"

namespace petrichor {

struct RippleError {
  double waves = 0.0;     // root mean square of the slopes' difference, by the truth's
  double repeats = 0.0;   // correlation of slopes that lie a tile's edge apart; 1: the same again
  double strength = 0.0;  // root mean square slope, by the truth's
};

// Slopes dz/dx, dz/dz in truth.
using TrueSlopes = std::vector<glm::dvec2>;
// Of the drops of the shared tile on a lattice of such cells, from the history's first tick on, at each of these ticks
// (rising, of the history).
std::vector<TrueSlopes> true_shared_slopes(const FrameRipples&, int cells, const std::vector<std::int64_t>& ticks);
// Of the field's own drops of the last `seconds`, on the near tile as it lies now; the eye must have stood still.
TrueSlopes true_near_slopes(const FrameRipples&, int cells, double seconds);

// Of layer 0 of a stage; of its last draw of the frame, the near tile's middle.
RippleError shared_error(const std::vector<glm::vec4>& layer, const TrueSlopes& truth, int cells);
RippleError near_error(const RippleStage&, const Frame&, const TrueSlopes& truth);

}  // namespace petrichor
