#include <gtest/gtest.h>

#include <cmath>

#include "systems/drops/drop_physics.hpp"
#include "systems/wind_motion.hpp"

namespace petrichor {
namespace {

Wind gusty() {
  Wind wind;
  wind.velocity_mps = {3.0f, 0.0f, 4.0f};
  wind.gust_mps = 2.0f;
  wind.gust_period_s = 5.0f;
  wind.swirl_mps = 1.0f;
  return wind;
}

const double responses[] = {0.0, 0.2, 0.9};

TEST(WindMotion, DisplacementIsTheIntegralOfVelocity) {
  const WindMotion motion = start_wind_motion(gusty(), responses);
  for (std::size_t k = 0; k < 3; ++k) {
    glm::dvec3 sum(0.0);
    constexpr double dt = 1e-3;
    for (int i = 0; i < 20000; ++i) sum += drift_at(motion, k, (i + 0.5) * dt).velocity_mps * dt;
    const glm::dvec3 closed = drift_at(motion, k, 20.0).displacement_m - drift_at(motion, k, 0.0).displacement_m;
    EXPECT_LT(glm::length(sum - closed), 1e-5) << k;
  }
}

TEST(WindMotion, AnswerObeysTheLowPass) {
  const WindMotion motion = start_wind_motion(gusty(), responses);
  constexpr double h = 1e-4;
  for (double t = 0.3; t < 30.0; t += 0.37) {
    const glm::dvec3 slope =
        (drift_at(motion, 2, t + h).velocity_mps - drift_at(motion, 2, t - h).velocity_mps) / (2.0 * h);
    const glm::dvec3 expected = (wind_velocity(motion, t) - drift_at(motion, 2, t).velocity_mps) / responses[2];
    EXPECT_LT(glm::length(slope - expected), 1e-5);
  }
}

TEST(WindMotion, GustsStayWithinTheirAmplitude) {
  const WindMotion motion = start_wind_motion(gusty(), responses);
  glm::dvec3 mean(0.0);
  double largest = 0.0;
  for (int i = 0; i < 20000; ++i) {
    const glm::dvec3 v = wind_velocity(motion, i * 0.05);
    const glm::dvec3 extra = v - glm::dvec3(3, 0, 4);
    largest = std::max(largest, std::abs(glm::dot(extra, glm::dvec3(0.6, 0, 0.8))));
    mean += v / 20000.0;
  }
  EXPECT_LE(largest, 2.0);
  EXPECT_GT(largest, 1.6);
  EXPECT_LT(glm::length(mean - glm::dvec3(3, 0, 4)), 0.02);
}

TEST(WindMotion, ChangingWindIsFollowedContinuously) {
  // A tween of the mean wind and the gusts, one change per tick: the closed form must agree with the low-pass
  // integrated in small steps, and nothing may jump.
  WindMotion motion = start_wind_motion(gusty(), responses);
  Wind wind = gusty();
  constexpr double tick = 1.0 / 60.0;
  glm::dvec3 velocity = drift_at(motion, 2, 0.0).velocity_mps, displacement(0.0);
  double previous_jump = 0.0;
  for (int i = 1; i <= 600; ++i) {
    // Integrate the tick that has just passed, under the wind of that tick.
    constexpr int steps = 50;
    for (int j = 0; j < steps; ++j) {
      const double t = (i - 1) * tick + (j + 0.5) * tick / steps;
      const glm::dvec3 target = wind_velocity(motion, t);
      const double left = std::exp(-tick / steps / responses[2]);
      const glm::dvec3 next = target + (velocity - target) * left;
      displacement += 0.5 * (velocity + next) * (tick / steps);
      velocity = next;
    }
    const Drift before = drift_at(motion, 2, i * tick);
    wind.velocity_mps.x = 3.0f - 0.01f * static_cast<float>(i);
    wind.gust_period_s = 5.0f + 0.002f * static_cast<float>(i);
    wind.gust_mps = i > 300 ? 0.0f : 2.0f;
    follow_wind(motion, wind, i * tick);
    const Drift after = drift_at(motion, 2, i * tick);
    previous_jump = std::max({previous_jump, glm::length(after.displacement_m - before.displacement_m),
                              glm::length(after.velocity_mps - before.velocity_mps)});
  }
  EXPECT_LT(previous_jump, 1e-9);
  EXPECT_LT(glm::length(drift_at(motion, 2, 10.0).displacement_m - displacement), 2e-3);
}

TEST(WindMotion, UnchangedWindNeedsNoHistory) {
  const WindMotion alone = start_wind_motion(gusty(), responses);
  WindMotion stepped = alone;
  for (int i = 1; i < 900; ++i) follow_wind(stepped, gusty(), i / 60.0);
  EXPECT_EQ(drift_at(stepped, 1, 15.0).displacement_m, drift_at(alone, 1, 15.0).displacement_m);
}

TEST(WindMotion, LargeTimesStayFinite) {
  const WindMotion motion = start_wind_motion(gusty(), responses);
  const Drift drift = drift_at(motion, 1, 1e6);
  EXPECT_TRUE(std::isfinite(drift.displacement_m.x) && std::isfinite(drift.velocity_mps.z));
  EXPECT_NEAR(drift.displacement_m.x, 3e6, 100.0);
}

}  // namespace
}  // namespace petrichor
