#pragma once
// Light through one drop of any shape near a sphere: exact Fresnel with polarisation, up to three internal
// reflections, and more where these are total.

#include <array>

#include "systems/rainfall/streaks/drop_shape.hpp"

namespace petrichor {

// What becomes of a ray from the eye: by reversibility, the light that comes from `direction` (unit, away from the
// drop) reaches the eye with this share of its radiance. Unpolarised lamp, eye blind to polarisation.
struct DropPath {
  glm::dvec3 direction;
  double share;
};

// Outer reflection, straight through, and after one, two and three internal reflections, as drop_ray_orders of
// drop_optics.hpp; more only while much is left inside: a sphere never holds light back, a flattened drop does, by
// total reflection.
constexpr int drop_paths = 24;
struct DropPaths {
  int count = 0;
  std::array<DropPath, drop_paths> paths;
};

// A ray from outside; direction unit. Lengths in radii of the sphere of equal volume. Without paths: it misses.
DropPaths trace_drop(const DropShape&, const glm::dvec3& origin, const glm::dvec3& direction);

// A radius that holds every drop of the table with amplitudes up to 0.25.
constexpr double largest_radius = 1.9;

}  // namespace petrichor
