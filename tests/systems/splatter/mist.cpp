// The cloud of droplets over a surface that rain strikes.
#include "systems/splatter/mist.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "systems/drops/drop_physics.hpp"
#include "systems/splatter/stage.hpp"

namespace petrichor {
namespace {

TEST(Mist, ThrowsUpNoMoreWaterAndEnergyThanTheDropBrings) {
  for (double d = 0.5; d < 6.0; d += 0.25) {
    const double v = terminal_speed_mps(d);
    double volume = 0.0, energy = 0.0, count = 0.0, section = 0.0;
    droplets_of(d, v, splash_of(d, v).droplets, [&](const Droplet& one) {
      volume += one.weight * std::pow(one.diameter_mm, 3);
      energy += one.weight * std::pow(one.diameter_mm, 3) * one.speed_mps * one.speed_mps;
      section += one.weight * one.diameter_mm * one.diameter_mm;
      count += one.weight;
    });
    EXPECT_LE(volume, 0.35 * d * d * d) << d;
    EXPECT_LE(energy, 0.1 * d * d * d * v * v) << d;
    EXPECT_NEAR(count, splash_of(d, v).droplets, 1e-9);
    EXPECT_NEAR(section / count / (d * d), crown_section, 0.05 * crown_section) << d;
  }
}

TEST(Mist, SmallDropsSpreadLargeOnesSplash) {
  EXPECT_EQ(splash_of(0.6, terminal_speed_mps(0.6)).share, 0.0);
  EXPECT_EQ(splash_of(2.0, terminal_speed_mps(2.0)).share, 1.0);
  // Cossali's threshold on a film of a tenth of the drop: 1.04 mm (physics, section 6).
  const double half = splash_of(1.04, terminal_speed_mps(1.04)).share;
  EXPECT_GT(half, 0.2);
  EXPECT_LT(half, 0.8);
}

TEST(Mist, StandsAFewCentimetresHighAndThickensWithTheRate) {
  float last = 0.0f;
  for (const float rate : {2.5f, 10.0f, 50.0f, 100.0f}) {
    const SplashMist m = splash_mist(still_rain(rate));
    EXPECT_GT(m.height_m, 0.01f);
    EXPECT_LT(m.height_m, 0.1f);
    EXPECT_GT(m.extinction_per_m, last);
    last = m.extinction_per_m;
  }
  // Impacts of more than a millimetre: 3746 on a square metre a second at 50 mm/h (physics, section 1).
  EXPECT_NEAR(splash_mist(still_rain(50.0f)).crowns_per_m2_s, 3746.0f, 400.0f);
  EXPECT_EQ(splash_mist(still_rain(0.0f)).column(), 0.0f);
}

// Without drag a droplet is aloft for 2 v sin(e) / g.
TEST(Mist, AHeavyDropletFliesAParabola) {
  double time = 0.0, top = 0.0;
  fly({0.3, 0.5, 0.0}, 5.0, 1e-3, 0.0, [&](const glm::dvec3& p, const glm::dvec3&) {
    time += 1e-3;
    top = std::max(top, p.y);
    return true;
  });
  EXPECT_NEAR(time, 2.0 * 0.5 / gravity_mps2, 0.004);
  EXPECT_NEAR(top, 0.5 * 0.5 / (2.0 * gravity_mps2), 2e-4);
}

}  // namespace
}  // namespace petrichor
