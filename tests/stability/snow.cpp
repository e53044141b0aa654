// Where falling snow could break: each test provokes one failure.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "../systems/rainfall/snow_gl/fixture.hpp"
#include "systems/drops/drop_physics.hpp"

namespace petrichor {
namespace {

class SnowStability : public SnowTest {};

TEST_F(SnowStability, DragBlowsUpOnAHitch) {
  // Explicit Euler with quadratic drag, as one writes it first: a slow flake (0.2 m/s: V/g is 20 ms) in a gust of 5 m/s
  // flies off at a hitch of 0.1 s. The exponential step, and the field's closed form, do not.
  const double terminal = 0.2, hitch_s = 0.1;
  const glm::dvec3 air(5.0, 0.0, 0.0);
  glm::dvec3 euler(0.0, -terminal, 0.0), ours = euler;
  double worst_euler = 0.0, worst_ours = 0.0;
  for (int i = 0; i < 4; ++i) {
    const glm::dvec3 u = euler - air;
    euler +=
        (glm::dvec3(0.0, -gravity_mps2, 0.0) - gravity_mps2 / (terminal * terminal) * glm::length(u) * u) * hitch_s;
    ours = step_velocity(ours, air, terminal, hitch_s);
    worst_euler = std::max(worst_euler, glm::length(euler));
    worst_ours = std::max(worst_ours, glm::length(ours));
  }
  EXPECT_GT(worst_euler, 1e4);
  EXPECT_LT(worst_ours, 5.1);
  EXPECT_NEAR(ours.x, 5.0, 0.05);

  WindMotion motion = start_snow_motion({});
  Wind gust;
  gust.velocity_mps = {5.0f, 0.0f, 0.0f};
  follow_wind(motion, gust, 1.0);
  for (const double later : {0.0, 0.001, 0.1, 0.5, 10.0})
    for (std::size_t k = 0; k < motion.answers.size(); ++k) {
      const double speed = drift_at(motion, k, 1.0 + later).velocity_mps.x;
      EXPECT_GE(speed, -1e-9);
      EXPECT_LE(speed, 5.0 + 1e-9);
    }
}

TEST_F(SnowStability, A100KilometresFromTheOrigin) {
  // Fails if places are in single precision, where 100 km has steps of 8 mm: flakes would stand and jump. Between two
  // frames the picture changes as much as at the origin, and so does its mean.
  const auto s = wall(8.0f);
  double change[2] = {}, mean[2] = {};
  for (const bool far : {false, true}) {
    std::vector<float> last;
    for (int i = 0; i < 4; ++i) {
      SnowView view;
      view.camera_m = far ? glm::dvec3(1e5, 1.7, 1e5 + 30.0) : glm::dvec3(0.0, 1.7, 30.0);
      Frame frame = snow_frame(view, 86400.0 + i * 2e-3);
      snow_on(frame, snow_of(3.0f));
      const auto light = light_of(*s, frame);
      mean[far] += mean_of(light) / 4.0;
      if (!last.empty()) change[far] += difference(light, last);
      last = light;
    }
  }
  EXPECT_NEAR(mean[1], mean[0], 0.006);
  EXPECT_NEAR(change[1] / change[0], 1.0, 0.2);
}

TEST_F(SnowStability, TeleportOf10Kilometres) {
  // Fails if anything of the frame before is kept.
  const auto jumping = wall(8.0f), fresh = wall(8.0f);
  const auto draw = [&](RainStage& stage, double x_m, double time_s, std::uint64_t number) {
    SnowView view;
    view.camera_m.x = x_m;
    Frame frame = snow_frame(view, time_s);
    frame.number = number;
    snow_on(frame, snow_of(2.0f));
    return light_of(stage, frame);
  };
  const auto before = draw(*jumping, 3.0, 5.0, 0);
  EXPECT_EQ(draw(*jumping, 10'003.0, 5.1, 1), draw(*fresh, 10'003.0, 5.1, 7));
  EXPECT_EQ(draw(*jumping, 3.0, 5.0, 2), before);
}

TEST_F(SnowStability, FallingWithTheSnow) {
  // A camera that falls as fast as a class of flakes: these stand still but for their sway; nothing divides by nothing.
  const auto s = wall(8.0f);
  Frame frame = snow_frame({.exposure_s = 0.1f}, 5.0);
  snow_on(frame, snow_of(2.0f));
  frame.camera.velocity_mps = frame.snow->classes[13].velocity_mps;
  snow_on(frame, snow_of(2.0f));
  for (const float sway : {0.0f, 1.0f}) {
    frame.snow->sway = sway;
    for (const float v : light_of(*s, frame)) ASSERT_TRUE(v >= 0.0f && v <= 1.001f) << v;
  }
}

TEST_F(SnowStability, RateStepsFromNothingToABlizzard) {
  // 0 to 30 mm/h and back at once: sums do not wrap where near flakes overlap, and nothing is left of the one frame in
  // the next.
  const auto s = wall(20.0f);
  const SnowView view;
  for (const float rate : {0.02f, 30.0f, 0.0f, 30.0f, 1.0f}) {
    Frame frame = snow_frame(view, 11.0);
    if (rate > 0.0f) snow_on(frame, snow_of(rate, 22.0f, 600'000));
    const double extinction = frame.snow ? frame.snow->extinction_per_m : 0.0;
    const auto light = light_of(*s, frame);
    for (const float v : light) ASSERT_TRUE(v >= 0.0f && v <= 1.001f) << v;
    // One frame: its few nearest flakes deviate by 1% of the background.
    EXPECT_NEAR(mean_of(light), expected_transmittance(extinction, 20.0, view), 0.02) << rate;
  }
}

TEST_F(SnowStability, LongExposureFollowsTheHelix) {
  // Half a second is up to one and a half turns of a helix. Drawn as a straight line from its beginning to its end a
  // flake would be swept over what lies between: its path is drawn in pieces. The long exposure is the mean of the
  // short ones.
  const auto s = wall(5.0f);
  const auto at = [&](double time_s, float exposure_s, float sway) {
    Frame frame = snow_frame({.width = 320, .height = 180, .fov_deg = 20.0f, .exposure_s = exposure_s}, time_s);
    Snowfall snowfall = snow_of(1.0f, 6.0f);
    snowfall.sway = sway;
    snow_on(frame, snowfall);
    return light_of(*s, frame);
  };
  const auto blurred = at(9.0, 0.5f, 1.0f), straight = at(9.0, 0.5f, 0.0f);
  std::vector<float> mean(blurred.size(), 0.0f);
  constexpr int instants = 100;
  for (int i = 0; i < instants; ++i) {
    const auto one = at(9.0 - 0.5 * (i + 0.5) / instants, 0.5f / instants, 1.0f);
    for (std::size_t p = 0; p < one.size(); ++p) mean[p] += one[p] / instants;
  }
  EXPECT_LT(difference(blurred, mean), 0.4 * difference(straight, mean));
}

}  // namespace
}  // namespace petrichor
