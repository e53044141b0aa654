#include "systems/puddle/balance.hpp"

#include <algorithm>
#include <cmath>

namespace petrichor {
namespace {

struct Bowl {
  double a, b;  // wet area a x + b x^2, of that when full

  explicit Bowl(const HollowShape& h) : a(6.0 * h.mean_share - 2.0), b(3.0 - 6.0 * h.mean_share) {}
  double area(double x) const { return x * (a + b * x); }
  double volume(double x) const { return x * x * (a / 2.0 + b * x / 3.0); }
};

// Root of an increasing function between two values, by Newton's steps kept inside what is left of the bracket.
template <class Value, class Slope>
double root(double low, double high, double start, Value&& value, Slope&& slope) {
  double x = std::clamp(start, low, high);
  for (int i = 0; i < 200; ++i) {
    const double v = value(x);
    const double newton = v / slope(x);
    if (std::abs(newton) <= 4e-16 * std::abs(x)) return x;  // as near as numbers lie
    (v > 0.0 ? high : low) = x;
    const double next = x - newton;
    x = next > low && next < high ? next : 0.5 * (low + high);
    if (x <= low || x >= high) return x;
  }
  return x;
}

// A bowl below its brim: A(x) H dx/dt = q - e A(x), where q is what arrives by the area when full and e the loss. Its
// equilibrium is at x = limit. With u = x / limit and partial fractions
//   F(u) = -(1 + r) u + ln(1 + r u) - ln|1 - u|,   r = (S - a) / (S + a),   S^2 = a^2 + 4 b q / e,
// grows evenly in time, by e^2 S / (q H) a second.
struct Filling {
  Bowl bowl;
  double depth_m, q, e;
  double s, r, limit, rate;

  Filling(const HollowShape& h, double arrives, double loses) : bowl(h), depth_m(h.depth_m), q(arrives), e(loses) {
    s = std::sqrt(bowl.a * bowl.a + 4.0 * bowl.b * q / e);
    r = (s - bowl.a) / (s + bowl.a);
    limit = 2.0 * (q / e) / (bowl.a + s);
    rate = e * e * s / (q * depth_m);
  }

  // Both for 0 <= u < 1, with the first terms of their series where the logarithms cancel each other.
  double f(double u) const {
    if (u > 0.02) return -(1.0 + r) * u + std::log1p(r * u) - std::log1p(-u);
    double sum = 0.0;
    for (int n = 10; n >= 3; --n) sum = sum * u + (1.0 - std::pow(-r, n)) / n;
    return u * u * (second() / 2.0 + u * sum);
  }
  double slope(double u) const {
    if (u > 0.02) return -(1.0 + r) + r / (1.0 + r * u) + 1.0 / (1.0 - u);
    double sum = 0.0;
    for (int n = 10; n >= 3; --n) sum = sum * u + (1.0 - std::pow(-r, n));
    return u * (second() + u * sum);
  }
  double second() const { return 4.0 * bowl.a * s / ((s + bowl.a) * (s + bowl.a)); }  // 1 - r^2

  double after(double x, double duration_s) const {
    const double u = x / limit;
    if (u == 1.0) return x;
    if (u < 1.0) {  // rising: t = -ln(1 - u) goes on to infinity
      const double target = f(u) + rate * duration_s;
      const auto u_of = [](double t) { return -std::expm1(-t); };
      const double from = -std::log1p(-u);
      const double t = root(
          from, target + 2.0, from + rate * duration_s, [&](double at) { return f(u_of(at)) - target; },
          [&](double at) { return slope(u_of(at)) * std::exp(-at); });
      return limit * u_of(t);
    }
    // Falling towards it: w = ln(u - 1) goes down without end.
    const auto g = [&](double w) { return (1.0 + r) * std::exp(w) - std::log1p(r * (1.0 + std::exp(w))) + w; };
    const double from = std::log(u - 1.0), target = g(from) - rate * duration_s;
    const double w = root(
        std::min(from - rate * duration_s - 10.0, target - 10.0), from, from, [&](double at) { return g(at) - target; },
        [&](double at) {
          const double v = std::exp(at);
          return 1.0 + v * ((1.0 + r) - r / (1.0 + r * (1.0 + v)));
        });
    return limit * (1.0 + std::exp(w));
  }

  // When the water comes to the brim; it does, as q > e.
  double time_to_brim(double x) const { return std::max((f(1.0 / limit) - f(x / limit)) / rate, 0.0); }
};

// Losses or gains so small against the other that their effect is lost in rounding.
constexpr double nothing = 1e-13;

double bowl_after(const HollowShape& h, double q, double e, double x, double duration_s) {
  if (duration_s <= 0.0) return x;
  const Bowl bowl(h);
  if (q <= nothing * e) return std::max(x - e * duration_s / h.depth_m, 0.0);  // whatever the shape
  if (e <= nothing * q) {
    const double volume = std::min(bowl.volume(x) + q * duration_s / h.depth_m, bowl.volume(1.0));
    return root(
        x, 1.0, std::sqrt(x * x + 2.0 * q * duration_s / h.depth_m),
        [&](double at) { return bowl.volume(at) - volume; }, [&](double at) { return bowl.area(at); });
  }
  return Filling(h, q, e).after(x, duration_s);
}

double bowl_time_to_brim(const HollowShape& h, double q, double e, double x) {
  const Bowl bowl(h);
  if (x >= 1.0) return 0.0;
  if (e <= nothing * q) return (bowl.volume(1.0) - bowl.volume(x)) * h.depth_m / q;
  return Filling(h, q, e).time_to_brim(x);
}

}  // namespace

double volume_m3(const HollowShape& h, double depth_m) {
  if (h.upright) return h.area_m2 * depth_m;
  return h.area_m2 * h.depth_m * Bowl(h).volume(depth_m / h.depth_m);
}

double wet_area_m2(const HollowShape& h, double depth_m) {
  if (h.upright) return depth_m > 0.0 ? h.area_m2 : 0.0;
  return h.area_m2 * Bowl(h).area(depth_m / h.depth_m);
}

WaterStep fill(const HollowShape& hollow, const WaterFlow& flow, double depth_m, double duration_s) {
  const double q = flow.rain_mps * hollow.catchment_m2 / hollow.area_m2, e = flow.loss_mps;
  const double x = std::clamp(depth_m / hollow.depth_m, 0.0, 1.0);
  WaterStep step;
  double filling_s = duration_s, end = x;
  if (hollow.upright) {
    const double rise_per_s = (q - e) / hollow.depth_m;
    if (rise_per_s > 0.0) filling_s = std::min(duration_s, (1.0 - x) / rise_per_s);
    end = std::clamp(x + rise_per_s * filling_s, 0.0, 1.0);
  } else {
    if (q > e) filling_s = std::min(duration_s, bowl_time_to_brim(hollow, q, e, x));
    end = std::clamp(bowl_after(hollow, q, e, x, filling_s), 0.0, 1.0);
  }
  if (filling_s < duration_s) {  // at the brim: all that arrives beyond the losses runs over
    end = 1.0;
    step.spilled_m3 = (q - e) * hollow.area_m2 * (duration_s - filling_s);
  }
  step.depth_m = end * hollow.depth_m;
  step.arrived_m3 = q * hollow.area_m2 * duration_s;
  step.lost_m3 =
      step.arrived_m3 - step.spilled_m3 - (volume_m3(hollow, step.depth_m) - volume_m3(hollow, x * hollow.depth_m));
  return step;
}

double evaporation_mm_per_hour(double temperature_c, double relative_humidity) {
  // Magnus' formula for the vapour pressure over water, hPa; then kg/m3 by the gas law.
  const double pressure = 6.112 * std::exp(17.62 * temperature_c / (243.12 + temperature_c));
  const double saturated = 100.0 * pressure / (461.5 * (273.15 + temperature_c));
  constexpr double transfer_mps = 0.007, water_kg_per_m3 = 1000.0;
  return transfer_mps * saturated * (1.0 - relative_humidity) / water_kg_per_m3 * 3.6e6;
}

}  // namespace petrichor
