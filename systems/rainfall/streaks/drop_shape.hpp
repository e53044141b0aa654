#pragma once
// The shape of one falling, oscillating drop.

#include <array>
#include <glm/glm.hpp>

namespace petrichor {

// Rayleigh's frequency of the modes of order n of a free drop: sqrt(n (n - 1) (n + 2) sigma / (rho a^3)) / 2 pi. Their
// ratio does not depend on the size: f3 / f2 = sqrt(30 / 8) = 1.936.
double oscillation_frequency_hz(int order, double diameter_mm);

struct Oscillation {
  double prolate = 0.1;             // amplitude A20 of mode (2,0), in radii
  double sideways = 0.1;            // amplitude A31 of mode (3,1)
  double sideways_azimuth_rad = 0;  // where mode (3,1) leans, about the vertical
};

// Radius over the radius of the sphere of equal volume, by direction from the middle (unit, y up):
//   r(u) = polynomial(x) + sideways * 1.5 (5 x^2 - 1) * dot(u, lean),   x = -u.y = cos(theta), theta from the bottom
// Beard and Chuang 1987 for the mean shape, sum of c_n cos(n theta) = c_n T_n(x); Garg and Nayar 2006 for the
// oscillation, A20 sin(w2 t) P2(x) + A31 sin(w3 t) cos(phi) P31(x), with P31 = 1.5 (5 x^2 - 1) sin(theta). As printed
// the latter changes the volume by some 0.6 A20^2; here it is scaled back to the sphere's.
struct DropShape {
  std::array<double, 11> polynomial{};  // of x, constant first
  double sideways = 0.0;
  glm::dvec3 lean{1.0, 0.0, 0.0};  // unit, horizontal
};

// Phases in radians. Diameter 0 to 6 mm (between the rows of the table by straight lines; below 1 mm by D^2).
DropShape drop_shape(double diameter_mm, const Oscillation&, double phase2, double phase3);
DropShape sphere_shape();

double radius(const DropShape&, const glm::dvec3& direction);
double volume(const DropShape&);  // of the sphere: 4 pi / 3
// Zero on the surface, negative within; gradient by position, not unit.
double surface(const DropShape&, const glm::dvec3& position, glm::dvec3& gradient);

}  // namespace petrichor
