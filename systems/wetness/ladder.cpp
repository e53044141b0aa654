#include "systems/wetness/wetness.hpp"
#include "systems/wetness_frame.hpp"

namespace petrichor {

Ladder wetness_ladder() {
  Ladder l;
  l.effect = Effect::wetness;
  l.name = "wetness";
  l.meaning = "films of water on surfaces";
  l.truth =
      "rays (Embree) along the falls of all drops, films advanced in steps of 10 ms, light in them by Monte Carlo";
  l.error_measure = "root mean square of the film's shade of surfaces (wet over dry albedo) in a street with awnings";
  l.rungs = {{"none", "dry", {}},
             {"everywhere", "one film on everything", {"wet_surfaces"}},
             {"sheltered", "films by how much rain arrives", {"wet_surfaces"}},
             {"flowing", "sheltered, with films that run down walls and slopes", {"wet_surfaces"}}};
  // Chart `wetness` (steady wind): errors. Of what runs there is no truth in it: that it is truer is a guess.
  // Milliseconds at 640x360, llvmpipe, without puddles (whose ladder has theirs), of a busy machine by the ratio to
  // `antialias`.
  const double ms[] = {0.0, 3.0, 14.5, 20.0}, error[] = {1.0, 0.63, 0.15, 0.14};
  for (std::size_t i = 0; i < l.rungs.size(); ++i) l.rungs[i].chart_ms = ms[i], l.rungs[i].chart_error = error[i];
  l.coverage = [](const Frame& frame) {
    if (!frame.wetness) return 0.0;
    // Streets and walls fill most of the picture; wet, they differ from dry as much as the rain in the air does.
    return frame.wetness->film_mm > 0.0f || frame.wetness->soaked > 0.0f ? 0.6 : 0.0;
  };
  return l;
}

}  // namespace petrichor
