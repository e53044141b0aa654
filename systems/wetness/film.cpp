#include "systems/wetness/film.hpp"

#include <algorithm>
#include <cmath>

namespace petrichor {
namespace {

constexpr double gravity_mps2 = 9.81, viscosity_m2ps = 1e-6, root3 = 1.7320508075688772;

// Time that x takes from 0, for dx/dt = 1 - x^3 (x < 1 or x > 1, each up to a constant) and dx/dt = -(1 + x^3).
double rising_time(double x) {
  return std::log((x * x + x + 1.0) / ((x - 1.0) * (x - 1.0))) / 6.0 + std::atan((2.0 * x + 1.0) / root3) / root3;
}
double falling_time(double x) {
  return std::log((x + 1.0) * (x + 1.0) / (x * x - x + 1.0)) / 6.0 + std::atan((2.0 * x - 1.0) / root3) / root3;
}

// The root of f between low and high, where f rises with x times `sign`: Newton, halving where it strays.
template <class Value, class Slope>
double solve(double low, double high, double x, Value value, Slope slope) {
  for (int i = 0; i < 80; ++i) {
    const double f = value(x);
    (f < 0.0 ? low : high) = x;
    double next = x - f / slope(x);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - x) <= 1e-13 * next) return next;
    x = next;
  }
  return x;
}

// dx/dt = 1 - x^3.
double relax(double x0, double t) {
  if (x0 == 1.0) return 1.0;
  const bool below = x0 < 1.0;
  // Near the end 1 - x^3 = -3 (x - 1) and the rest dies away as exp(-3 t).
  if (3.0 * t > 36.0) return 1.0;
  const double end = rising_time(x0) + t;
  if (below)
    return solve(
        x0, 1.0, std::min(x0 + t, 0.5 * (x0 + 1.0)), [&](double x) { return rising_time(x) - end; },
        [](double x) { return 1.0 / (1.0 - x * x * x); });
  // Above, time falls with x: x is between 1 and both x0 and 1/sqrt(2t) + 1.
  const double high = std::min(x0, 1.0 + 1.0 / std::sqrt(2.0 * t + 1e-300));
  return solve(
      1.0, high, 1.0 + 0.5 * (high - 1.0), [&](double x) { return end - rising_time(x); },
      [](double x) { return -1.0 / (1.0 - x * x * x); });
}

}  // namespace

double drain_per_m2s(double slope, double length_m) {
  return gravity_mps2 * slope / (3.0 * viscosity_m2ps * length_m);
}

double film_speed_mps(double slope, double film_m) {
  return gravity_mps2 * slope * film_m * film_m / (3.0 * viscosity_m2ps);
}

double drained_film_m(double film_m, double rate_mps, double c, double dt_s, double* left_s) {
  if (left_s) *left_s = 0.0;
  if (!(dt_s > 0.0)) return film_m;
  if (rate_mps == 0.0) return film_m / std::sqrt(1.0 + 2.0 * c * film_m * film_m * dt_s);
  const double scale = std::cbrt(std::abs(rate_mps) / c);  // m
  const double pace = std::abs(rate_mps) / scale;          // 1/s
  const double x0 = film_m / scale, t = dt_s * pace;
  if (rate_mps > 0.0) {
    // Far above the end nothing but the drain counts, and differences of times would cancel.
    if (x0 > 1e4 && t < 1e-10) return film_m / std::sqrt(1.0 + 2.0 * c * film_m * film_m * dt_s);
    return scale * relax(x0, t);
  }
  const double end = falling_time(x0) - t, bare = falling_time(0.0);
  if (end <= bare) {
    if (left_s) *left_s = (bare - end) / pace;
    return 0.0;
  }
  return scale * solve(
                     0.0, x0, x0 / std::sqrt(1.0 + 2.0 * x0 * x0 * t), [&](double x) { return falling_time(x) - end; },
                     [](double x) { return 1.0 / (1.0 + x * x * x); });
}

Film advance(Film f, const FilmLaw& law, double dt_s) {
  const double net = law.supply_mps - law.evaporation_mps;
  for (int phase = 0; phase < 8 && dt_s > 0.0; ++phase) {
    const bool full = f.pores_m >= law.pores_m * (1.0 - 1e-12);
    if (f.film_m <= 0.0 && net <= 0.0) {
      // Bare: the pores dry, ever more slowly, towards what the little rain keeps in them.
      f.film_m = 0.0;
      if (!(law.pores_m > 0.0) || !(law.evaporation_mps > 0.0)) return f;
      const double end = law.pores_m * law.supply_mps / law.evaporation_mps;
      f.pores_m = end + (f.pores_m - end) * std::exp(-dt_s * law.evaporation_mps / law.pores_m);
      return f;
    }
    if (full || !(law.absorption_mps > 0.0)) {
      double left = 0.0;
      f.film_m = drained_film_m(f.film_m, net, law.drain_per_m2s, dt_s, &left);
      dt_s = left;
      continue;
    }
    const bool soaks_all = f.film_m <= 0.0 && net <= law.absorption_mps;
    const double taken = soaks_all ? net : law.absorption_mps;
    const double fill_s = (law.pores_m - f.pores_m) / taken, step = std::min(dt_s, fill_s);
    double left = 0.0;
    f.film_m = soaks_all ? 0.0 : drained_film_m(f.film_m, net - taken, law.drain_per_m2s, step, &left);
    const double passed = step - left;
    f.pores_m = step == fill_s && left == 0.0 ? law.pores_m : std::min(f.pores_m + taken * passed, law.pores_m);
    dt_s -= passed;
  }
  return f;
}

double evaporation_mps(double temperature_c, double humidity, double wind_mps) {
  const double pressure_pa = 611.2 * std::exp(17.62 * temperature_c / (243.12 + temperature_c));
  const double saturated_kgpm3 = pressure_pa / (461.5 * (temperature_c + 273.15));
  const double transfer_mps = std::min(0.005 + 0.001 * wind_mps, 0.01);
  return transfer_mps * saturated_kgpm3 * (1.0 - humidity) / 998.0;
}

}  // namespace petrichor
