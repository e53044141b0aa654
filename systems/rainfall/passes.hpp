#pragma once
// The passes of falling rain: rain_cells (which cells are seen), rain_splat (their drops, into sums), and
// rain_composite (over the picture). In that order; splat after depth and occlusion map are drawn, composite
// after fog and glass.

#include <cstdint>
#include <vector>

#include "engine/graph/graph.hpp"
#include "systems/drops/painting.hpp"
#include "systems/frame.hpp"

namespace petrichor {

std::vector<PassOffer> rainfall_passes(const DropPainting&);  // of all techniques

struct RainStats {
  std::uint32_t drops_drawn =
      0;  // in view, nearer than the scene at their middle (or long enough to tell otherwise), not sheltered
  std::uint32_t cells = 0;
};
// Of the frame just executed; waits for the GPU. All 0 where that frame ran no rain pass.
RainStats rain_stats(const Frame&);

}  // namespace petrichor
