#include "systems/rainfall/streaks/table.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "systems/drops/drop_optics.hpp"

namespace petrichor {
namespace {

constexpr double pi = std::numbers::pi;

struct Place {  // between two nodes
  int low, high;
  double share;  // of the high one
};

Place place_of(double value, double lowest, double highest, int nodes) {
  const double at = std::clamp((value - lowest) / (highest - lowest), 0.0, 1.0) * (nodes - 1);
  const int low = std::clamp(static_cast<int>(at), 0, std::max(nodes - 2, 0));
  return {low, std::min(low + 1, nodes - 1), at - low};
}

struct Corner {
  int entry;
  double weight;
};

std::array<Corner, 8> corners_of(const StreakGrid& g, const StreakAngles& angles, bool nearest_four) {
  const double light = nearest_four ? std::abs(angles.light_elevation) : angles.light_elevation;
  Place v = place_of(nearest_four ? 0.0 : angles.view_elevation, -0.5 * pi, 0.5 * pi, g.view);
  if (nearest_four) v.share = std::round(v.share);  // the nearest view of the table to level
  const Place l = place_of(light, -0.5 * pi, 0.5 * pi, g.light), a = place_of(angles.azimuth, 0.0, pi, g.azimuth);
  std::array<Corner, 8> corners;
  for (int i = 0; i < 8; ++i) {
    const bool hv = i & 4, hl = i & 2, ha = i & 1;
    corners[i] = {((hv ? v.high : v.low) * g.light + (hl ? l.high : l.low)) * g.azimuth + (ha ? a.high : a.low),
                  (hv ? v.share : 1.0 - v.share) * (hl ? l.share : 1.0 - l.share) * (ha ? a.share : 1.0 - a.share)};
  }
  return corners;
}

}  // namespace

StreakAngles streak_angles(const glm::dvec3& eye, const glm::dvec3& lamp) {
  const double across = std::hypot(eye.x, eye.z) * std::hypot(lamp.x, lamp.z);
  const double cosine = across > 1e-12 ? (eye.x * lamp.x + eye.z * lamp.z) / across : 1.0;
  return {std::asin(std::clamp(eye.y, -1.0, 1.0)), std::asin(std::clamp(lamp.y, -1.0, 1.0)),
          std::acos(std::clamp(cosine, -1.0, 1.0))};
}

double turn_cosine(const StreakAngles& a) {
  return -(std::sin(a.view_elevation) * std::sin(a.light_elevation) +
           std::cos(a.view_elevation) * std::cos(a.light_elevation) * std::cos(a.azimuth));
}

double streak_modulation(const StreakTable& t, const StreakAngles& angles, double along, double oscillation,
                         bool nearest_four) {
  const double x = (along - std::floor(along)) * t.along, y = (oscillation - std::floor(oscillation)) * t.oscillations;
  const int x0 = static_cast<int>(x) % t.along, x1 = (x0 + 1) % t.along;
  const int y0 = static_cast<int>(y) % t.oscillations, y1 = (y0 + 1) % t.oscillations;
  const double fx = x - std::floor(x), fy = y - std::floor(y);
  double sum = 0.0;
  for (const Corner& c : corners_of(t.grid, angles, nearest_four)) {
    const float* m = &t.modulation[std::size_t(c.entry) * t.oscillations * t.along];
    const double low = m[y0 * t.along + x0] * (1.0 - fx) + m[y0 * t.along + x1] * fx;
    const double high = m[y1 * t.along + x0] * (1.0 - fx) + m[y1 * t.along + x1] * fx;
    sum += c.weight * (low * (1.0 - fy) + high * fy);
  }
  return sum;
}

double streak_phase(const StreakTable& t, const StreakAngles& angles, bool nearest_four) {
  double sum = 0.0;
  for (const Corner& c : corners_of(t.grid, angles, nearest_four)) sum += c.weight * std::log(t.mean[c.entry]);
  StreakAngles seen = angles;
  if (nearest_four) seen.view_elevation = 0.0, seen.light_elevation = std::abs(seen.light_elevation);
  const double sine = std::sqrt(std::clamp(0.5 - 0.5 * turn_cosine(seen), 0.0, 1.0));
  return std::exp(sum) * t.phase[std::min(static_cast<int>(sine * drop_phase_bins), drop_phase_bins - 1)];
}

double streak_profile(const StreakTable& t, const StreakAngles& angles, double across, bool nearest_four) {
  const double x = std::clamp(0.5 * (across + 1.0) * t.across - 0.5, 0.0, t.across - 1.0);
  const int x0 = static_cast<int>(x), x1 = std::min(x0 + 1, t.across - 1);
  double sum = 0.0;
  for (const Corner& c : corners_of(t.grid, angles, nearest_four)) {
    const float* p = &t.profile[std::size_t(c.entry) * t.across];
    sum += c.weight * (p[x0] * (1.0 - (x - x0)) + p[x1] * (x - x0));
  }
  return sum;
}

}  // namespace petrichor
