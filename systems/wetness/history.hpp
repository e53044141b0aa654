#pragma once
// How wet the world has become: films as functions of exposure, kept on the CPU at every tick, so that any frame stands
// alone. On the emitter's entity.

#include <vector>

#include "components/water.hpp"
#include "components/weather.hpp"
#include "systems/wetness/film.hpp"
#include "systems/wetness_frame.hpp"

namespace petrichor {

// Which rain was wet stays wet for a while when the wind turns. A film depends on the rain that each place got along
// every fall there has been; kept are two falls, exactly: the one that wets now and the one remembered, the films being
// a table over the exposures along both. When the fall turns by more than turn_deg from that of now, the one of the two
// along which less water has come lately makes room (its water is put down to the other). So a wind that veers for good
// leaves its old edge to dry, and a wind that swings for ever blurs both: a third direction is not known.
constexpr double turn_deg = 8.0;

struct WetnessHistory {
  // State at anchor_s: [porosity][slope][remembered][exposure].
  std::vector<Film> films;
  int remembered = 1;
  double anchor_s = 0.0;
  double time_s = 0.0;  // of the last tick
  // Since the anchor.
  double rain_m = 0.0;  // water that fell on open level ground
  bool raining = false;
  double evaporation_mps = 0.0, pace = 1.0;  // pace: drying_speed while dry
  // What falls, and fell last.
  Emitter rain;
  Wind wind;
  glm::dvec3 fall_mps{0.0, -1.0, 0.0};             // of the rain that wets now; its table axis
  glm::dvec3 remembered_fall_mps{0.0, -1.0, 0.0};  // of the other
  double dose_m = 0.0, remembered_dose_m = 0.0;    // water along each, forgotten in forget_s
  bool ever_wet = false;
  glm::dvec2 flown_m{0.0};
};

constexpr double forget_s = 600.0;

// As the ground is when a scene opens (WetGround::initial_wetness).
WetnessHistory start_wetness(const Emitter&, const Wind&, const WetGround&, double time_s);
// Takes over what falls from time_s on. Rates that change within a quarter of a second are taken as their mean.
void follow_rain(WetnessHistory&, const Emitter&, const Wind&, const WetGround&, double time_s);
// Films at time_s >= anchor_s, as FrameWetness::films.
std::vector<glm::vec4> films_at(const WetnessHistory&, double time_s);
// One of them in double precision: exposures along both falls, at the table's porosity and slope indices.
Film film_at(const WetnessHistory&, int porosity, int slope, int remembered, int exposure, double time_s);

// Exposure of a table's index.
double exposure_of(int index, int count);
// Law of a table's cell but for supply, evaporation.
FilmLaw film_law(int porosity, int slope);
// Mean velocity of the water that falls: wind less mean fall speed. Straight down without rain.
glm::dvec3 mean_rain_fall(const Emitter&, const Wind&);

}  // namespace petrichor
