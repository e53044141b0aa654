#pragma once
// Where wind has carried things that follow it with a delay: rain drops now, snow later. Shared by systems.
//
// The wind is a mean plus a few sinusoids (gusts along the mean, swirl across it). A drop follows through a
// first-order low-pass, so its steady answer and the integral of that are closed form: while the component
// does not change, any time stands alone. When a script changes it, the motion is re-anchored at that
// tick: the displacement so far is kept and the difference of the two steady answers dies away as
// exp(-t/response), again in closed form. Simulation starts from time 0, so that is deterministic too.

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "components/weather.hpp"

namespace petrichor {

constexpr int gust_waves = 4;

struct WindAnswer {
  double response_s = 0.0;         // time constant of the low-pass; 0 follows at once
  glm::dvec3 displacement_m{0.0};  // since time 0, at the anchor
  glm::dvec3 transient_mps{0.0};   // velocity minus steady answer, at the anchor
};

struct WindMotion {
  Wind wind;  // since the anchor
  double anchor_s = 0.0;
  std::array<double, gust_waves> gust_phase{};  // radians, at the anchor
  std::array<double, gust_waves> swirl_phase{};
  std::vector<WindAnswer> answers;
};

struct Drift {
  glm::dvec3 displacement_m;  // since time 0
  glm::dvec3 velocity_mps;
};

// Steady motion from time 0 on, for things of these time constants.
WindMotion start_wind_motion(const Wind&, std::span<const double> response_s);
// To be called at each tick: takes over a changed wind from time_s (not before the anchor) on.
void follow_wind(WindMotion&, const Wind&, double time_s);
// Of answers[index], at time_s >= anchor_s.
Drift drift_at(const WindMotion&, std::size_t index, double time_s);
// The air itself.
glm::dvec3 wind_velocity(const WindMotion&, double time_s);

}  // namespace petrichor
