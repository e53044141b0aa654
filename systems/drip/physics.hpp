#pragma once
// One drip: how large it grows before it lets go, and how it falls (shared physics, sections 1 and 8).

#include <glm/glm.hpp>

namespace petrichor {

// kg/m3, N/m; water at 20 C.
constexpr double drip_water_density = 998.0, drip_surface_tension = 0.0728;

// Volume of a drop that lets go of a lip of this radius, m3: Tate's law with the polynomial of Harkins and Brown,
// rho V g = 2 pi r sigma psi(r / V^(1/3)). Lips beyond 4.5 mm, where the polynomial ends, give drops of that one.
double drop_volume_m3(double lip_radius_mm);
double diameter_mm_of(double volume_m3);  // of a sphere

// Above a Weber number of 4 in the neck a site no longer drips but runs as a thread.
// flow_m3ps: of one site.
double neck_weber(double flow_m3ps, double lip_radius_mm);

// From rest, with quadratic drag: down as the closed form in still air,
//   y = (V^2/g) ln cosh s, v = V tanh s, s = g t / V,
// and along with a constant wind w, which it lags behind by u, by the drag that both give, du/dt = -(g/V^2) |(v, u)| u.
// With |(v, u)| as v + 0.55 u that is Bernoulli's equation:
//   u = w / (cosh s (1 + 0.55 (w/V) gd s)), and its integral (V^2 / 0.55 g) ln(1 + 0.55 (w/V) gd s),
// gd the Gudermannian. Within 8 cm after 1.5 s in 5 m/s. That the wind slows the fall is left out, up to 5% of the way
// down in 5 m/s (tests/systems/drip/physics.cpp).
struct DripFall {
  double fallen_m, fall_speed_mps;
  double drift_s, drift_share;  // times the wind: how far, how fast
};
DripFall fall_after(double terminal_mps, double time_s, double wind_mps = 0.0);
double fallen_m_after(double terminal_mps, double time_s);  // its fallen_m alone
double time_to_fall_s(double terminal_mps, double fall_m);

}  // namespace petrichor
