#include "systems/splatter/mist.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "systems/drops/drop_physics.hpp"

namespace petrichor {
namespace {

constexpr double water_kg_m3 = 998.0, surface_tension_n_m = 0.0728, viscosity_pa_s = 1.0e-3, pi = 3.14159265358979;

// Of one impact, per drop that splashes: integrals over its droplets' ways.
struct Cloud {
  double column_m2_s = 0.0;                    // cross-section times time
  double lift = 0.0, size = 0.0, speed = 0.0;  // the same times height (m), diameter (mm), vertical speed (m/s)
};

Cloud cloud_of(double diameter_mm) {
  const double strike_mps = terminal_speed_mps(diameter_mm);
  Cloud cloud;
  droplets_of(diameter_mm, strike_mps, splash_of(diameter_mm, strike_mps).droplets, [&](const Droplet& d) {
    const double section = d.weight * 0.25 * pi * d.diameter_mm * d.diameter_mm * 1e-6;
    constexpr double step_s = 1e-3;
    fly({d.speed_mps * std::cos(d.elevation_rad), d.speed_mps * std::sin(d.elevation_rad), 0.0}, d.diameter_mm, step_s,
        0.0, [&](const glm::dvec3& p, const glm::dvec3& v) {
          cloud.column_m2_s += section * step_s;
          cloud.lift += section * step_s * p.y;
          cloud.size += section * step_s * d.diameter_mm;
          cloud.speed += section * step_s * std::abs(v.y);
          return true;
        });
  });
  return cloud;
}

constexpr int cloud_sizes = 14;
constexpr double smallest_mm = 0.6, largest_mm = 6.0;

// Flown once: what a drop of a size throws up depends on nothing else.
Cloud cloud_by_table(double diameter_mm) {
  static const std::array<Cloud, cloud_sizes> table = [] {
    std::array<Cloud, cloud_sizes> all;
    for (int i = 0; i < cloud_sizes; ++i)
      all[static_cast<std::size_t>(i)] =
          cloud_of(smallest_mm * std::pow(largest_mm / smallest_mm, i / (cloud_sizes - 1.0)));
    return all;
  }();
  const double at = std::clamp(std::log(diameter_mm / smallest_mm) / std::log(largest_mm / smallest_mm), 0.0, 1.0) *
                    (cloud_sizes - 1);
  const auto low = std::min(static_cast<std::size_t>(at), std::size_t{cloud_sizes - 2});
  const double t = at - static_cast<double>(low);
  const Cloud &a = table[low], &b = table[low + 1];
  return {std::lerp(a.column_m2_s, b.column_m2_s, t), std::lerp(a.lift, b.lift, t), std::lerp(a.size, b.size, t),
          std::lerp(a.speed, b.speed, t)};
}

}  // namespace

Splash splash_of(double diameter_mm, double normal_speed_mps) {
  const double d = 1e-3 * diameter_mm;
  if (!(d > 0.0 && normal_speed_mps > 0.0)) return {0.0, 0.0};
  const double weber = water_kg_m3 * normal_speed_mps * normal_speed_mps * d / surface_tension_n_m;
  const double ohnesorge = viscosity_pa_s / std::sqrt(water_kg_m3 * surface_tension_n_m * d);
  const double film = std::clamp(film_m / d, 0.1, 1.0);
  const double k = weber * std::pow(ohnesorge, -0.4) / (2100.0 + 5880.0 * std::pow(film, 1.44));
  return {std::clamp((k - 0.8) / 0.4, 0.0, 1.0), std::clamp(10.0 * k, 10.0, 100.0)};
}

void droplets_of(double diameter_mm, double normal_speed_mps, double droplets,
                 const std::function<void(const Droplet&)>& each) {
  for (int i = 0; i < droplet_sizes; ++i) {
    const double size = 0.05 * std::pow(5.0, (i + 0.5) / droplet_sizes);  // of the drop's
    const double speed = 0.1 * std::pow(0.25 / size, std::log(10.0) / std::log(5.0));
    for (int j = 0; j < droplet_elevations; ++j) {
      const double elevation = (30.0 + 40.0 * (j + 0.5) / droplet_elevations) * pi / 180.0;
      each({size * diameter_mm, speed * normal_speed_mps, elevation, droplets / (droplet_sizes * droplet_elevations)});
    }
  }
}

void fly(const glm::dvec3& velocity_mps, double diameter_mm, double step_s, double lowest_m,
         const std::function<bool(const glm::dvec3&, const glm::dvec3&)>& at) {
  const double terminal = std::max(terminal_speed_mps(diameter_mm), 1e-3);
  glm::dvec3 p(0.0), v = velocity_mps;
  for (int i = 0; i < 4000; ++i) {
    // Quadratic drag, implicit, so that no step is too long; also upwards, where step_velocity's rate, which is made
    // for falling, is up to twice too large.
    const double drag = gravity_mps2 / (terminal * terminal) * glm::length(v);
    const glm::dvec3 next = (v - glm::dvec3(0.0, gravity_mps2 * step_s, 0.0)) / (1.0 + drag * step_s);
    const glm::dvec3 middle = 0.5 * (v + next);
    if (!at(p + 0.5 * step_s * middle, middle)) return;
    p += step_s * middle;
    v = next;
    if (p.y < lowest_m && v.y < 0.0) return;
  }
}

SplashMist splash_mist(const FrameRain& rain) {
  Cloud sum;
  SplashMist mist;
  double strikes = 0.0, size = 0.0, speed = 0.0;
  for (const RainClass& c : rain.classes) {
    const double splashing = splash_of(c.diameter_mm, c.fall_speed_mps).share * c.drops_per_m3 * c.fall_speed_mps;
    if (!(splashing > 0.0)) continue;
    const Cloud one = cloud_by_table(c.diameter_mm);
    sum.column_m2_s += splashing * one.column_m2_s;
    sum.lift += splashing * one.lift;
    sum.size += splashing * one.size;
    sum.speed += splashing * one.speed;
    strikes += splashing;
    size += splashing * c.diameter_mm;
    speed += splashing * c.fall_speed_mps;
  }
  if (!(sum.column_m2_s > 0.0 && sum.lift > 0.0)) return mist;
  mist.height_m = static_cast<float>(sum.lift / sum.column_m2_s);
  mist.extinction_per_m = static_cast<float>(sum.column_m2_s / mist.height_m);
  mist.droplet_mm = static_cast<float>(sum.size / sum.column_m2_s);
  mist.speed_mps = static_cast<float>(sum.speed / sum.column_m2_s);
  mist.crowns_per_m2_s = static_cast<float>(strikes);
  mist.crown_mm = static_cast<float>(size / strikes);
  mist.crown_speed_mps = static_cast<float>(speed / strikes);
  return mist;
}

}  // namespace petrichor
