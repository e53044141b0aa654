#include "engine/script/path.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace petrichor::script {

std::optional<Easing> easing_named(std::string_view name) {
  if (name == "linear") return Easing::linear;
  if (name == "smooth") return Easing::smooth;
  if (name == "in") return Easing::in;
  if (name == "out") return Easing::out;
  return std::nullopt;
}

double ease(Easing easing, double progress) {
  const double p = std::clamp(progress, 0.0, 1.0);
  switch (easing) {
    case Easing::linear:
      return p;
    case Easing::smooth:
      return p * p * (3.0 - 2.0 * p);
    case Easing::in:
      return p * p;
    case Easing::out:
      return 1.0 - (1.0 - p) * (1.0 - p);
  }
  return p;
}

glm::dvec3 Spline::at(double time_s) const {
  assert(!times_s.empty() && times_s.size() == points.size());
  if (time_s <= times_s.front()) return points.front();
  if (time_s >= times_s.back()) return points.back();
  const auto i =
      static_cast<std::size_t>(std::upper_bound(times_s.begin(), times_s.end(), time_s) - times_s.begin()) - 1;
  const auto slope = [&](std::size_t k) { return (points[k + 1] - points[k]) / (times_s[k + 1] - times_s[k]); };
  // The velocity at a knot: the parabola through it and its neighbours; at the ends the chord.
  const auto velocity = [&](std::size_t k) {
    if (k == 0) return slope(0);
    if (k + 1 == points.size()) return slope(k - 1);
    const double before = times_s[k] - times_s[k - 1];
    const double after = times_s[k + 1] - times_s[k];
    return (slope(k - 1) * after + slope(k) * before) / (before + after);
  };
  const double span = times_s[i + 1] - times_s[i];
  const double u = (time_s - times_s[i]) / span;
  const double v = 1.0 - u;
  // Cubic Hermite basis.
  return points[i] * (v * v * (1.0 + 2.0 * u)) + velocity(i) * (span * u * v * v) +
         points[i + 1] * (u * u * (3.0 - 2.0 * u)) - velocity(i + 1) * (span * u * u * v);
}

glm::dquat look_along(const glm::dvec3& direction) {
  const glm::dvec3 forward = glm::normalize(direction);
  // Looking straight up or down, the top of the picture points along z.
  const glm::dvec3 up = std::abs(forward.y) < 0.99999 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, forward.y > 0 ? 1 : -1);
  return glm::quatLookAt(forward, up);
}

}  // namespace petrichor::script
