// The running field against counting and against integrals.
#include "systems/rainfall/measure.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "systems/drops/drop_physics.hpp"
#include "systems/drops/drop_sizes.hpp"
#include "systems/rainfall/extract.hpp"
#include "tests/engine/platform/gl_test.hpp"
#include "tests/systems/rainfall/field.hpp"

namespace petrichor {
namespace {

using RainMeasure = test::GlTest;

TEST_F(RainMeasure, WaterThatFallsIsTheWaterThatWasAsked) {
  for (const double rate : {0.5, 2.5, 10.0, 50.0, 100.0}) {
    for (const double wind : {0.0, 6.0}) {
      const auto m = measure_rain(rate, wind, 4.0, 3);
      ASSERT_TRUE(m) << m.error().message;
      EXPECT_NEAR(m->measured_mm_per_hour, rate, 0.02 * rate) << "wind " << wind;
    }
  }
}

TEST_F(RainMeasure, CountsAreThoseOfTheLiterature) {
  const double expected[][3] = {{2.5, 400, 1258}, {10, 845, 2919}, {50, 1743, 6797}};
  for (const auto& [rate, drops, impacts] : expected) {
    const auto m = measure_rain(rate, 0.0, 4.0, 1);
    ASSERT_TRUE(m);
    EXPECT_NEAR(m->drops_per_m3, drops, 0.03 * drops) << rate;
    EXPECT_NEAR(m->impacts_per_m2_s, impacts, 0.03 * impacts) << rate;
    EXPECT_NEAR(m->mean_fall_speed_mps, impacts / drops, 0.02 * impacts / drops) << rate;
  }
}

TEST_F(RainMeasure, NoRespawnBias) {
  // Water through a plane is water in the air times its speed. A field that replaces fallen drops by ones drawn from
  // the air's distribution has too few large ones and loses 41% of the water at 10 mm/h.
  Emitter emitter;
  emitter.rain_mm_per_hour = 10.0f;
  double first = 0.0;
  for (const double seconds : {1.0, 12.0}) {  // the same early and late
    const auto m = measure_rain(emitter, {}, seconds);
    ASSERT_TRUE(m);
    EXPECT_NEAR(m->measured_mm_per_hour, 10.0, 0.3);
    if (first == 0.0) first = m->mean_fall_speed_mps;
    EXPECT_NEAR(m->mean_fall_speed_mps, first, 0.02 * first);
  }
}

TEST_F(RainMeasure, AgreesDropByDropWithTheFieldOnTheCpu) {
  // Without wind the drops that cross the square within a time are those that stand below it, by less than they fall
  // in that time, at its end.
  Emitter emitter;
  emitter.rain_mm_per_hour = 20.0f;
  constexpr double seconds = 0.4;
  const FrameRain rain = make_frame_rain(emitter, start_rain_motion(emitter, {}), FrameCamera{}, 160, 90, seconds);
  double counted = 0.0;
  for (const FieldDrop& d : drops_in(rain, glm::dvec3(0.0), {glm::dvec3(-5.0, -4.0, -5.0), glm::dvec3(5.0, 1e-9, 5.0)}))
    counted += d.position_m.y > -seconds * rain.classes[d.cls].fall_speed_mps;
  const auto m = measure_rain(emitter, {}, seconds);
  ASSERT_TRUE(m);
  // Drops within a micrometre of an edge may be seen on either side of it in single precision.
  EXPECT_NEAR(static_cast<double>(m->drops_counted), counted, 1e-4 * counted);
  EXPECT_GT(counted, 1e5);
}

TEST_F(RainMeasure, GammaSizesToo) {
  Emitter emitter;
  emitter.drop_sizes = DropSizes::gamma;
  emitter.gamma_shape = 3.0f;
  emitter.rain_mm_per_hour = 25.0f;
  Wind wind;
  wind.velocity_mps = {4.0f, 0.0f, 0.0f};
  wind.gust_mps = 3.0f;
  wind.swirl_mps = 2.0f;
  const auto m = measure_rain(emitter, wind, 4.0);
  ASSERT_TRUE(m);
  EXPECT_NEAR(m->measured_mm_per_hour, 25.0, 0.5);
}

}  // namespace
}  // namespace petrichor
