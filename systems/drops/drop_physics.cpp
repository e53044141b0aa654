#include "systems/drops/drop_physics.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace petrichor {
namespace {

struct Row {
  double diameter_mm, speed_mps;
};

// Gunn and Kinzer's table.
constexpr std::array<Row, 34> gunn_kinzer{{
    {0.1, 0.27}, {0.2, 0.72}, {0.3, 1.17}, {0.4, 1.62}, {0.5, 2.06}, {0.6, 2.47}, {0.7, 2.87}, {0.8, 3.27}, {0.9, 3.67},
    {1.0, 4.03}, {1.2, 4.64}, {1.4, 5.17}, {1.6, 5.65}, {1.8, 6.09}, {2.0, 6.49}, {2.2, 6.90}, {2.4, 7.27}, {2.6, 7.57},
    {2.8, 7.82}, {3.0, 8.06}, {3.2, 8.26}, {3.4, 8.44}, {3.6, 8.60}, {3.8, 8.72}, {4.0, 8.83}, {4.2, 8.92}, {4.4, 8.98},
    {4.6, 9.03}, {4.8, 9.07}, {5.0, 9.09}, {5.2, 9.12}, {5.4, 9.14}, {5.6, 9.16}, {5.8, 9.17},
}};

}  // namespace

double terminal_speed_mps(double diameter_mm) {
  if (!(diameter_mm > 0.0)) return 0.0;
  const Row& first = gunn_kinzer.front();
  if (diameter_mm <= first.diameter_mm) {
    const double ratio = diameter_mm / first.diameter_mm;
    return first.speed_mps * ratio * ratio;
  }
  if (diameter_mm >= gunn_kinzer.back().diameter_mm) return gunn_kinzer.back().speed_mps;
  const auto above = std::upper_bound(gunn_kinzer.begin(), gunn_kinzer.end(), diameter_mm,
                                      [](double d, const Row& row) { return d < row.diameter_mm; });
  const Row& b = *above;
  const Row& a = *(above - 1);
  return a.speed_mps + (b.speed_mps - a.speed_mps) * (diameter_mm - a.diameter_mm) / (b.diameter_mm - a.diameter_mm);
}

double axis_ratio(double diameter_mm) {
  const double d = std::clamp(diameter_mm, 0.0, 8.0);
  return std::min(1.0, 1.0048 + d * (5.7e-4 + d * (-2.628e-2 + d * (3.682e-3 - d * 1.677e-4))));
}

double wind_response_s(double fall_speed_mps) {
  return fall_speed_mps / gravity_mps2;
}

glm::dvec3 step_velocity(const glm::dvec3& velocity_mps, const glm::dvec3& air_mps, double terminal_mps, double dt_s) {
  // dv/dt = g - (g/V^2)|u| u with u = v - air. Falling straight, that is (g/V^2)(V - u)(V + u): a relaxation to
  // V at the rate g(V + u)/V^2; sideways it is one to rest at the rate g|u|/V^2. The rates are frozen over the step.
  const glm::dvec3 u = velocity_mps - air_mps;
  const double per_speed = gravity_mps2 / (terminal_mps * terminal_mps);
  const double fallen = terminal_mps * -std::expm1(-gravity_mps2 * dt_s / terminal_mps);  // a drop at rest gains speed
  const double across = std::exp(-per_speed * std::max(glm::length(u), fallen) * dt_s);
  const double along = std::exp(-per_speed * (terminal_mps + std::abs(u.y)) * dt_s);
  return air_mps + glm::dvec3(u.x * across, -terminal_mps + (u.y + terminal_mps) * along, u.z * across);
}

}  // namespace petrichor
