#include "systems/drip/physics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "systems/drops/drop_physics.hpp"

namespace petrichor {
namespace {

double harkins_brown(double x) {
  return 1.0 + x * (-0.9121 + x * (-2.109 + x * (13.38 + x * (-27.29 + x * (27.53 + x * (-13.58 + x * 2.593))))));
}

}  // namespace

double drop_volume_m3(double lip_radius_mm) {
  const double r = std::clamp(lip_radius_mm, 0.1, 4.5) * 1e-3;
  // The left side grows with the volume, the right side hardly changes: one crossing, by bisection.
  const double tate = 2.0 * std::numbers::pi * r * drip_surface_tension / (drip_water_density * gravity_mps2);
  double low = 0.3 * tate, high = 1.2 * tate;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (middle < tate * harkins_brown(r / std::cbrt(middle)) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double diameter_mm_of(double volume_m3) {
  return 1e3 * std::cbrt(6.0 / std::numbers::pi * std::max(volume_m3, 0.0));
}

double neck_weber(double flow_m3ps, double lip_radius_mm) {
  const double d = 2e-3 * std::clamp(lip_radius_mm, 0.1, 4.5);
  const double v = flow_m3ps / (0.25 * std::numbers::pi * d * d);
  return drip_water_density * v * v * d / drip_surface_tension;
}

DripFall fall_after(double terminal, double time_s, double wind_mps) {
  const double per_s = gravity_mps2 / terminal, s = std::max(per_s * time_s, 0.0);
  // ln cosh s = s + ln(1 + exp(-2 s)) - ln 2, which does not overflow.
  const double e = std::exp(-s), tanh = (1.0 - e * e) / (1.0 + e * e), sech = 2.0 * e / (1.0 + e * e);
  const double ln_cosh = s < 1e-2 ? 0.5 * s * s * (1.0 - s * s / 6.0) : s + std::log1p(e * e) - std::numbers::ln2;
  const double gd = 2.0 * std::atan((1.0 - e) / (1.0 + e)), wind = 0.55 * std::max(wind_mps, 0.0) / terminal;
  const double lag = wind * gd > 1e-6 ? std::log1p(wind * gd) / wind : gd;
  return {terminal / per_s * ln_cosh, terminal * tanh, std::max(s - lag, 0.0) / per_s, 1.0 - sech / (1.0 + wind * gd)};
}

double fallen_m_after(double terminal, double time_s) {
  const double per_s = gravity_mps2 / terminal, s = std::max(per_s * time_s, 0.0), e = std::exp(-s);
  return terminal / per_s *
         (s < 1e-2 ? 0.5 * s * s * (1.0 - s * s / 6.0) : s + std::log(1.0 + e * e) - std::numbers::ln2);
}

double time_to_fall_s(double terminal, double fall_m) {
  const double per_s = gravity_mps2 / terminal, c = std::max(fall_m, 0.0) * per_s / terminal;
  // acosh(exp c) = c + ln(1 + sqrt(1 - exp(-2 c))).
  const double rest = c < 1e-3 ? 2.0 * c * (1.0 - c * (1.0 - c / 1.5)) : 1.0 - std::exp(-2.0 * c);
  return (c + std::log(1.0 + std::sqrt(rest))) / per_s;
}

}  // namespace petrichor
