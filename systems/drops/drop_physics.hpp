#pragma once
// One falling drop: how fast, what shape, how quickly it follows the air.

#include <glm/glm.hpp>

namespace petrichor {

constexpr double gravity_mps2 = 9.81;

// Fall speed in still air at 20 C and sea level. Gunn and Kinzer 1949 (doi
// 10.1175/1520-0469(1949)006<0243:TTVOFF>2.0.CO;2), their table interpolated, which is closer than any of
// the usual fits (Atlas 1973 turns negative below 0.11 mm); Stokes' square law below 0.1 mm; constant above
// 5.8 mm, where drops flatten instead of speeding up. Never negative, never falls with diameter.
double terminal_speed_mps(double diameter_mm);

// Height over width of the flattened drop: Beard and Chuang 1987, polynomial; 1 for tiny drops. 0 to 8 mm.
double axis_ratio(double diameter_mm);

// Near terminal speed a drop follows a change of horizontal wind at the rate g/V, of vertical at 2g/V
// (quadratic drag): the horizontal time constant, in seconds.
double wind_response_s(double fall_speed_mps);

// One step of a drop's velocity in air that moves with air_mps, for any step size: quadratic drag by
// the exponential of the local rate, which cannot overshoot where explicit Euler diverges, beyond
// dt = 2V/g (28 ms for drizzle). terminal_mps > 0.
glm::dvec3 step_velocity(const glm::dvec3& velocity_mps, const glm::dvec3& air_mps, double terminal_mps, double dt_s);

}  // namespace petrichor
