#include "systems/drops/drop_physics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace petrichor {
namespace {

struct Measured {
  double diameter_mm, speed_mps;
};

// Gunn and Kinzer 1949, typed here a second time.
constexpr Measured gunn_kinzer[] = {{0.1, 0.27}, {0.2, 0.72}, {0.3, 1.17}, {0.4, 1.62}, {0.5, 2.06}, {0.6, 2.47},
                                    {0.8, 3.27}, {1.0, 4.03}, {1.4, 5.17}, {2.0, 6.49}, {2.6, 7.57}, {3.0, 8.06},
                                    {3.6, 8.60}, {4.0, 8.83}, {4.6, 9.03}, {5.0, 9.09}, {5.4, 9.14}, {5.8, 9.17}};

TEST(TerminalSpeed, AgreesWithGunnAndKinzer) {
  for (const Measured& m : gunn_kinzer) EXPECT_NEAR(terminal_speed_mps(m.diameter_mm), m.speed_mps, 0.01 * m.speed_mps);
}

TEST(TerminalSpeed, LiesBetweenTheTableWithinTheFitsOfOthers) {
  // Atlas, Srivastava and Sekhon 1973 is within 2% of the measurements from 0.5 to 5.8 mm.
  for (double d = 0.5; d <= 5.8; d += 0.01) {
    const double atlas = 9.65 - 10.3 * std::exp(-0.6 * d);
    EXPECT_NEAR(terminal_speed_mps(d), atlas, 0.025 * atlas) << d;
  }
}

TEST(TerminalSpeed, IsNeverNegativeNorNaNAndNeverFallsWithDiameter) {
  double before = 0.0;
  for (double d = 0.0; d < 20.0; d += 0.001) {
    const double v = terminal_speed_mps(d);
    ASSERT_TRUE(std::isfinite(v)) << d;
    ASSERT_GE(v, before) << d;
    before = v;
  }
  EXPECT_GT(terminal_speed_mps(0.05), 0.0);
  EXPECT_EQ(terminal_speed_mps(-1.0), 0.0);
  EXPECT_EQ(terminal_speed_mps(std::nan("")), 0.0);
}

TEST(TerminalSpeed, OfDrizzleIsStokes) {
  // 2 (rho_w - rho_a) g r^2 / (9 mu), mu = 1.81e-5 Pa s; at 0.03 mm the Reynolds number is 0.1.
  const double r = 0.5 * 0.03e-3;
  EXPECT_NEAR(terminal_speed_mps(0.03), 2.0 / 9.0 * 997.0 * 9.81 * r * r / 1.81e-5, 0.2 * 0.027);
}

TEST(AxisRatio, AgreesWithTheShapesOfBeardAndChuang) {
  // From the series r(theta) = a (1 + sum c_n cos n theta), rows 2, 3 and 5 mm of the paper, c_0..c_10 x 1e4.
  const double rows[3][11] = {{-131, -120, -376, -96, -4, 15, 5, 0, -2, 0, 1},
                              {-282, -230, -779, -175, 21, 46, 11, -6, -7, 0, 3},
                              {-644, -416, -1629, -246, 176, 131, 2, -44, -18, 9, 14}};
  const double diameters[3] = {2.0, 3.0, 5.0};
  for (int i = 0; i < 3; ++i) {
    double top = 0, bottom = 0, half_width = 0;
    for (int step = 0; step <= 1800; ++step) {
      const double theta = step * M_PI / 1800.0;
      double r = 1.0;
      for (int n = 0; n < 11; ++n) r += rows[i][n] * 1e-4 * std::cos(n * theta);
      top = std::max(top, -r * std::cos(theta));
      bottom = std::max(bottom, r * std::cos(theta));
      half_width = std::max(half_width, r * std::sin(theta));
    }
    EXPECT_NEAR(axis_ratio(diameters[i]), (top + bottom) / (2.0 * half_width), 0.006) << diameters[i];
  }
  EXPECT_NEAR(axis_ratio(0.5), 1.0, 0.01);
}

TEST(Drag, StaysBoundedAtAnyStep) {
  // Explicit Euler diverges beyond 2V/g: 55 ms for a 0.1 mm drop.
  for (double diameter : {0.05, 0.1, 0.5, 2.0, 5.0}) {
    const double terminal = terminal_speed_mps(diameter);
    for (double dt : {1.0 / 240, 1.0 / 60, 1.0 / 15, 0.1, 0.25, 1.0}) {
      glm::dvec3 v(0.0);
      for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 air(i / 50 % 2 ? 8.0 : -8.0, 0.0, i / 70 % 2 ? 3.0 : 0.0);
        v = step_velocity(v, air, terminal, dt);
        ASSERT_LE(std::abs(v.x), 8.0 + 1e-9) << diameter << " mm, " << dt << " s";
        ASSERT_GE(v.y, -terminal - 1e-9);
        ASSERT_LE(v.y, 1e-9);
      }
      EXPECT_NEAR(v.y, -terminal, 0.05 * terminal);
    }
  }
}

TEST(Drag, FollowsAGustAsFastAsMeasuredDropsDo) {
  // 63% of a 5 m/s gust; times by Runge-Kutta of the quadratic law.
  const double expected[][2] = {{0.5, 0.13}, {1.0, 0.34}, {2.0, 0.61}, {3.0, 0.78}, {5.0, 0.89}};
  for (const auto& [diameter, time] : expected) {
    const double terminal = terminal_speed_mps(diameter);
    glm::dvec3 v(0.0, -terminal, 0.0);
    double t = 0.0;
    while (v.x < 0.632 * 5.0 && t < 5.0) {
      v = step_velocity(v, glm::dvec3(5.0, 0.0, 0.0), terminal, 1e-3);
      t += 1e-3;
    }
    EXPECT_NEAR(t, time, 0.1 * time) << diameter;
  }
}

TEST(Drag, FromRestTakesTheFallThatDropsTake) {
  // Fall to 95% of the terminal speed: 1.9 m (1 mm), 5.0 (2), 9.8 (5).
  const double expected[][2] = {{1.0, 1.9}, {2.0, 5.0}, {5.0, 9.8}};
  for (const auto& [diameter, fall] : expected) {
    const double terminal = terminal_speed_mps(diameter);
    glm::dvec3 v(0.0);
    double fallen = 0.0;
    while (-v.y < 0.95 * terminal && fallen < 50.0) {
      v = step_velocity(v, glm::dvec3(0.0), terminal, 1e-3);
      fallen -= v.y * 1e-3;
    }
    EXPECT_NEAR(fallen, fall, 0.05 * fall) << diameter;
  }
}

}  // namespace
}  // namespace petrichor
