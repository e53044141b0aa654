#include <algorithm>
#include <cmath>

#include "systems/drip_frame.hpp"
#include "systems/splash/splash.hpp"

namespace petrichor {

Ladder splashes_ladder() {
  Ladder l;
  l.effect = Effect::splashes;
  l.name = "splashes";
  l.meaning = "splashes where drops land";
  l.truth = "every impact of the field, none left out, at many instants of the exposure, with all droplets";
  l.error_measure = "mean and deviation of blocks of the picture over moments (no splashes at all: 1)";
  const std::vector<std::string_view> passes{"splash_overhead", "splash_list", "splash_draw"};
  l.rungs = {{"none", "no splashes", {}, 0.0, 1.0},
             {"random", "sprites at random places (as printed)", passes, 2.4, 1.05},
             {"field", "a splash where each drop of the field lands", passes, 7.5, 0.31},
             {"secondary", "field, with secondary droplets near the eye", passes, 8.5, 0.285}};
  l.coverage = [](const Frame& frame) {
    const bool rains = frame.rain && frame.rain->rain_mm_per_hour > 0.0f;
    if (!rains && !(frame.drips && !frame.drips->landings.empty())) return 0.0;
    // A downpour's splashes change a few percent of a street's picture.
    const double rate = rains ? frame.rain->rain_mm_per_hour : 1.0;
    return 0.08 * std::min(1.0, std::sqrt(rate / 50.0));
  };
  return l;
}

}  // namespace petrichor
