#pragma once
// Inside engine/script: curves as closed forms of time.

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <optional>
#include <string_view>
#include <vector>

namespace petrichor::script {

enum class Easing { linear, smooth, in, out };

// nullopt for an unknown name.
std::optional<Easing> easing_named(std::string_view name);
// Progress 0..1 to progress 0..1; exact at both ends.
double ease(Easing, double progress);

// A curve through points at given times (strictly rising, at least one), cubic between them, with continuous
// velocity: Catmull and Rom 1974, with the tangents of uneven knots (de Boor, A Practical Guide to Splines,
// chapter IV, Bessel's). Outside its times it stands at its ends.
struct Spline {
  std::vector<double> times_s;
  std::vector<glm::dvec3> points;
  glm::dvec3 at(double time_s) const;
};

// The rotation whose -z points along `direction` (not zero) with y up as far as that goes.
glm::dquat look_along(const glm::dvec3& direction);

}  // namespace petrichor::script
