// Where standing water could break: each test provokes one failure.
#include <gtest/gtest.h>

#include <cmath>

#include "components/transform.hpp"
#include "components/weather.hpp"
#include "systems/puddle/list.hpp"
#include "systems/puddle/puddle.hpp"
#include "systems/puddle/water.hpp"
#include "systems/puddle_frame.hpp"

namespace petrichor {
namespace {

constexpr double mps = 1e-3 / 3600.0;  // of a mm/h

struct Part {
  double seconds, rain, loss;  // mm/h
};

// An hour of showers, as steps of one length.
WaterStep hour(const HollowShape& h, const std::vector<Part>& parts, double step_s) {
  WaterStep sum;
  for (const Part& p : parts) {
    const auto steps = static_cast<std::int64_t>(std::llround(p.seconds / step_s));
    for (std::int64_t i = 0; i < steps; ++i) {
      const WaterStep s = fill(h, {p.rain * mps, p.loss * mps}, sum.depth_m, step_s);
      sum.depth_m = s.depth_m;
      sum.arrived_m3 += s.arrived_m3;
      sum.spilled_m3 += s.spilled_m3;
      sum.lost_m3 += s.lost_m3;
    }
  }
  return sum;
}

const std::vector<Part> showers{{600, 12, 4}, {540, 0, 4.1}, {600, 0.9, 4}, {300, 60, 4}, {960, 0, 4.1}, {600, 3, 4}};

// Euler's rule overshoots the equilibrium in steps of a minute and loses water at the bottom and the brim.
TEST(Puddles, StepsOfAMinuteAndOfAFrameGiveTheSameDepth) {
  for (const bool upright : {false, true}) {
    for (const double mean_share : {0.334, 0.42, 0.5}) {
      const HollowShape h{0.011, 1.4, 9.0, upright, mean_share};
      const WaterStep frames = hour(h, showers, 1.0 / 60.0), minutes = hour(h, showers, 60.0);
      EXPECT_NEAR(frames.depth_m, minutes.depth_m, 1e-3 * minutes.depth_m);
      EXPECT_NEAR(frames.spilled_m3, minutes.spilled_m3, 1e-3 * minutes.arrived_m3);
      EXPECT_NEAR(frames.lost_m3, minutes.lost_m3, 1e-3 * minutes.arrived_m3);
      for (const WaterStep& s : {frames, minutes}) {
        EXPECT_NEAR(s.arrived_m3, volume_m3(h, s.depth_m) + s.spilled_m3 + s.lost_m3, 1e-3 * s.arrived_m3);
        EXPECT_GT(s.spilled_m3, 0.0) << "a test that never overflows";
        EXPECT_GT(s.lost_m3, 0.0);
      }
    }
  }
}

// The losses that the ledger closes with are what the wet area really lets through, not what happens to be left over.
TEST(Puddles, OverflowAndLossesAreNoRemainder) {
  const HollowShape h{0.011, 1.4, 9.0, false, 0.4};
  double depth = 0.002, spilled = 0.0, lost = 0.0, through_m3 = 0.0;
  for (const Part& p : showers) {
    for (double t = 0.0; t < p.seconds; t += 0.05) {
      const WaterStep s = fill(h, {p.rain * mps, p.loss * mps}, depth, 0.05);
      through_m3 += p.loss * mps * 0.05 * 0.5 * (wet_area_m2(h, depth) + wet_area_m2(h, s.depth_m));
      depth = s.depth_m;
      spilled += s.spilled_m3;
      lost += s.lost_m3;
    }
  }
  EXPECT_GT(spilled, 0.0);
  EXPECT_NEAR(lost, through_m3, 1e-3 * through_m3);
}

TEST(Puddles, ARateThatJumpsFromNothingToACloudburstAndBackStaysInTheHollow) {
  const HollowShape h{0.012, 2.0, 30.0, false, 0.4};
  double depth = 0.0, stored = 0.0, balance = 0.0;
  for (int i = 0; i < 5000; ++i) {
    const double rain = i % 2 ? 200.0 : 0.0, loss = i % 3 ? 2.0 : 5000.0;
    const double before = depth;
    const WaterStep s = fill(h, {rain * mps, loss * mps}, depth, i % 7 ? 1.0 / 120.0 : 90.0);
    depth = s.depth_m;
    ASSERT_TRUE(std::isfinite(depth) && depth >= 0.0 && depth <= h.depth_m) << i;
    ASSERT_GE(s.spilled_m3, 0.0) << i;
    ASSERT_GE(s.lost_m3, -1e-15) << i << " " << before << " -> " << depth;
    balance += s.arrived_m3 - s.spilled_m3 - s.lost_m3;
    stored = volume_m3(h, depth);
  }
  EXPECT_NEAR(stored, balance, 1e-9);
}

// Extremes that make the closed form divide by nothing or subtract what is alike.
TEST(Puddles, NoRateIsTooSmallOrTooLargeForTheClosedForm) {
  for (const double mean_share : {1.0 / 3.0, 0.4, 0.5}) {
    const HollowShape h{0.01, 1.0, 4.0, false, mean_share};
    for (const double rain : {0.0, 1e-12, 1e-6, 1e-3, 0.25, 0.2500000001, 10.0, 1e6}) {
      for (const double loss : {0.0, 1e-12, 1e-6, 1e-3, 1.0, 1e6}) {
        for (const double start : {0.0, 1e-12, 1e-5, 0.004, 0.01}) {
          for (const double duration : {1e-6, 1.0 / 120.0, 60.0, 3600.0, 1e8}) {
            const WaterStep s = fill(h, {rain * mps, loss * mps}, start, duration);
            ASSERT_TRUE(std::isfinite(s.depth_m + s.lost_m3 + s.spilled_m3)) << rain << " " << loss << " " << start;
            ASSERT_GE(s.depth_m, 0.0);
            ASSERT_LE(s.depth_m, h.depth_m);
            if (4.0 * rain <= loss * 0.99) {
              ASSERT_EQ(s.spilled_m3, 0.0) << rain << " " << loss << " " << start;
            }
            // Halfway and on is as good as at once.
            const double halves = fill(h, {rain * mps, loss * mps},
                                       fill(h, {rain * mps, loss * mps}, start, 0.5 * duration).depth_m, 0.5 * duration)
                                      .depth_m;
            ASSERT_NEAR(halves, s.depth_m, 1e-6 * h.depth_m) << rain << " " << loss << " " << start << " " << duration;
          }
        }
      }
    }
  }
}

TEST(Puddles, DrainsDryAndStaysDry) {
  const HollowShape h{0.012, 1.0, 3.0, false, 0.4};
  const WaterStep s = fill(h, {0.0, 6.0 * mps}, 0.012, 4.0 * 3600.0);
  EXPECT_EQ(s.depth_m, 0.0);
  EXPECT_NEAR(s.lost_m3, volume_m3(h, 0.012), 1e-12) << "no more is lost than there was";
}

// The frame is drawn between ticks and in any order: the same moment gives the same level, however it is reached.
TEST(Puddles, LevelIsOfTheMomentNotOfTheFramesBefore) {
  const auto run = [](double step_s, double until_s) {
    Registry registry;
    const Entity weather = registry.create(), hollow = registry.create();
    registry.emplace<Emitter>(weather).rain_mm_per_hour = 5.0f;
    Puddle p;
    p.initial_fill = 0.1f;
    registry.emplace<Puddle>(hollow, p);
    registry.emplace<WorldTransform>(hollow, WorldTransform{});
    for (double t = step_s; t < until_s + 0.5 * step_s; t += step_s) simulate_puddles(registry, t, step_s);
    return puddle_at(registry.get<PuddleWater>(hollow), until_s).depth_m;
  };
  EXPECT_NEAR(run(1.0 / 120.0, 30.0), run(1.0, 30.0), 1e-12);
}

TEST(Puddles, WithoutWaterNothingIsMadeForTheGpu) {
  Registry registry;
  const Entity weather = registry.create(), hollow = registry.create();
  registry.emplace<Emitter>(weather).rain_mm_per_hour = 0.0f;
  registry.emplace<Puddle>(hollow);
  glm::mat4 ahead(1.0f);
  ahead[3] = {0, -1, -5, 1};
  registry.emplace<WorldTransform>(hollow, WorldTransform{ahead});
  simulate_puddles(registry, 0.01, 0.01);
  Frame frame;
  frame.width = 160, frame.height = 90;
  extract_puddles(registry, frame);
  ASSERT_TRUE(frame.puddles);
  const PassOffer pass = puddle_passes().front();
  EXPECT_FALSE(pass.wanted(frame)) << "a dry hollow asks for no pass";
  Frame empty;
  EXPECT_FALSE(pass.wanted(empty));
  EXPECT_EQ(list_puddles(*frame.puddles, {}).head.counts.z, 0u);
}

}  // namespace
}  // namespace petrichor
