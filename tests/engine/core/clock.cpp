#include "engine/core/clock.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace petrichor {
namespace {

int run(FixedClock& clock, double real_s) {
  const int steps = advance(clock, real_s);
  for (int i = 0; i < steps; ++i) step(clock);
  return steps;
}

TEST(Clock, StepsAreCountedNotSummed) {
  FixedClock clock{.step_s = 1.0 / 60.0};
  for (int i = 0; i < 600; ++i) EXPECT_EQ(run(clock, 1.0 / 60.0), 1) << "frame " << i;
  EXPECT_EQ(clock.tick, 600);
  EXPECT_EQ(simulated_s(clock), 600 * (1.0 / 60.0));  // exactly: frame 600 needs no frame 599
}

TEST(Clock, OddFramesAddUp) {
  FixedClock clock{.step_s = 0.01};
  double real_s = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double frame_s = 0.003 + 0.00001 * (i % 37);
    real_s += frame_s;
    run(clock, frame_s);
    EXPECT_GE(interpolation(clock), 0.0);
    EXPECT_LT(interpolation(clock), 1.0);
  }
  EXPECT_EQ(clock.dropped_s, 0.0);
  EXPECT_NEAR(simulated_s(clock) + clock.left_over_s, real_s, 1e-6);
}

TEST(Clock, InterpolationIsTheUnsimulatedShare) {
  FixedClock clock{.step_s = 0.1};
  EXPECT_EQ(run(clock, 0.25), 2);
  EXPECT_NEAR(interpolation(clock), 0.5, 1e-9);
}

TEST(Clock, ALongFrameDoesNotPileUp) {
  FixedClock clock{.step_s = 0.01, .most_steps = 5};
  EXPECT_EQ(run(clock, 3600.0), 5) << "a laptop that slept";
  EXPECT_LT(clock.left_over_s, clock.step_s);
  EXPECT_NEAR(clock.dropped_s, 3600.0 - 0.05, 1e-6);
  EXPECT_EQ(run(clock, 0.01), 1) << "and then goes on as before";
  EXPECT_EQ(run(clock, 1e300), 5);
}

TEST(Clock, NonsenseCountsAsNoTime) {
  FixedClock clock;
  EXPECT_EQ(run(clock, 0.0), 0);
  EXPECT_EQ(run(clock, -1.0), 0);
  EXPECT_EQ(run(clock, std::numeric_limits<double>::quiet_NaN()), 0);
  EXPECT_EQ(run(clock, std::numeric_limits<double>::infinity()), 0);
  EXPECT_EQ(clock.left_over_s, 0.0);
}

}  // namespace
}  // namespace petrichor
