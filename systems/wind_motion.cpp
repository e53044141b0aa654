#include "systems/wind_motion.hpp"

#include <cmath>
#include <numbers>

namespace petrichor {
namespace {

// Periods relative to gust_period_s, without a small common multiple, and shares of the amplitude (sum 1).
constexpr std::array<double, gust_waves> period_ratio{1.0, 0.6180339887, 0.4142135624, 0.2360679775};
constexpr std::array<double, gust_waves> share{0.45, 0.28, 0.17, 0.10};
constexpr std::array<double, gust_waves> start_gust{0.0, 1.3, 2.9, 4.4};
constexpr std::array<double, gust_waves> start_swirl{2.1, 0.4, 5.2, 3.3};

struct Basis {
  glm::dvec3 along, across;
};

Basis basis(const Wind& wind) {
  const glm::dvec3 level(wind.velocity_mps.x, 0.0, wind.velocity_mps.z);
  const double speed = glm::length(level);
  const glm::dvec3 along = speed > 1e-6 ? level / speed : glm::dvec3(1.0, 0.0, 0.0);
  return {along, glm::dvec3(-along.z, 0.0, along.x)};
}

double angular(const Wind& wind, int wave) {
  return 2.0 * std::numbers::pi / (std::max(double(wind.gust_period_s), 0.05) * period_ratio[wave]);
}

// Velocity and its integral (from minus infinity's mean) of the steady answer, elapsed seconds after the anchor.
Drift steady(const WindMotion& motion, double response_s, double elapsed_s) {
  const Basis b = basis(motion.wind);
  const glm::dvec3 mean(motion.wind.velocity_mps);
  glm::dvec3 velocity = mean, displacement = mean * elapsed_s;
  for (int i = 0; i < gust_waves; ++i) {
    const double w = angular(motion.wind, i);
    const double gain = share[i] / std::sqrt(1.0 + w * w * response_s * response_s);
    const double lag = std::atan(w * response_s);
    const auto wave = [&](double amplitude, double phase, const glm::dvec3& axis) {
      const double now = phase + w * elapsed_s - lag;
      velocity += axis * (amplitude * gain * std::sin(now));
      displacement -= axis * (amplitude * gain / w * (std::cos(now) - std::cos(phase - lag)));
    };
    wave(motion.wind.gust_mps, motion.gust_phase[i], b.along);
    wave(motion.wind.swirl_mps, motion.swirl_phase[i], b.across);
  }
  return {displacement, velocity};
}

bool same(const Wind& a, const Wind& b) {
  return a.velocity_mps == b.velocity_mps && a.gust_mps == b.gust_mps && a.gust_period_s == b.gust_period_s &&
         a.swirl_mps == b.swirl_mps;
}

}  // namespace

WindMotion start_wind_motion(const Wind& wind, std::span<const double> response_s) {
  WindMotion motion;
  motion.wind = wind;
  motion.gust_phase = start_gust;
  motion.swirl_phase = start_swirl;
  for (double r : response_s) motion.answers.push_back({r, glm::dvec3(0.0), glm::dvec3(0.0)});
  return motion;
}

void follow_wind(WindMotion& motion, const Wind& wind, double time_s) {
  if (same(motion.wind, wind)) return;
  WindMotion next = motion;
  next.wind = wind;
  next.anchor_s = time_s;
  const double elapsed = time_s - motion.anchor_s;
  for (int i = 0; i < gust_waves; ++i) {
    const double turn = angular(motion.wind, i) * elapsed;
    next.gust_phase[i] = std::fmod(motion.gust_phase[i] + turn, 2.0 * std::numbers::pi);
    next.swirl_phase[i] = std::fmod(motion.swirl_phase[i] + turn, 2.0 * std::numbers::pi);
  }
  for (std::size_t k = 0; k < motion.answers.size(); ++k) {
    const Drift before = drift_at(motion, k, time_s);
    next.answers[k].displacement_m = before.displacement_m;
    next.answers[k].transient_mps = before.velocity_mps - steady(next, next.answers[k].response_s, 0.0).velocity_mps;
  }
  motion = std::move(next);
}

Drift drift_at(const WindMotion& motion, std::size_t index, double time_s) {
  const WindAnswer& answer = motion.answers[index];
  const double elapsed = time_s - motion.anchor_s;
  Drift drift = steady(motion, answer.response_s, elapsed);
  drift.displacement_m += answer.displacement_m;
  if (answer.response_s > 0.0 && answer.transient_mps != glm::dvec3(0.0)) {
    const double left = std::exp(-elapsed / answer.response_s);
    drift.velocity_mps += answer.transient_mps * left;
    drift.displacement_m += answer.transient_mps * (answer.response_s * (1.0 - left));
  }
  return drift;
}

glm::dvec3 wind_velocity(const WindMotion& motion, double time_s) {
  return steady(motion, 0.0, time_s - motion.anchor_s).velocity_mps;
}

}  // namespace petrichor
