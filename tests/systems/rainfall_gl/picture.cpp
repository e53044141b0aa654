// The drop field as it is drawn: the invariants of rain (shared physics, sections 1d and 2), and where it could break.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "systems/rainfall/extract.hpp"
#include "systems/rainfall/passes.hpp"
#include "systems/rainfall/stage.hpp"
#include "tests/engine/platform/gl_test.hpp"

namespace petrichor {
namespace {

class RainPicture : public test::GlTest {
 protected:
  static std::unique_ptr<RainStage> stage(const StageSet& set) {
    auto made = RainStage::make(context->device().software, set);
    EXPECT_TRUE(made) << (made ? "" : made.error().message);
    return made ? std::move(*made) : nullptr;
  }
};

constexpr int width = 240, height = 136;

// A white wall, drops that shine with nothing: the picture is the transmittance.
StageSet white_wall(float distance_m, int path = 0) {
  StageSet set;
  set.present = false;
  set.wall_cd_m2 = glm::vec3(1.0f);
  set.wall_distance_m = distance_m;
  set.wall_hides = true;
  set.path = path;
  return set;
}

Frame dark_frame(float fov_deg, float exposure_s) {
  Frame frame = stage_frame(width, height, glm::dvec3(3.0, 1.7, -8.0));
  frame.camera.vertical_fov_rad = glm::radians(fov_deg);
  frame.camera.exposure_s = exposure_s;
  frame.sky.zenith_cd_m2 = frame.sky.horizon_cd_m2 = glm::vec3(0.0f);
  return frame;
}

struct Seen {
  double mean = 0.0, deviation = 0.0;
};

Seen look(RainStage& stage, const Emitter& emitter, float fov_deg, float exposure_s, int frames,
          float distance_m = 0.0f, float speed_mps = 0.0f) {
  const WindMotion motion = start_rain_motion(emitter, {});
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (int i = 0; i < frames; ++i) {
    Frame frame = dark_frame(fov_deg, exposure_s);
    frame.time_s = 11.0 + 0.7 * i;
    frame.number = std::uint64_t(i);
    frame.camera.velocity_mps = {speed_mps, 0.0f, 0.0f};
    frame.rain = make_frame_rain(emitter, motion, frame.camera, width, height, frame.time_s);
    if (distance_m > 0.0f) {  // every drop to there, and none fades before
      frame.rain->fade_start_m = distance_m;
      frame.rain->drawn_distance_m = distance_m * 1.001f;
    }
    const auto drawn = stage.draw(frame);
    EXPECT_TRUE(drawn) << (drawn ? "" : drawn.error().message);
    const std::vector<float> light = stage.read_light();
    for (std::size_t p = 0; p < light.size(); p += 4) {
      EXPECT_TRUE(light[p] >= 0.0f && light[p] <= 1.001f);
      sum += light[p];
      squares += double(light[p]) * light[p];
      count += 1.0;
    }
  }
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean))};
}

// Mean over the picture of exp(-extinction * length of the ray to the wall).
double expected_transmittance(double extinction, double wall_m, double fov_deg) {
  const double tall = std::tan(0.5 * fov_deg * M_PI / 180.0);
  double sum = 0.0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double u = ((x + 0.5) / width * 2.0 - 1.0) * tall * width / height,
                   v = ((y + 0.5) / height * 2.0 - 1.0) * tall;
      sum += std::exp(-extinction * wall_m * std::sqrt(1.0 + u * u + v * v));
    }
  return sum / (width * height);
}

double extinction_of(const Emitter& emitter) {
  return make_frame_rain(emitter, start_rain_motion(emitter, {}), FrameCamera{}, width, height, 0.0).extinction_per_m;
}

TEST_F(RainPicture, MeanTransmittanceIsTheSameAtAnyExposure) {
  Emitter emitter;
  emitter.rain_mm_per_hour = 50.0f;
  const double truth = expected_transmittance(extinction_of(emitter), 12.0, 50.0);
  for (const int path : {1, 2}) {
    auto s = stage(white_wall(12.0f, path));
    for (const float exposure : {1.0f / 30, 1.0f / 60, 1.0f / 250}) {
      const Seen seen = look(*s, emitter, 50.0f, exposure, 4, 15.0f);
      // 0.5% of the background is asked for; the rain takes 2.5% of it, and the sum over some 4 x 200,000 drops of
      // very unequal area is known to about 2% of that.
      EXPECT_NEAR(1.0 - seen.mean, 1.0 - truth, 0.05 * (1.0 - truth)) << "exposure " << exposure << " path " << path;
    }
  }
}

TEST_F(RainPicture, MeanTransmittanceIsTheSameForAMovingCamera) {
  Emitter emitter;
  emitter.rain_mm_per_hour = 50.0f;
  auto s = stage(white_wall(12.0f));
  const double truth = expected_transmittance(extinction_of(emitter), 12.0, 50.0);
  const Seen seen = look(*s, emitter, 50.0f, 1.0f / 60, 4, 15.0f, 15.0f);
  EXPECT_NEAR(1.0 - seen.mean, 1.0 - truth, 0.05 * (1.0 - truth));
}

TEST_F(RainPicture, VarianceFallsAsOneOverExposure) {
  // Garg and Nayar: standard deviation proportional to exposure^-1/2, where streaks are longer than a pixel.
  Emitter emitter;
  emitter.rain_mm_per_hour = 20.0f;
  emitter.minimum_diameter_mm = 1.0f;
  auto s = stage(white_wall(4.0f));
  const Seen slow = look(*s, emitter, 25.0f, 1.0f / 15, 10, 5.0f), fast = look(*s, emitter, 25.0f, 1.0f / 60, 10, 5.0f);
  EXPECT_NEAR(fast.deviation / slow.deviation, 2.0, 0.3);
}

TEST_F(RainPicture, FogAndFieldHaveTheSameMean) {
  for (const float rate : {5.0f, 50.0f}) {
    Emitter emitter;
    emitter.rain_mm_per_hour = rate;
    auto s = stage(white_wall(16.0f));
    const double truth = expected_transmittance(extinction_of(emitter), 16.0, 40.0);
    for (const float distance : {0.0f, 3.0f, 8.0f, 20.0f, 30.0f}) {
      Emitter e = emitter;
      e.drawn_distance_m = distance;
      e.maximum_drops =
          400000000;  // no budget: all classes reach equally far; BudgetShrinksTheField has the other case
      const Seen seen = look(*s, e, 40.0f, 1.0f / 60, 3);
      EXPECT_NEAR(seen.mean, truth, 0.005) << rate << " mm/h, drawn to " << distance << " m";
      EXPECT_NEAR(seen.mean, truth, 0.08 * (1.0 - truth)) << rate << " mm/h, drawn to " << distance << " m";
    }
  }
}

TEST_F(RainPicture, BudgetShrinksTheFieldAndNotTheMean) {
  Emitter emitter;
  emitter.rain_mm_per_hour = 50.0f;
  auto s = stage(white_wall(16.0f));
  const double truth = expected_transmittance(extinction_of(emitter), 16.0, 40.0);
  for (const int budget : {1000, 30000}) {
    emitter.maximum_drops = budget;
    const Seen seen = look(*s, emitter, 40.0f, 1.0f / 60, 4);
    EXPECT_NEAR(seen.mean, truth, 0.005) << budget;
  }
}

TEST_F(RainPicture, DrawsAsManyDropsAsExpected) {
  Emitter emitter;
  emitter.rain_mm_per_hour = 20.0f;
  emitter.maximum_drops = 50000;
  for (const int path : {1, 2}) {
    StageSet set;
    set.path = path;
    auto s = stage(set);
    Frame frame = dark_frame(60.0f, 0.0f);  // no exposure: no drop is cut by the picture's edge but by its size
    frame.rain = make_frame_rain(emitter, start_rain_motion(emitter, {}), frame.camera, width, height, 4.0);
    ASSERT_TRUE(s->draw(frame));
    EXPECT_NEAR(rain_stats(frame).drops_drawn, 50000.0, 5.0 * std::sqrt(50000.0) + 300.0) << path;
  }
}

TEST_F(RainPicture, SameFrameSameBytes) {
  Emitter emitter;
  emitter.rain_mm_per_hour = 40.0f;
  emitter.maximum_drops = 60000;
  const WindMotion motion = start_rain_motion(emitter, {});
  const auto draw = [&](RainStage& s, double time_s) {
    Frame frame = stage_frame(width, height);
    FrameLight lamp{};
    lamp.position_m = {0.5f, 1.0f, -5.0f};
    lamp.direction = {0.0f, -1.0f, 0.0f};
    lamp.intensity = glm::vec3(500.0f);
    lamp.source_radius_m = 0.1f;
    lamp.kind = LIGHT_POINT;
    lamp.lights_rain = true;
    frame.lights.push_back(lamp);
    frame.time_s = time_s;
    frame.rain = make_frame_rain(emitter, motion, frame.camera, width, height, time_s);
    EXPECT_TRUE(s.draw(frame));
    return s.read_picture();
  };
  for (const int path : {1, 2}) {
    StageSet set;
    set.path = path;
    auto a = stage(set), b = stage(set);
    // One stage went through other times and places first: a jump leaves nothing behind.
    draw(*a, 3.0);
    draw(*a, 900.0);
    const auto jumped = draw(*a, 15.0), fresh = draw(*b, 15.0);
    EXPECT_EQ(jumped, fresh) << path;
    EXPECT_NE(draw(*b, 15.5), fresh);
  }
}

TEST_F(RainPicture, BothPathsDrawTheSameRain) {
  // The same drops: their pictures agree far better than pictures of different rains do.
  Emitter emitter;
  emitter.rain_mm_per_hour = 20.0f;
  emitter.maximum_drops = 30000;
  const auto draw = [&](int path, double time_s) {
    auto s = stage(white_wall(9.0f, path));
    Frame frame = dark_frame(40.0f, 1.0f / 60);
    frame.rain = make_frame_rain(emitter, start_rain_motion(emitter, {}), frame.camera, width, height, time_s);
    EXPECT_TRUE(s->draw(frame));
    return s->read_light();
  };
  const auto a = draw(1, 5.0), b = draw(2, 5.0), other = draw(1, 8.0);
  double same = 0.0, different = 0.0;
  for (std::size_t i = 0; i < a.size(); i += 4) {
    same += (a[i] - b[i]) * (a[i] - b[i]);
    different += (a[i] - other[i]) * (a[i] - other[i]);
  }
  // What is left is the rounding by chance, which the paths do with other numbers.
  EXPECT_LT(same, 0.3 * different);
}

TEST_F(RainPicture, NoRainUnderARoof) {
  for (const int path : {1, 2}) {
    StageSet set = white_wall(12.0f, path);
    set.map = true;
    set.roof_m = 6.0f;  // over all places left of the camera, above what it sees
    auto s = stage(set);
    Emitter emitter;
    emitter.rain_mm_per_hour = 80.0f;
    emitter.maximum_drops = 300000;
    Frame frame = dark_frame(40.0f, 1.0f / 60);
    frame.rain = make_frame_rain(emitter, start_rain_motion(emitter, {}), frame.camera, width, height, 5.0);
    ASSERT_TRUE(s->draw(frame));
    const auto light = s->read_light();
    int dry_differing = 0, wet_differing = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        if (std::abs(x - width / 2) < 12 || x == width - 1) continue;  // a near drop in the open reaches over
        // Without drops the picture is smooth: neighbours differ by the fog's slope and the rounding of 16 bits.
        const float* p = &light[4 * (std::size_t(y) * width + x)];
        (x < width / 2 ? dry_differing : wet_differing) += std::abs(p[0] - p[4]) > 2e-3f;
      }
    EXPECT_EQ(dry_differing, 0) << path;
    EXPECT_GT(wet_differing, 2000) << path;
  }
}

TEST_F(RainPicture, NoRainNoPass) {
  auto s = stage(white_wall(12.0f));
  Frame frame = dark_frame(40.0f, 1.0f / 60);
  Emitter emitter;
  emitter.rain_mm_per_hour = 20.0f;
  emitter.maximum_drops = 10000;
  frame.rain = make_frame_rain(emitter, start_rain_motion(emitter, {}), frame.camera, width, height, 5.0);
  ASSERT_TRUE(s->draw(frame));
  EXPECT_GT(rain_stats(frame).drops_drawn, 0u);
  frame.rain.reset();
  frame.number = 1;
  ASSERT_TRUE(s->draw(frame));
  EXPECT_EQ(rain_stats(frame).drops_drawn, 0u);
  for (const PassReport& pass : s->report()) EXPECT_TRUE(pass.culled || !pass.name.starts_with("rain_")) << pass.name;
  for (const float v : s->read_light()) EXPECT_EQ(v, 1.0f);
}

TEST_F(RainPicture, LampsMakeNoHoles) {
  // A strong lamp amid a downpour, stared at: bright drops may only brighten the dark behind them.
  for (const int path : {1, 2}) {
    StageSet set;
    set.present = false;
    set.path = path;
    auto s = stage(set);
    Emitter emitter;
    emitter.rain_mm_per_hour = 200.0f;
    emitter.maximum_drops = 300000;
    Frame frame = dark_frame(40.0f, 1.0f / 30);
    frame.camera.exposure_ev100 = -4.0f;
    FrameLight lamp{};
    lamp.position_m = glm::vec3(frame.camera.position_m) + glm::vec3(0.0f, 0.0f, -3.0f);
    lamp.direction = {0.0f, -1.0f, 0.0f};
    lamp.intensity = glm::vec3(1e6f);
    lamp.source_radius_m = 0.02f;
    lamp.kind = LIGHT_POINT;
    lamp.lights_rain = true;
    frame.lights.push_back(lamp);
    frame.rain = make_frame_rain(emitter, start_rain_motion(emitter, {}), frame.camera, width, height, 5.0);
    ASSERT_TRUE(s->draw(frame));
    const auto light = s->read_light();
    // Within 12 pixels of the lamp: no pixel far darker than the median there.
    std::vector<float> near;
    for (int y = height / 2 - 12; y < height / 2 + 12; ++y)
      for (int x = width / 2 - 12; x < width / 2 + 12; ++x) {
        const float v = light[4 * (std::size_t(y) * width + x)];
        EXPECT_TRUE(std::isfinite(v));
        near.push_back(v);
      }
    std::sort(near.begin(), near.end());
    EXPECT_GT(near[near.size() / 2], 0.0f);
    EXPECT_GT(near[near.size() / 100], 0.02f * near[near.size() / 2]) << path;
  }
}

}  // namespace
}  // namespace petrichor
