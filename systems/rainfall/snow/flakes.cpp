#include "systems/rainfall/snow/flakes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace petrichor {
namespace {

constexpr double drop_mg_per_mm3 = std::numbers::pi / 6.0;  // water: 1 mg/mm3
constexpr double mm_per_hour_per_mg_flux = 3.6e-3;          // mg per m2 and second: 1e-6 mm of water

// Integral of N(x) f(D(x)) over flakes from one size to another; Simpson in ln x.
double integral(const FlakeSizeDistribution& d, double from_mm, double to_mm, const std::function<double(double)>& f) {
  const double low = melted_mm(from_mm), high = melted_mm(to_mm);
  constexpr int pairs = 64;
  const double step = std::log(high / low) / (2 * pairs);
  double sum = 0.0;
  for (int i = 0; i <= 2 * pairs; ++i) {
    const double x = low * std::exp(i * step);
    const double weight = i == 0 || i == 2 * pairs ? 1.0 : (i % 2 ? 4.0 : 2.0);
    sum += weight * x * d.n0 * std::exp(-d.slope_per_mm * x) * f(diameter_of_melted_mm(x));
  }
  return sum * step / 3.0;
}

double water_mm_per_hour(const FlakeSizeDistribution& d) {
  return mm_per_hour_per_mg_flux * integral(d, smallest_flake_mm, largest_flake_mm,
                                            [](double mm) { return flake_mass_mg(mm) * flake_speed_mps(mm); });
}

}  // namespace

double flake_mass_mg(double diameter_mm) {
  return 0.073 * std::pow(diameter_mm, 1.4);
}

double flake_speed_mps(double diameter_mm) {
  return 0.8 * std::pow(diameter_mm, 0.16);
}

double flake_area_mm2(double diameter_mm) {
  return 22.85 * std::pow(0.1 * diameter_mm, 1.88);
}

double melted_mm(double diameter_mm) {
  return std::cbrt(flake_mass_mg(diameter_mm) / drop_mg_per_mm3);
}

double diameter_of_melted_mm(double melted) {
  return std::pow(drop_mg_per_mm3 * melted * melted * melted / 0.073, 1.0 / 1.4);
}

double density(const FlakeSizeDistribution& d, double melted) {
  const double mm = diameter_of_melted_mm(melted);
  return mm < smallest_flake_mm || mm > largest_flake_mm ? 0.0 : d.n0 * std::exp(-d.slope_per_mm * melted);
}

FlakeSizeDistribution solve_flake_sizes(double rate) {
  FlakeSizeDistribution d;
  if (!(rate > 0.0)) return d;
  d.n0 = 3800.0 * std::pow(rate, -0.87);
  // The water falls with the slope: bisection between none and one that leaves only the smallest flakes.
  double low = 0.0, high = 100.0;
  for (int i = 0; i < 60; ++i) {
    d.slope_per_mm = 0.5 * (low + high);
    (water_mm_per_hour(d) > rate ? low : high) = d.slope_per_mm;
  }
  d.n0 *= rate / water_mm_per_hour(d);
  return d;
}

double snow_mm_per_hour(const FlakeClass& c) {
  return mm_per_hour_per_mg_flux * c.flakes_per_m3 * flake_mass_mg(c.diameter_mm) * c.fall_speed_mps;
}

double extinction_per_m(const FlakeClass& c) {
  return c.flakes_per_m3 * c.area_mm2 * 1e-6;
}

std::vector<FlakeClass> make_flake_classes(double rate) {
  // The same answer for the same question; most frames ask what the last one did.
  thread_local double asked = -1.0;
  thread_local std::vector<FlakeClass> answer;
  if (asked == rate) return answer;
  const FlakeSizeDistribution now = solve_flake_sizes(rate), base = solve_flake_sizes(1.0);
  answer.clear();
  const double ratio = largest_flake_mm / smallest_flake_mm;
  for (int k = 0; k < flake_size_classes; ++k) {
    const double from = smallest_flake_mm * std::pow(ratio, double(k) / flake_size_classes),
                 to = smallest_flake_mm * std::pow(ratio, double(k + 1) / flake_size_classes);
    const auto one = [](double) { return 1.0; };
    const double number = integral(now, from, to, one), base_number = integral(base, from, to, one);
    const double middle = std::sqrt(from * to), speed = flake_speed_mps(middle);
    FlakeClass c{from, to, speed, middle, flake_area_mm2(middle), 0.0, 0.0};
    if (number > 0.0) {
      const double water = integral(now, from, to, [](double mm) { return flake_mass_mg(mm) * flake_speed_mps(mm); });
      c.diameter_mm = std::pow(water / (number * speed * 0.073), 1.0 / 1.4);
      c.area_mm2 = integral(now, from, to, flake_area_mm2) / number;
    }
    for (std::size_t s = 0; s < speed_offset.size(); ++s) {
      c.fall_speed_mps = speed + flake_speed_deviation_mps * speed_offset[s];
      c.flakes_per_m3 = number * speed_share[s];
      // A floor keeps the cells of the rarest flakes at some ten metres.
      c.base_flakes_per_m3 = std::max(base_number * speed_share[s], 0.02);
      answer.push_back(c);
    }
  }
  asked = rate;
  return answer;
}

}  // namespace petrichor
