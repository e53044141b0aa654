// Where scrolled textures on a cone break (shared physics 13 d): as Wang and Wade printed it, and mended.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "components/transform.hpp"
#include "components/view.hpp"
#include "systems/geometry/extract.hpp"
#include "systems/rainfall/cone/cone.hpp"
#include "systems/rainfall/extract.hpp"
#include "systems/rainfall/stage.hpp"
#include "tests/engine/platform/gl_test.hpp"

namespace petrichor {
namespace {

constexpr double tick_s = 1.0 / 120.0;

DoubleCone published() {
  DoubleCone set;
  set.published = true;
  return set;
}

// Ticks up to some time, with a camera that moves as `camera` says.
struct Flight {
  DoubleCone set;
  ConeTrack track{};
  ConeFlow flow{};
  int ticks = 0;
  void to(double time_s, auto camera) {
    for (; ticks * tick_s < time_s - 1e-9 || ticks == 0; ++ticks) {
      flow.camera_mps = camera(ticks * tick_s);
      advance_cone(track, set, flow, ticks * tick_s);
    }
  }
  FrameCone frame(double time_s, double step_s) const {
    return frame_cone(track, set, flow, glm::vec3(0.0f), static_cast<float>(step_s), time_s);
  }
};
glm::vec3 still(double) {
  return glm::vec3(0.0f);
}

double wrapped(double x) {  // to [-1/2, 1/2)
  return x - std::floor(x + 0.5);
}

TEST(DoubleCone, ScrollPhaseJumpsWhenTheOffsetIsMultipliedByLength) {
  // A minute in, the camera starts to sink by 0.065 m/s: the rain is 1% slower. Between two frames the texture should
  // move as far as always. Printed, all that was scrolled in that minute is stretched anew.
  for (const bool as_printed : {false, true}) {
    double worst = 0.0;
    for (const float sinks_mps : {0.05f, 0.065f, 0.08f}) {  // a jump by whole tiles cannot be seen
      Flight run{as_printed ? published() : DoubleCone{}};
      run.to(60.0, still);
      const FrameCone before = run.frame(60.0, 1.0 / 60.0);
      run.to(60.0 + 1.0 / 60.0, [&](double) { return glm::vec3(0.0f, -sinks_mps, 0.0f); });
      const FrameCone after = run.frame(60.0 + 1.0 / 60.0, 1.0 / 60.0);
      for (int i = 0; i < cone_layers; ++i) {
        const double frame_m = 6.5 / 60.0;
        const double moved_m =
            wrapped(after.phase[i] - before.phase[i]) * after.elongation[i] * cone_layout(false)[i].tile_m;
        worst = std::max(worst, std::abs(moved_m - frame_m) / frame_m);
      }
    }
    if (as_printed)
      EXPECT_GT(worst, 1.0);  // more than a frame's motion
    else
      EXPECT_LT(worst, 0.05);
  }
}

TEST(DoubleCone, StreaksLengthenAsFramesTakeLonger) {
  // One exposure, filmed at 144, 60, 15 and 5 frames a second.
  for (const bool as_printed : {false, true}) {
    Flight run{as_printed ? published() : DoubleCone{}};
    run.to(2.0, still);
    float shortest = 1e9f, longest = 0.0f;
    for (const double rate : {144.0, 60.0, 15.0, 5.0}) {
      const float length = run.frame(2.0, 1.0 / rate).elongation[0];
      shortest = std::min(shortest, length);
      longest = std::max(longest, length);
    }
    if (as_printed)
      EXPECT_GT(longest / shortest, 3.0f);
    else
      EXPECT_EQ(longest, shortest);
  }
}

TEST(DoubleCone, WagonWheelTurnsBackWhenFrameTimesJitter) {
  // What the eye follows is the shorter of the two ways that bring the texture into its new place (tiles look like
  // themselves only after their whole length: ConeTextures.RepeatNothingWithinATile). It must be the true one.
  for (const bool as_printed : {false, true}) {
    int wrong = 0, all = 0;
    for (const double rate : {144.0, 60.0, 15.0, 5.0}) {
      Flight run{as_printed ? published() : DoubleCone{}};
      double time_s = 30.0;
      run.to(time_s, still);
      FrameCone last = run.frame(time_s, 1.0 / rate);
      for (int i = 0; i < 40; ++i) {
        const double step_s = (1.0 + 0.1 * ((i * 7) % 5 - 2) / 2.0) / rate;  // 10% either way
        time_s += step_s;
        run.to(time_s, still);
        const FrameCone now = run.frame(time_s, step_s);
        for (int l = 0; l < cone_layers; ++l) {
          const double moved_m =
              wrapped(now.phase[l] - last.phase[l]) * now.elongation[l] * cone_layout(false)[l].tile_m;
          wrong += std::abs(moved_m - 6.5 * step_s) > 0.1 * 6.5 * step_s;
          ++all;
        }
        last = now;
      }
    }
    if (as_printed)
      EXPECT_GT(wrong, all / 4);
    else
      EXPECT_EQ(wrong, 0);
  }
}

TEST(DoubleCone, StutterFrom144To5FramesASecond) {
  // After a second at 5 frames a second the rain is where it would be without, and its streaks are as long.
  for (const bool as_printed : {false, true}) {
    Flight smooth{as_printed ? published() : DoubleCone{}}, stutters = smooth;
    smooth.to(10.0, still);
    for (double t = 0.2; t < 10.1; t += 0.2) stutters.to(t, still);
    const FrameCone a = smooth.frame(10.0, 1.0 / 144.0), b = stutters.frame(10.0, 0.2);
    double phases = 0.0;
    for (int i = 0; i < cone_layers; ++i) phases = std::max(phases, std::abs(wrapped(a.phase[i] - b.phase[i])));
    if (as_printed) {
      EXPECT_GT(phases, 0.05);
      EXPECT_GT(b.elongation[0], 2.0f * a.elongation[0]);
    } else {
      EXPECT_LT(phases, 1e-6);
      EXPECT_EQ(a.elongation, b.elongation);
    }
  }
}

TEST(DoubleCone, TeleportOf10Kilometres) {
  // Through the components: a camera that flies at 20 m/s is set 10 km away, and flies on. Read as speed that tick
  // would be 1,200 km/s: the axis would lie flat and the scroll race by 3,000 tiles.
  Registry registry;
  const Entity sky = registry.create(), eye = registry.create();
  Emitter emitter;
  emitter.rain_mm_per_hour = 20.0f;
  registry.emplace<Emitter>(sky, emitter);
  registry.emplace<DoubleCone>(sky);
  registry.emplace<Camera>(eye);
  registry.emplace<WorldTransform>(eye);
  FrameCone before, after;
  for (int tick = 0; tick <= 240; ++tick) {
    registry.get<WorldTransform>(eye).matrix[3].x += tick == 200 ? 10000.0f : 20.0f / 120.0f;
    simulate_rainfall(registry, tick * tick_s);
    track_cameras(registry);
    ASSERT_EQ(registry.get<CameraMotion>(eye).moving_known, tick > 0 && tick != 200) << tick;
    simulate_cone(registry, tick * tick_s, tick_s);
    if (tick != 199 && tick != 200) continue;
    Frame frame = stage_frame(160, 90);
    frame.camera.velocity_mps = {20.0f, 0.0f, 0.0f};
    extract_rainfall(registry, frame, tick * tick_s);
    extract_cone(registry, frame, tick * tick_s);
    (tick == 199 ? before : after) = frame.rain->cone;
  }
  EXPECT_LT(glm::length(after.axis - before.axis), 1e-3f);
  EXPECT_LT(glm::length(after.side - before.side), 1e-3f);
  for (int i = 0; i < cone_layers; ++i) {
    const double moved_m =
        wrapped(after.phase[i] - before.phase[i]) * after.elongation[i] * cone_layout(false)[i].tile_m;
    EXPECT_NEAR(moved_m, after.speed_mps * tick_s, 0.01 * after.speed_mps * tick_s) << i;
  }
}

TEST(DoubleCone, AxisPassesThroughEveryDirection) {
  // A camera that throws itself about: the frame stays orthonormal and never spins about the axis by itself.
  Flight run{};
  glm::vec3 last_side(0.0f), last_axis(0.0f);
  for (int i = 0; i < 2000; ++i) {
    const double t = i * tick_s;
    run.to(t + tick_s, [](double s) {
      return glm::vec3(9.0 * std::sin(3.0 * s), 14.0 * std::sin(2.1 * s), 9.0 * std::cos(1.7 * s));
    });
    const FrameCone cone = run.frame(run.track.time_s, 1.0 / 60.0);
    ASSERT_NEAR(glm::length(cone.axis), 1.0f, 1e-4f);
    ASSERT_NEAR(glm::length(cone.side), 1.0f, 1e-4f);
    ASSERT_NEAR(glm::dot(cone.axis, cone.side), 0.0f, 1e-4f);
    if (i > 1) ASSERT_LT(glm::length(cone.side - last_side), 1.05f * glm::length(cone.axis - last_axis) + 1e-3f) << i;
    last_side = cone.side, last_axis = cone.axis;
  }
}

class DoubleConePicture : public test::GlTest {
 protected:
  static std::unique_ptr<RainStage> stage(float wall_m, bool fog = true) {
    StageSet set;
    set.present = false;
    set.wall_cd_m2 = glm::vec3(1000.0f);
    set.wall_distance_m = wall_m;
    set.wall_hides = true;
    set.fog = fog;
    auto made = RainStage::make(context->device().software, set);
    EXPECT_TRUE(made) << (made ? "" : made.error().message);
    return made ? std::move(*made) : nullptr;
  }
};

Frame rain_frame(int width, int height, float mm_per_hour = 60.0f) {
  Frame frame = stage_frame(width, height);
  frame.sky.zenith_cd_m2 = frame.sky.horizon_cd_m2 = glm::vec3(0.0f);
  Emitter emitter;
  emitter.rain_mm_per_hour = mm_per_hour;
  frame.rain = make_frame_rain(emitter, start_rain_motion(emitter, {}), frame.camera, width, height, 4.0);
  frame.rain->techniques.set(Effect::rainfall, RainRung::double_cone);
  return frame;
}

// 1 - transmittance of each pixel.
std::vector<double> taken(RainStage& stage, Frame& frame) {
  const auto drawn = stage.draw(frame);
  EXPECT_TRUE(drawn) << (drawn ? "" : drawn.error().message);
  const auto light = stage.read_light();
  std::vector<double> out(light.size() / 4);
  for (std::size_t i = 0; i < out.size(); ++i) {
    EXPECT_TRUE(std::isfinite(light[4 * i]));
    out[i] = 1.0 - light[4 * i] / 1000.0;
  }
  return out;
}

struct Moments {
  double mean = 0.0, deviation = 0.0;
};
Moments moments(const std::vector<double>& v, auto&& chosen) {
  double sum = 0.0, squares = 0.0, n = 0.0;
  for (std::size_t i = 0; i < v.size(); ++i)
    if (chosen(i)) sum += v[i], squares += v[i] * v[i], ++n;
  return {sum / n, std::sqrt(std::max(squares / n - sum * sum / n / n, 0.0))};
}
bool everywhere(std::size_t) {
  return true;
}

TEST_F(DoubleConePicture, CameraLooksAlongTheFall) {
  // Straight up into the rain: the cone's end is in the middle of the picture. Printed, it fades there to nothing, and
  // around it streaks pinch to needles; mended, the middle is even and has the mean of fog.
  const auto s = stage(30.0f);
  constexpr int side = 160;
  for (const bool as_printed : {false, true}) {
    Frame frame = rain_frame(side, side, 100.0f);
    frame.camera.orientation = glm::angleAxis(glm::radians(90.0f), glm::vec3(1.0f, 0.0f, 0.0f));
    set_cone(*frame.rain, as_printed ? published() : DoubleCone{}, frame.camera, 1.0f / 60.0f, 4.0);
    const auto middle = [&](std::size_t i) {
      const double x = double(i % side) + 0.5 - side / 2, y = double(i / side) + 0.5 - side / 2;
      return std::hypot(x, y) < 0.5 * side * std::tan(glm::radians(14.0)) / std::tan(glm::radians(30.0));
    };
    const Moments drawn = moments(taken(*s, frame), middle);
    frame.rain->techniques.set(Effect::rainfall, RainRung::fog);
    const Moments fog = moments(taken(*s, frame), middle);
    if (as_printed) {
      EXPECT_LT(drawn.mean, 0.75 * fog.mean);
    } else {
      EXPECT_NEAR(drawn.mean, fog.mean, 0.03 * fog.mean + 6e-4);
      EXPECT_LT(drawn.deviation, 0.02 * fog.mean + 3e-4);
    }
  }
}

TEST_F(DoubleConePicture, CameraFallsWithTheRain) {
  // Nothing moves past such a camera: the picture freezes, on the last axis, whole. Printed, the scroll of eq. 3 knows
  // nothing of the camera and goes on.
  const auto s = stage(15.0f);
  for (const bool as_printed : {false, true}) {
    Flight run{as_printed ? published() : DoubleCone{}};
    run.to(2.0, still);
    const glm::vec3 axis = run.track.axis;
    const auto falling = [](double) { return glm::vec3(0.0f, -6.5f, 0.0f); };
    run.to(3.0, falling);
    Frame frame = rain_frame(160, 90);
    frame.rain->cone = run.frame(3.0, 1.0 / 60.0);
    const auto first = taken(*s, frame);
    run.to(3.5, falling);
    frame.rain->cone = run.frame(3.5, 1.0 / 60.0);
    const auto second = taken(*s, frame);
    if (as_printed) {
      EXPECT_NE(first, second);
      continue;
    }
    EXPECT_EQ(first, second);
    EXPECT_LT(glm::length(frame.rain->cone.axis - axis), 1e-5f);
    const double mean = moments(first, everywhere).mean;
    frame.rain->techniques.set(Effect::rainfall, RainRung::fog);
    const double fog = moments(taken(*s, frame), everywhere).mean;
    EXPECT_NEAR(mean, fog, 0.05 * fog + 6e-4);
  }
}

// Lean of the streaks against the vertical, radians, by the structure tensor: the direction in which the picture
// changes least. Positive: upper ends to the right.
double lean_of(const std::vector<double>& v, int width, int height) {
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (int y = 1; y + 1 < height; ++y)
    for (int x = 1; x + 1 < width; ++x) {
      const auto at = [&](int i, int j) { return v[std::size_t(j) * width + i]; };
      // Scharr's derivatives, which are least dependent on direction.
      const double dx = 3.0 * (at(x + 1, y + 1) + at(x + 1, y - 1) - at(x - 1, y + 1) - at(x - 1, y - 1)) +
                        10.0 * (at(x + 1, y) - at(x - 1, y));
      const double dy = 3.0 * (at(x + 1, y + 1) + at(x - 1, y + 1) - at(x + 1, y - 1) - at(x - 1, y - 1)) +
                        10.0 * (at(x, y + 1) - at(x, y - 1));
      xx += dx * dx, xy += dx * dy, yy += dy * dy;
    }
  const double gradient = 0.5 * std::atan2(2.0 * xy, xx - yy);  // of the steepest change
  return std::atan(-std::tan(gradient));
}

TEST_F(DoubleConePicture, FastYaw) {
  // The camera turns to the left by 90 degrees a second: while the shutter is open everything runs to the right on the
  // picture by w T, and a drop falls by |U| T / r. Before a wall just behind the nearest layer its radius is what
  // counts.
  const auto s = stage(1.7f);
  constexpr int width = 400, height = 200;
  const auto radius = static_cast<float>(cone_layout(false)[0].radius_m);
  for (const float yaw : {0.0f, 1.5708f, -1.5708f}) {
    for (const bool as_printed : {false, true}) {
      Frame frame = rain_frame(width, height, 60.0f);
      frame.camera.vertical_fov_rad = 0.6f;
      frame.camera.angular_velocity_radps = {0.0f, yaw, 0.0f};
      set_cone(*frame.rain, as_printed ? published() : DoubleCone{}, frame.camera, 1.0f / 60.0f, 4.0);
      // Falling and running to the right: the upper end is on the left.
      const double truth = std::atan(-yaw * radius / frame.rain->cone.speed_mps);
      const double lean = lean_of(taken(*s, frame), width, height);
      if (as_printed && yaw != 0.0f)
        EXPECT_GT(std::abs(lean - truth), 0.15);  // upright, whatever the camera does
      else
        EXPECT_NEAR(lean, truth, 0.06) << yaw;
    }
  }
}

TEST_F(DoubleConePicture, OccluderAt1Metre) {
  // Rain between the eye and the wall is all that may be seen: 0.7 m away that is even and almost nothing; 1 m away
  // a quarter of the nearest layer. Printed, all four layers are drawn over whatever stands there.
  for (const float wall_m : {0.7f, 1.0f}) {
    const auto s = stage(wall_m);
    for (const bool as_printed : {false, true}) {
      Frame frame = rain_frame(160, 90, 100.0f);
      frame.camera.vertical_fov_rad = 0.3f;
      set_cone(*frame.rain, as_printed ? published() : DoubleCone{}, frame.camera, 1.0f / 60.0f, 4.0);
      const Moments drawn = moments(taken(*s, frame), everywhere);
      const double truth = 1.0 - std::exp(-frame.rain->drawn_extinction_per_m * wall_m);
      if (as_printed) {
        EXPECT_GT(drawn.mean, 8.0 * truth);
      } else {
        // Half floats, by 2^-11 of the wall, cut off twice.
        EXPECT_NEAR(drawn.mean, truth, 0.1 * truth + 1.1e-3) << wall_m;
        if (wall_m < cone_edges_m[0]) EXPECT_LT(drawn.deviation, 3e-4);
      }
    }
  }
}

}  // namespace
}  // namespace petrichor
