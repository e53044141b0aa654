#pragma once
// The passes of falling snow: snow_cells (which cells of the field are seen), snow_field (their flakes, into sums),
// snow_composite (over the picture), as the rain's; and snow_light, the light of lamps on flakes in a coarse volume of
// the view (light_volume.glsl), for snow_cone, which does not know its flakes one by one.

#include <cstdint>
#include <vector>

#include "engine/graph/graph.hpp"
#include "systems/frame.hpp"

namespace petrichor {

std::vector<PassOffer> snow_passes();

struct SnowStats {
  std::uint32_t flakes_drawn = 0;  // in view and not sheltered
  std::uint32_t discs = 0;         // pieces of those wider than a pixel
  std::uint32_t cells = 0;
};
// Of the frame just executed; waits for the GPU. All 0 where that frame ran no snow pass.
SnowStats snow_stats(const Frame&);

}  // namespace petrichor
