#include "systems/puddle/balance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "systems/puddle/street.hpp"

namespace petrichor {
namespace {

constexpr double mps = 1e-3 / 3600.0;  // of a mm/h

// dV/dt by volumes, explicit, so small steps that nothing is left to doubt; depth from volume by bisection.
WaterStep brute_force(const HollowShape& h, const WaterFlow& f, double depth_m, double duration_s, int steps) {
  WaterStep out;
  const double full = volume_m3(h, h.depth_m), dt = duration_s / steps;
  double volume = volume_m3(h, depth_m);
  const auto depth_of = [&](double v) {
    double low = 0.0, high = h.depth_m;
    for (int i = 0; i < 60; ++i) (volume_m3(h, 0.5 * (low + high)) < v ? low : high) = 0.5 * (low + high);
    return 0.5 * (low + high);
  };
  for (int i = 0; i < steps; ++i) {
    const double in = f.rain_mps * h.catchment_m2 * dt;
    const double lost = std::min(f.loss_mps * wet_area_m2(h, depth_of(volume)) * dt, volume + in);
    volume += in - lost;
    const double over = std::max(volume - full, 0.0);
    volume -= over;
    out.arrived_m3 += in;
    out.lost_m3 += lost;
    out.spilled_m3 += over;
  }
  out.depth_m = depth_of(volume);
  return out;
}

TEST(PuddleBalance, AgreesWithSmallSteps) {
  for (const double mean_share : {0.3334, 0.4, 0.5}) {
    for (const bool upright : {false, true}) {
      const HollowShape h{0.014, 2.0, 7.0, upright, mean_share};
      for (const double rain : {0.0, 0.7, 3.0, 12.0, 60.0}) {
        for (const double loss : {0.0, 0.1, 4.0, 21.0, 200.0}) {
          for (const double start : {0.001, 0.006, 0.0139}) {
            const WaterFlow f{rain * mps, loss * mps};
            const WaterStep exact = fill(h, f, start, 300.0), small = brute_force(h, f, start, 300.0, 3000);
            const double full = volume_m3(h, h.depth_m);
            // Explicit Euler's own error is of the order of the change in a step.
            const double allowed = 2e-3 * full;
            EXPECT_NEAR(volume_m3(h, exact.depth_m), volume_m3(h, small.depth_m), allowed) << rain << " " << loss;
            EXPECT_NEAR(exact.spilled_m3, small.spilled_m3, allowed) << rain << " " << loss;
            EXPECT_NEAR(exact.lost_m3, small.lost_m3, allowed) << rain << " " << loss << " " << start;
            EXPECT_NEAR(exact.arrived_m3, small.arrived_m3, 1e-12);
          }
        }
      }
    }
  }
}

TEST(PuddleBalance, FallsEvenlyWithoutRainWhateverTheShape) {
  // Every place under water loses as fast, so the level does too.
  for (const double mean_share : {0.3334, 0.45}) {
    const HollowShape h{0.02, 1.0, 5.0, false, mean_share};
    EXPECT_NEAR(fill(h, {0.0, 6.0 * mps}, 0.012, 3600.0).depth_m, 0.006, 1e-12);
    EXPECT_EQ(fill(h, {0.0, 6.0 * mps}, 0.012, 7201.0).depth_m, 0.0) << "dry, and not below";
  }
}

TEST(PuddleBalance, RestsWhereGainsEqualLosses) {
  const HollowShape h{0.02, 1.0, 5.0, false, 0.5};  // A = x: q = e x at x = q / e
  const double level = fill(h, {2.0 * mps, 20.0 * mps}, 0.001, 1e7).depth_m;
  EXPECT_NEAR(level, 0.02 * (5.0 * 2.0 / 20.0), 1e-9);
  EXPECT_NEAR(fill(h, {2.0 * mps, 20.0 * mps}, 0.019, 1e7).depth_m, level, 1e-9) << "from above, too";
}

TEST(PuddleBalance, EvaporatesAsTheHandbookSays) {
  EXPECT_NEAR(evaporation_mm_per_hour(12.0, 0.6), 0.107, 0.01);
  EXPECT_EQ(evaporation_mm_per_hour(12.0, 1.0), 0.0);
  // Shared physics, section 9: 0.05 to 0.3 mm/h.
  EXPECT_GT(evaporation_mm_per_hour(8.0, 0.75), 0.04);
  EXPECT_LT(evaporation_mm_per_hour(25.0, 0.5), 0.31);
}

// The chart's truth keeps every drop.
TEST(PuddleStreet, TruthKeepsItsLedger) {
  const StreetPatch patch = make_street_patch();
  ASSERT_GE(patch.hollows.size(), 6u);
  StreetTruth truth(patch);
  truth.advance(600.0, 0.5, 30.0 * mps, 3.0 * mps);
  truth.advance(900.0, 0.5, 0.0, 3.0 * mps);
  EXPECT_NEAR(truth.arrived_m3, truth.stored_m3() + truth.left_m3 + truth.lost_m3, 1e-9 * truth.arrived_m3);
  EXPECT_GT(truth.left_m3, 0.0);
  for (std::size_t n = 0; n < patch.hollows.size(); ++n) {
    EXPECT_LE(truth.level_m(n), patch.hollows[n].brim_m + 1e-9);
    EXPECT_LT(patch.hollows[n].spills_into, static_cast<int>(n)) << "water runs down";
  }
}

}  // namespace
}  // namespace petrichor
