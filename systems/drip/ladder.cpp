#include <algorithm>

#include "systems/drip/drip.hpp"
#include "systems/drip_frame.hpp"

namespace petrichor {

Ladder drips_ladder() {
  Ladder l;
  l.effect = Effect::drips;
  l.name = "drips";
  l.meaning = "drops that hang and fall from gutters, ledges, awnings and wires";
  l.truth = "the same drops, refracting at 16 times the pixels, the mean of 16 instants of the exposure";
  l.error_measure = "root mean square of luminance over the picture; no drips: 1";
  l.rungs = {
      {"none", "no drips", {}, 0.0, 1.0},
      {"billboards", "screen-aligned billboards with a normal map", {"drips_over"}, 4.0, 0.79},
      {"streaks", "streaks as long as the exposure, by the rain's own optics", {"drips"}, 1.2, 0.79},
      {"refracting", "streaks, and those a pixel wide and more show the world", {"drips", "drips_over"}, 1.5, 0.54}};
  // Each drop's streak is some tens of pixels of a picture of some 10^5: ten thousand are a picture full of them.
  l.coverage = [](const Frame& frame) {
    return frame.drips && !frame.drips->drops.empty()
               ? std::min(1.0, 0.02 + static_cast<double>(frame.drips->drops.size()) / 10000.0)
               : 0.0;
  };
  return l;
}

}  // namespace petrichor
