// Where falling rain could break: each test provokes one failure.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "systems/rainfall/extract.hpp"
#include "systems/rainfall/passes.hpp"
#include "systems/drops/rain_shared.h"
#include "systems/rainfall/stage.hpp"
#include "tests/engine/platform/gl_test.hpp"

namespace petrichor {
namespace {

class RainStability : public test::GlTest {
 protected:
  // A white wall and drops that shine with nothing: the picture is the transmittance.
  static std::unique_ptr<RainStage> stage(float wall_m, int path, float wall_cd_m2 = 1.0f) {
    StageSet set;
    set.present = false;
    set.wall_cd_m2 = glm::vec3(wall_cd_m2);
    set.wall_distance_m = wall_m;
    set.wall_hides = true;
    set.path = path;
    auto made = RainStage::make(context->device().software, set);
    EXPECT_TRUE(made) << (made ? "" : made.error().message);
    return made ? std::move(*made) : nullptr;
  }
};

struct View {
  int width = 240, height = 136;
  float fov_deg = 40.0f;
  glm::dvec3 camera_m{3.0, 1.7, -8.0};
};

Frame frame_of(const View& view, double time_s) {
  Frame frame = stage_frame(view.width, view.height, view.camera_m);
  frame.camera.vertical_fov_rad = glm::radians(view.fov_deg);
  frame.camera.exposure_s = 1.0f / 60;
  frame.sky.zenith_cd_m2 = frame.sky.horizon_cd_m2 = glm::vec3(0.0f);
  frame.time_s = time_s;
  return frame;
}

// Every drop to `drawn_m`.
void rain_on(Frame& frame, const Emitter& emitter, float drawn_m) {
  frame.rain =
      make_frame_rain(emitter, start_rain_motion(emitter, {}), frame.camera, frame.width, frame.height, frame.time_s);
  frame.rain->fade_start_m = drawn_m;
  frame.rain->drawn_distance_m = drawn_m * 1.001f;
}

Emitter rain_of(float mm_per_hour) {
  Emitter emitter;
  emitter.rain_mm_per_hour = mm_per_hour;
  emitter.maximum_drops = 100'000'000;  // no budget: every class reaches as far as the others
  return emitter;
}

std::vector<float> light_of(RainStage& stage, Frame& frame) {
  const auto drawn = stage.draw(frame);
  EXPECT_TRUE(drawn) << (drawn ? "" : drawn.error().message);
  return stage.read_light();
}

double mean_of(const std::vector<float>& light) {
  double sum = 0.0;
  for (std::size_t p = 0; p < light.size(); p += 4) sum += light[p];
  return sum / (static_cast<double>(light.size()) / 4.0);
}

// Mean over the picture of exp(-extinction * length of the ray to the wall).
double expected_transmittance(double extinction, double wall_m, const View& view) {
  const double tall = std::tan(0.5 * view.fov_deg * M_PI / 180.0);
  double sum = 0.0;
  constexpr int n = 64;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const double u = ((x + 0.5) / n * 2.0 - 1.0) * tall * view.width / view.height,
                   v = ((y + 0.5) / n * 2.0 - 1.0) * tall;
      sum += std::exp(-extinction * wall_m * std::sqrt(1.0 + u * u + v * v));
    }
  return sum / (n * n);
}

TEST_F(RainStability, RateOf200MillimetresPerHour) {
  // Fails if lists or cells overflow (drops are lost) or a sum wraps (pixels turn clear, or lighter than the wall).
  Emitter emitter = rain_of(200.0f);
  emitter.minimum_diameter_mm = 1.5f;
  const View view{.fov_deg = 15.0f};
  for (const int path : {1, 2}) {
    const auto s = stage(60.0f, path);
    Frame frame = frame_of(view, 11.0);
    rain_on(frame, emitter, 62.0f);
    const auto light = light_of(*s, frame);
    for (const float v : light) ASSERT_TRUE(v >= 0.0f && v <= 1.001f) << v;
    const double truth = expected_transmittance(frame.rain->extinction_per_m, 60.0, view);
    EXPECT_NEAR(1.0 - mean_of(light), 1.0 - truth, 0.03 * (1.0 - truth)) << path;
  }
}

TEST_F(RainStability, TeleportOf10Kilometres) {
  // Fails if anything of the frame before is kept: a history, cells of the old place, sums not cleared, or a streak
  // drawn from the old place to the new.
  const Emitter emitter = rain_of(30.0f);
  for (const int path : {1, 2}) {
    const auto jumping = stage(8.0f, path), fresh = stage(8.0f, path);
    const auto draw = [&](RainStage& s, const glm::dvec3& camera_m, double time_s, std::uint64_t number) {
      Frame frame = frame_of({.camera_m = camera_m}, time_s);
      frame.number = number;
      rain_on(frame, emitter, 9.0f);
      return light_of(s, frame);
    };
    const glm::dvec3 here{3.0, 1.7, -8.0}, there{10003.0, 1.7, -8.0};
    const auto before = draw(*jumping, here, 5.0, 0);
    const auto after = draw(*jumping, there, 5.0 + 1.0 / 60, 1);
    EXPECT_EQ(after, draw(*fresh, there, 5.0 + 1.0 / 60, 7)) << path;
    EXPECT_NE(after, before);
    EXPECT_EQ(draw(*jumping, here, 5.0, 2), before) << path;  // and back
  }
}

TEST_F(RainStability, A100KilometresFromTheOrigin) {
  // Fails if places are in single precision, where 100 km has steps of 8 mm: streaks would be cut short, doubled or
  // stand still. The mean is the same there, and between two frames the picture changes as much as at the origin.
  const Emitter emitter = rain_of(50.0f);
  const auto s = stage(8.0f, 0);
  double change[2] = {};
  for (const bool far : {false, true}) {
    double sum = 0.0, truth = 0.0;
    std::vector<float> last;
    for (int i = 0; i < 3; ++i) {
      const View view{.camera_m = far ? glm::dvec3(1e5, 1.7, 1e5 + 30.0) : glm::dvec3(0.0, 1.7, 30.0)};
      Frame frame = frame_of(view, 86400.0 + i * 1e-3);  // a thousandth: drops move by 2 to 9 mm
      rain_on(frame, emitter, 9.0f);
      truth = expected_transmittance(frame.rain->extinction_per_m, 8.0, view);
      const auto light = light_of(*s, frame);
      sum += mean_of(light) / 3.0;
      for (std::size_t p = 0; !last.empty() && p < light.size(); p += 4) change[far] += std::abs(light[p] - last[p]);
      last = light;
    }
    EXPECT_NEAR(1.0 - sum, 1.0 - truth, 0.08 * (1.0 - truth)) << far;
  }
  EXPECT_NEAR(change[1] / change[0], 1.0, 0.15);
}

TEST_F(RainStability, Stutter) {
  // Fails if the rain integrates steps: half a second without a tick, amid a change of the wind, would leave the drops
  // elsewhere than 30 ticks do, or fling light drops about (their time constant is 0.1 s).
  FrameRain rain[2];
  for (const bool stutters : {false, true}) {
    Registry registry;
    const Entity entity = registry.create();
    registry.emplace<Emitter>(entity, rain_of(20.0f));
    registry.emplace<Wind>(entity);
    for (int tick = 0; tick <= 120; ++tick) {
      if (tick == 60) registry.find<Wind>(entity)->velocity_mps = {8.0f, 0.0f, -3.0f};
      if (stutters && tick > 60 && tick < 90) continue;
      simulate_rainfall(registry, tick / 60.0);
    }
    Frame frame = frame_of({}, 2.0);
    extract_rainfall(registry, frame, 2.0);
    ASSERT_TRUE(frame.rain);
    rain[stutters] = *frame.rain;
  }
  for (std::size_t k = 0; k < rain[0].classes.size(); ++k) {
    const RainClass &a = rain[0].classes[k], &b = rain[1].classes[k];
    EXPECT_LT(glm::length(a.origin_m - b.origin_m), 1e-6) << k;
    EXPECT_LT(glm::length(a.velocity_mps - b.velocity_mps), 1e-5f) << k;
    EXPECT_LE(glm::length(glm::vec2(b.velocity_mps.x, b.velocity_mps.z)), std::hypot(8.0f, 3.0f) + 1e-4f) << k;
  }
}

TEST_F(RainStability, HundredThousandDropsInAPixel) {
  // Fails if the sums wrap or lose what is far below their unit: four pixels take some 150,000 drops each, every one
  // a ten-thousandth of a unit, and all as bright as a drop may be.
  const View view{.width = 2, .height = 2, .fov_deg = 15.0f};
  const Emitter emitter = rain_of(200.0f);
  for (const int path : {1, 2}) {
    const auto clear = stage(20.0f, path);
    double taken = 0.0, truth = 0.0;
    constexpr int frames = 4;
    for (int i = 0; i < frames; ++i) {
      Frame frame = frame_of(view, 11.0 + i);
      rain_on(frame, emitter, 22.0f);
      taken += (1.0 - mean_of(light_of(*clear, frame))) / frames;
      truth = 1.0 - expected_transmittance(frame.rain->extinction_per_m, 20.0, view);
      EXPECT_GT(rain_stats(frame).drops_drawn, 4u * 100'000u);
    }
    // 16 sums of some 600 units by chance: 1%; nearest drops, a few of which make a tenth of it: 2%.
    EXPECT_NEAR(taken, truth, 0.06 * truth) << path;

    StageSet dark;
    dark.present = false;
    dark.path = path;
    auto lit = RainStage::make(context->device().software, dark);
    ASSERT_TRUE(lit);
    Frame frame = frame_of(view, 11.0);
    FrameLight sun{};
    sun.direction = {0.0f, 0.0f, 1.0f};
    sun.intensity = glm::vec3(1e12f);
    sun.kind = LIGHT_DIRECTIONAL;
    sun.lights_rain = true;
    frame.lights.push_back(sun);
    rain_on(frame, emitter, 22.0f);
    const auto light = light_of(**lit, frame);
    // Radiance times opacity, of the drops alone.
    const double most = 16384.0 / frame.uniforms.lens.w;
    const double opacity = 1.0 - expected_transmittance(frame.rain->drawn_extinction_per_m, 22.0, view);
    EXPECT_NEAR(mean_of(light), most * opacity, 0.06 * most * opacity) << path;
  }
}

TEST_F(RainStability, TenMillionDropsInOnePixel) {
  // Fails if the 16-bit sum of optical depths wraps, or loses drops of some 1e-5 units: one pixel takes them all.
  const View view{.width = 1, .height = 1, .fov_deg = 60.0f};
  const Emitter emitter = rain_of(200.0f);
  const float wall_m = 22.0f;
  const auto clear = stage(wall_m, 0);
  Frame frame = frame_of(view, 11.0);
  rain_on(frame, emitter, wall_m);
  const double transmittance = mean_of(light_of(*clear, frame));
  EXPECT_GT(rain_stats(frame).drops_drawn, 10'000'000u);
  const double truth = expected_transmittance(frame.rain->extinction_per_m, wall_m, view);
  // One sum of some units by chance: four deviations of the Poisson count of units.
  const double units = -std::log(truth) * RAIN_DEPTH_ONE;
  EXPECT_NEAR(transmittance, truth, 4.0 * std::sqrt(units) / RAIN_DEPTH_ONE + 0.002);
  // The headroom is the physics': the heaviest rain through the longest way that can be asked for.
  const Emitter most = rain_of(300.0f);
  rain_on(frame, most, 500.0f);
  EXPECT_LT(frame.rain->drawn_extinction_per_m * 500.0 * RAIN_DEPTH_ONE, 0.5 * 65535.0);
}

TEST_F(RainStability, RateStepsFrom0To200MillimetresPerHour) {
  // Fails if drops jump when the rate does: those of the weaker rain must all still be there, at their places, in the
  // stronger one; so light that they block stays blocked.
  const View view;
  const auto clear = stage(12.0f, 0);
  std::vector<float> before;
  for (const float rate : {0.5f, 5.0f, 50.0f, 200.0f}) {
    Frame frame = frame_of(view, 7.0);
    rain_on(frame, rain_of(rate), 12.0f);
    const std::vector<float> light = light_of(*clear, frame);
    if (!before.empty()) {
      // A drop's units are its own whatever else falls, so sums only grow: brighter is only the rounding to half floats.
      int brighter = 0, darkened = 0;
      for (std::size_t p = 0; p < light.size(); p += 4) {
        if (before[p] > 0.998f) continue;  // a streak stands here
        ++darkened;
        brighter += light[p] > before[p] + 0.0006f;
      }
      ASSERT_GT(darkened, 20) << rate;
      EXPECT_EQ(brighter, 0) << rate << ": " << darkened;
    }
    before = light;
  }
  Frame dry = frame_of(view, 7.0);
  rain_on(dry, rain_of(0.0f), 12.0f);
  EXPECT_NEAR(mean_of(light_of(*clear, dry)), 1.0, 1e-3);
}

}  // namespace
}  // namespace petrichor
