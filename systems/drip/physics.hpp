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
//   y = (V^2/g) ln cosh(g t / V), v = V tanh(g t / V),
// and along with a constant wind w by the drag that this fall gives, dx'/dt = (g/V^2) v (w - x'):
//   x' = w (1 - 1 / cosh(g t / V)), x = w (t - (V/g) gd(g t / V)), gd the Gudermannian.
// It leaves out that the wind itself adds to the drag: 2 to 4% of the way down in 5 m/s (tests/systems/drip).
struct DripFall {
  double fallen_m, fall_speed_mps;
  double drift_s, drift_share;  // times the wind: how far, how fast
};
DripFall fall_after(double terminal_mps, double time_s);
double time_to_fall_s(double terminal_mps, double fall_m);

}  // namespace petrichor
