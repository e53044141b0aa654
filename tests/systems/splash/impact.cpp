// Formulas of impacts against the figures of the shared physics, section 6.
#include "systems/splash/impact.h"

#include <gtest/gtest.h>

#include "systems/drops/drop_physics.hpp"

namespace petrichor {
namespace {

float terminal(float diameter_mm) {
  return static_cast<float>(terminal_speed_mps(diameter_mm));
}

// The least diameter, mm, that a terminal drop splashes at.
template <class Number>
float threshold_mm(Number number) {
  for (float d = 0.3f; d < 6.0f; d += 0.002f)
    if (number(d * 1e-3f, terminal(d)) > 1.0f) return d;
  return 99.0f;
}

TEST(Impact, NumbersOfTerminalDropsAreThoseOfTheTable) {
  const float table[4][4] = {{1, 223, 4020, 119}, {2, 1155, 12950, 363}, {3, 2670, 24100, 644}, {4, 4275, 35200, 896}};
  for (const auto& [mm, we, re, k] : table) {
    const float d = mm * 1e-3f, v = terminal(mm);
    EXPECT_NEAR(impact::weber(d, v), we, 0.01f * we) << mm;
    EXPECT_NEAR(impact::reynolds(d, v), re, 0.01f * re) << mm;
    EXPECT_NEAR(impact::mundo_k(d, v), k, 0.01f * k) << mm;
  }
}

TEST(Impact, ThresholdsAreThoseOfTheLiterature) {
  EXPECT_NEAR(threshold_mm(impact::splash_on_dry), 0.69f, 0.02f);          // Mundo
  EXPECT_NEAR(threshold_mm(impact::splash_on_wetted), 0.92f, 0.03f);       // Bai and Gosman
  EXPECT_NEAR(threshold_mm(impact::splash_on_smooth), 3.6f, 0.15f);        // Stow and Hadfield
  const float film[3][2] = {{0.1f, 1.04f}, {0.5f, 1.30f}, {1.0f, 1.67f}};  // Cossali
  for (const auto& [h, mm] : film)
    EXPECT_NEAR(threshold_mm([h = h](float d, float v) { return impact::splash_on_film(d, v, h * d); }), mm, 0.03f);
}

TEST(Impact, PolishedStoneSpreadsWhatAsphaltSplashes) {
  const float d = 2e-3f, v = terminal(2.0f);
  EXPECT_GT(impact::splash_number(d, v, 0.0f, 0.85f), 1.0f);
  EXPECT_LT(impact::splash_number(d, v, 0.0f, 0.1f), 1.0f);
}

TEST(Impact, GlancingDropsSpread) {
  // 2 mm at its full speed along the surface, and 0.5 m/s across it.
  EXPECT_LT(impact::splash_number(2e-3f, 0.5f, 0.0f, 0.85f), 1.0f);
  EXPECT_LT(impact::splash_number(2e-3f, 0.5f, 3e-4f, 0.85f), 1.0f);
}

TEST(Impact, CrownsGrowWithTheSquareRootOfTime) {
  const float d = 2e-3f, v = terminal(2.0f), film = 0.25f * d, t = 4.0f * d / v;
  // (2/3)^(1/4) (1/4)^(-1/4) sqrt(4) = 2.556 diameters.
  EXPECT_NEAR(impact::crown_radius(d, v, film, t) / d, 2.556f, 0.01f);
  EXPECT_NEAR(impact::crown_radius(d, v, film, 0.25f * t) / impact::crown_radius(d, v, film, t), 0.5f, 1e-3f);
  EXPECT_NEAR(2.0f * impact::corona_radius(d, v) / d, 5.8f, 0.1f);  // greatest spread at 2 mm
}

TEST(Impact, DropletsAreSmallerFasterAndFewEnough) {
  for (float mm = 1.0f; mm <= 6.0f; mm += 0.5f) {
    const float d = mm * 1e-3f, v = terminal(mm);
    const unsigned n = impact::secondary_count(d, v);
    EXPECT_GE(n, 10u);
    EXPECT_LE(n, 100u);
    EXPECT_NEAR(impact::secondary_diameter(d, 0.0f) / d, 0.05f, 1e-4f);
    EXPECT_NEAR(impact::secondary_diameter(d, 1.0f) / d, 0.25f, 1e-4f);
    EXPECT_NEAR(impact::secondary_speed(v, d, 0.05f * d) / v, 1.0f, 0.01f);
    EXPECT_NEAR(impact::secondary_speed(v, d, 0.25f * d) / v, 0.1f, 0.001f);
  }
}

TEST(Impact, WaysOfDropletsStartFreeAndEndAtTerminalSpeed) {
  const float d = 3e-4f, u = 2.0f, dt = 1e-4f;
  const auto early = impact::secondary_way(u, d, dt);
  EXPECT_NEAR(early.x / dt, u, 0.01f * u);
  EXPECT_NEAR(early.y, 0.5f * 9.81f * dt * dt, 2e-7f);
  const auto a = impact::secondary_way(u, d, 2.0f), b = impact::secondary_way(u, d, 2.1f);
  EXPECT_NEAR((b.y - a.y) / 0.1f, impact::droplet_fall_speed(d), 0.02f);
}

}  // namespace
}  // namespace petrichor
