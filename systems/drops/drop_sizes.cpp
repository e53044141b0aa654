#include "systems/drops/drop_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "systems/drops/drop_physics.hpp"

namespace petrichor {
namespace {

constexpr double pi = std::numbers::pi;
// (pi/6) (mm)^3 per m2 and second as mm/h: 1e-9 m3 * 1000 mm/m * 3600 s/h.
constexpr double mm_per_hour_per_flux = pi / 6.0 * 3.6e-3;

double flux_mm_per_hour(const DropSizeDistribution& d) {
  return mm_per_hour_per_flux * moment(d, 3.0, 1.0, d.minimum_mm, d.maximum_mm);
}

}  // namespace

double density(const DropSizeDistribution& d, double diameter_mm) {
  if (diameter_mm < d.minimum_mm || diameter_mm > d.maximum_mm) return 0.0;
  return d.n0 * std::pow(diameter_mm, d.shape) * std::exp(-d.slope_per_mm * diameter_mm);
}

double moment(const DropSizeDistribution& d, double power, double speed_power, double from_mm, double to_mm) {
  from_mm = std::max(from_mm, d.minimum_mm);
  to_mm = std::min(to_mm, d.maximum_mm);
  if (!(to_mm > from_mm)) return 0.0;
  // Simpson in ln D, in steps of at most 1/100 of an e-fold: the table's kinks limit it to about 1e-6.
  const int pairs = std::max(8, static_cast<int>(std::ceil(50.0 * std::log(to_mm / from_mm))));
  const double step = std::log(to_mm / from_mm) / (2 * pairs);
  double sum = 0.0;
  for (int i = 0; i <= 2 * pairs; ++i) {
    const double x = i == 2 * pairs ? to_mm : from_mm * std::exp(i * step);
    const double weight = i == 0 || i == 2 * pairs ? 1.0 : (i % 2 ? 4.0 : 2.0);
    const double speed = speed_power == 0.0 ? 1.0 : std::pow(terminal_speed_mps(x), speed_power);
    sum += weight * x * d.n0 * std::pow(x, d.shape + power) * std::exp(-d.slope_per_mm * x) * speed;
  }
  return sum * step / 3.0;
}

DropSizeDistribution solve_distribution(DropSizes sizes, double gamma_shape, double maximum_mm,
                                        double rain_mm_per_hour) {
  DropSizeDistribution d;
  d.minimum_mm = smallest_drop_mm;
  d.maximum_mm = std::max(maximum_mm, 2.0 * smallest_drop_mm);
  if (!(rain_mm_per_hour > 0.0)) return d;

  d.n0 = 8000.0;
  // The flux falls with the slope, nearly as slope^-4.67: secant steps of its logarithm, kept in a bracket.
  double low = 0.0, high = 60.0;
  d.slope_per_mm = std::clamp(4.25 * std::pow(rain_mm_per_hour, -0.215), 0.5, 50.0);
  for (int i = 0; i < 60; ++i) {
    const double ratio = flux_mm_per_hour(d) / rain_mm_per_hour;
    if (std::abs(ratio - 1.0) < 1e-9) break;
    (ratio > 1.0 ? low : high) = d.slope_per_mm;
    const double step = d.slope_per_mm * std::pow(ratio, 1.0 / 4.67);
    d.slope_per_mm = step > low && step < high ? step : 0.5 * (low + high);
  }
  if (sizes == DropSizes::gamma) {
    const double median_volume_mm = 3.67 / std::max(d.slope_per_mm, 0.1);
    d.shape = gamma_shape;
    d.slope_per_mm = (3.67 + gamma_shape) / median_volume_mm;
  }
  // Gamma's free factor; for Marshall-Palmer 1, but where the drops are capped so small that even a flat
  // distribution of 8000 carries too little (or the rate is below what a slope of 60 gives).
  d.n0 *= rain_mm_per_hour / flux_mm_per_hour(d);
  return d;
}

double rain_mm_per_hour(const DropClass& c) {
  return mm_per_hour_per_flux * c.drops_per_m3 * c.diameter_mm * c.diameter_mm * c.diameter_mm * c.fall_speed_mps;
}

double extinction_per_m(const DropClass& c) {
  return c.drops_per_m3 * pi / 4.0 * c.diameter_mm * c.diameter_mm * 1e-6;
}

namespace {

std::vector<DropClass> compute_drop_classes(const Emitter& emitter, int drawn) {
  const double top = std::max<double>(emitter.maximum_diameter_mm, 2.0 * smallest_drop_mm);
  const double bottom = std::clamp<double>(emitter.minimum_diameter_mm, smallest_drop_mm, 0.99 * top);
  const auto now = solve_distribution(emitter.drop_sizes, emitter.gamma_shape, top, emitter.rain_mm_per_hour);
  const auto base = solve_distribution(emitter.drop_sizes, emitter.gamma_shape, top, 1.0);

  std::vector<DropClass> classes;
  const auto add = [&](double from, double to, bool drawn) {
    DropClass c{};
    c.from_mm = from;
    c.to_mm = to;
    c.drawn = drawn;
    const double middle = std::sqrt(from * to);
    c.fall_speed_mps = terminal_speed_mps(middle);
    c.drops_per_m3 = moment(now, 0.0, 0.0, from, to);
    c.diameter_mm = middle;
    if (c.drops_per_m3 > 0.0) {
      c.diameter_mm = std::cbrt(moment(now, 3.0, 1.0, from, to) / (c.drops_per_m3 * c.fall_speed_mps));
    }
    // A floor keeps the cells of the rarest drops at some ten metres.
    c.base_drops_per_m3 = std::max(moment(base, 0.0, 0.0, from, to), 0.02);
    classes.push_back(c);
  };
  const auto split = [&](double from, double to, int count, bool drawn) {
    if (!(to > from * 1.001)) return;
    for (int k = 0; k < count; ++k) {
      add(from * std::pow(to / from, double(k) / count), from * std::pow(to / from, double(k + 1) / count), drawn);
    }
  };
  split(smallest_drop_mm, bottom, undrawn_classes, false);
  split(bottom, top, drawn, true);
  return classes;
}

}  // namespace

std::vector<DropClass> make_drop_classes(const Emitter& emitter, int drawn) {
  // The same answer for the same question; most frames ask what the last one did.
  thread_local Emitter asked;
  thread_local int asked_drawn = 0;
  thread_local std::vector<DropClass> answer;
  const bool same = !answer.empty() && asked_drawn == drawn && asked.rain_mm_per_hour == emitter.rain_mm_per_hour &&
                    asked.drop_sizes == emitter.drop_sizes && asked.gamma_shape == emitter.gamma_shape &&
                    asked.minimum_diameter_mm == emitter.minimum_diameter_mm &&
                    asked.maximum_diameter_mm == emitter.maximum_diameter_mm;
  if (!same) {
    answer = compute_drop_classes(emitter, drawn);
    asked = emitter;
    asked_drawn = drawn;
  }
  return answer;
}

}  // namespace petrichor
