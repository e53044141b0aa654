#include "systems/rainfall/ladders.hpp"

#include <algorithm>
#include <cmath>

#include "systems/frame.hpp"

namespace petrichor {
namespace {

bool rains(const Frame& frame) {
  return frame.rain && frame.rain->rain_mm_per_hour > 0.0f;
}
bool draws_field(const Frame& frame) {
  return rains(frame) && frame.rain->field_share() > 0.0f;
}

}  // namespace

Ladder rainfall_ladder() {
  Ladder l;
  l.effect = Effect::rainfall;
  l.name = "rainfall";
  l.meaning = "falling rain";
  l.truth = "every drop, the mean of 64 instants of the exposure (32 in software)";
  l.error_measure = "mean and deviation over time of blocks of pixels, and the spectrum of what changes; no rain at all: 1";
  l.rungs = {
      {"fog", "no single drops: their extinction and airlight alone", {}},
      {"double_cone", "textures scrolled on a double cone about the camera (Wang and Wade 2004)", {"rain_light", "double_cone"}},
      {"composite", "layers of drops from one placement texture (Tatarchuk and Isidoro 2006)", {"rain_light", "layered_composite"}},
      {"sprites", "particles in a box about the camera, drawn as streaks (Tariq 2007)", {"rain_sprites", "rain_composite"}},
      {"drop_field", "every drop, singly as far as the budget of drops reaches", {"rain_cells", "rain_splat", "rain_composite"}},
      {"full_field",
       "every drop, singly out to emitter.drawn_distance_m, whatever it costs",
       {"rain_cells", "rain_splat", "rain_composite"}},
      {"near_drops",
       "drop_field, with drops near the eye showing the world refracted (Rana)",
       {"rain_cells", "rain_splat", "rain_composite", "near_environment", "near_drops"}},
  };
  // Light rain leaves most of the picture alone. A scale by rate, chosen by eye (two thirds at 5 mm/h), no measure: how
  // much of the picture is under roofs or too bright for streaks is not known here.
  l.coverage = [](const Frame& frame) {
    constexpr double most_of_it_mm_per_hour = 5.0;
    return rains(frame) ? 1.0 - std::exp(-frame.rain->rain_mm_per_hour / most_of_it_mm_per_hour) : 0.0;
  };
  return l;
}

Ladder snow_ladder() {
  Ladder l;
  l.effect = Effect::snow;
  l.name = "snow";
  l.meaning = "falling snow";
  l.truth = "every flake, the mean of 6 instants of the exposure";
  l.error_measure = "mean and deviation of blocks of pixels, spectrum, and motion; no snow at all: 1";
  l.rungs = {{"fog", "no single flakes: their haze alone", {}},
             {"double_cone", "textures of flakes scrolled on a double cone about the camera", {"snow_light", "snow_cone"}},
             {"field", "every flake, swaying and tumbling", {"snow_cells", "snow_field", "snow_composite"}}};
  // As of rain; flakes are seen by day and night, so that a tenth of the water does.
  l.coverage = [](const Frame& frame) {
    constexpr double most_of_it_mm_per_hour = 0.5;
    return frame.snow ? 1.0 - std::exp(-std::max(frame.snow->snow_mm_per_hour, 0.0f) / most_of_it_mm_per_hour) : 0.0;
  };
  return l;
}

Ladder streaks_ladder() {
  Ladder l;
  l.effect = Effect::streaks;
  l.name = "streaks";
  l.meaning = "light along the streak of an oscillating drop";
  l.truth = "traced oscillating drops (Beard and Chuang's shapes, modes (2,0) and (3,1))";
  l.error_measure = "root mean square of radiance over its mean along streaks; even streaks: 1";
  l.rungs = {{"even", "one radiance along the streak", {"rain_splat"}, 0.0, 1.0},
             {"nearest", "the nearest entries of the streak table (as Tariq 2007 reads it)", {"rain_splat"}, 0.0, 1.10},
             {"table", "the streak table, interpolated in all three angles", {"rain_splat"}, 0.0, 0.91}};
  l.coverage = [](const Frame& frame) { return draws_field(frame) ? 0.1 : 0.0; };
  l.directed = false;
  return l;
}

Ladder near_drops_ladder() {
  Ladder l;
  l.effect = Effect::near_drops;
  l.name = "near_drops";
  l.meaning = "what drops near the eye show of the world; of rainfall=near_drops";
  l.truth = "traced drops in the same environment";
  l.error_measure = "root mean square radiance of streaks; drops of one colour: 1";
  l.rungs = {{"off", "drops of one colour", {}, 0.0, 1.0},
             {"maps",
              "a map of directions per drop, its column means kept per cell (Rana)",
              {"near_environment", "near_drops"},
              15.0,
              0.92},
             {"closed_form",
              "the deviation of a sphere as a curve, one look-up a ray",
              {"near_environment", "near_drops"},
              19.0,
              0.26}};
  l.coverage = [](const Frame& frame) {
    return rains(frame) && frame.rain->share(RainRung::near_drops) > 0.0f ? 0.05 : 0.0;
  };
  l.directed = false;
  return l;
}

}  // namespace petrichor
