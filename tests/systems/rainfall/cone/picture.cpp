// The cone's picture: the same mean as fog alone, the same bytes every time, nothing where it is dry.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "systems/rainfall/cone/cone.hpp"
#include "systems/rainfall/extract.hpp"
#include "systems/rainfall/snow/extract.hpp"
#include "systems/rainfall/stage.hpp"
#include "tests/engine/platform/gl_test.hpp"

namespace petrichor {
namespace {

class ConePicture : public test::GlTest {
 protected:
  // A white wall before drops that shine with nothing: the picture is the transmittance.
  static StageSet wall(float wall_m) {
    StageSet set;
    set.present = false;
    set.wall_cd_m2 = glm::vec3(1.0f);
    set.wall_distance_m = wall_m;
    set.wall_hides = true;
    return set;
  }
  static std::unique_ptr<RainStage> stage(const StageSet& set) {
    auto made = RainStage::make(context->device().software, set);
    EXPECT_TRUE(made) << (made ? "" : made.error().message);
    return made ? std::move(*made) : nullptr;
  }
};

Frame rain_frame(float mm_per_hour, float exposure_s, double time_s, const DoubleCone& set = {}, int width = 160,
                 int height = 90) {
  Frame frame = stage_frame(width, height, {3.0, 1.7, -8.0});
  frame.camera.exposure_s = exposure_s;
  frame.sky.zenith_cd_m2 = frame.sky.horizon_cd_m2 = glm::vec3(0.0f);
  frame.time_s = time_s;
  Emitter emitter;
  emitter.rain_mm_per_hour = mm_per_hour;
  frame.rain = make_frame_rain(emitter, start_rain_motion(emitter, {}), frame.camera, width, height, time_s);
  frame.rain->techniques.set(Effect::rainfall, RainRung::double_cone);
  set_cone(*frame.rain, set, frame.camera, 1.0f / 60.0f, time_s);
  return frame;
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

double deviation_of(const std::vector<float>& light) {
  const double mean = mean_of(light);
  double sum = 0.0;
  for (std::size_t p = 0; p < light.size(); p += 4) sum += (light[p] - mean) * (light[p] - mean);
  return std::sqrt(sum / (static_cast<double>(light.size()) / 4.0));
}

TEST_F(ConePicture, HasTheMeanOfFogAtEveryWall) {
  for (const float wall_m : {2.0f, 5.0f, 10.0f, 20.0f, 60.0f}) {
    const auto s = stage(wall(wall_m));
    for (const float rate : {1.0f, 10.0f, 100.0f}) {
      for (const float exposure_s : {1.0f / 30.0f, 1.0f / 250.0f}) {
        constexpr int moments = 4;
        double cone = 0.0, fog = 0.0;
        for (int i = 0; i < moments; ++i) {
          Frame frame = rain_frame(rate, exposure_s, 3.0 + 0.7 * i);
          cone += mean_of(light_of(*s, frame)) / moments;
          frame.rain->techniques.set(Effect::rainfall, RainRung::fog);
          if (i == 0) fog = mean_of(light_of(*s, frame));
        }
        EXPECT_NEAR(cone, fog, 0.005) << wall_m << " " << rate;
        // And of what the rain takes away: within what a few hundred near streaks deviate by chance, and the half
        // floats of the picture, which software OpenGL cuts off: 2^-11.
        EXPECT_NEAR(1.0 - cone, 1.0 - fog, 0.08 * (1.0 - fog) + 6e-4) << wall_m << " " << rate << " " << exposure_s;
      }
    }
  }
}

TEST_F(ConePicture, ShowsStreaksThatDeviateAsRainDoes) {
  // A quarter of the exposure, up to twice the deviation, at the same mean.
  const auto s = stage(wall(20.0f));
  Frame a = rain_frame(20.0f, 1.0f / 60.0f, 4.0, {}, 480, 270), b = rain_frame(20.0f, 1.0f / 240.0f, 4.0, {}, 480, 270);
  const double longer = deviation_of(light_of(*s, a)), shorter = deviation_of(light_of(*s, b));
  EXPECT_GT(longer, 5e-4);
  EXPECT_GT(shorter / longer, 1.4);
  EXPECT_LT(shorter / longer, 2.8);
}

TEST_F(ConePicture, IsTheSameEveryTime) {
  const auto one = stage(wall(20.0f)), other = stage(wall(20.0f));
  Frame a = rain_frame(20.0f, 1.0f / 60.0f, 5.0), b = rain_frame(20.0f, 1.0f / 60.0f, 5.5);
  const auto first = light_of(*one, a), later = light_of(*one, b);
  EXPECT_NE(first, later);
  EXPECT_EQ(first, light_of(*one, a));
  EXPECT_EQ(first, light_of(*other, a));
}

TEST_F(ConePicture, SharesTheRainWithFogAndField) {
  const auto s = stage(wall(12.0f));
  for (const RainRung other : {RainRung::fog, RainRung::drop_field}) {
    double half = 0.0, fog = 0.0;
    for (int i = 0; i < 3; ++i) {
      Frame frame = rain_frame(40.0f, 1.0f / 60.0f, 3.0 + i);
      frame.rain->techniques[Effect::rainfall] = {static_cast<std::uint8_t>(RainRung::double_cone),
                                                  static_cast<std::uint8_t>(other), 0.5f};
      half += mean_of(light_of(*s, frame)) / 3.0;
      frame.rain->techniques.set(Effect::rainfall, RainRung::fog);
      if (i == 0) fog = mean_of(light_of(*s, frame));
    }
    EXPECT_NEAR(1.0 - half, 1.0 - fog, 0.1 * (1.0 - fog)) << int(other);
  }
}

TEST_F(ConePicture, CatchesTheLightOfLamps) {
  // Before black, beside fog whose airlight is integrated by 48 steps a lamp.
  StageSet set = wall(25.0f);
  set.wall_cd_m2 = glm::vec3(0.0f);
  const auto s = stage(set);
  Frame frame = rain_frame(30.0f, 1.0f / 60.0f, 6.0);
  for (const glm::vec3 at : {glm::vec3(1.0f, 3.0f, -14.0f), glm::vec3(5.0f, 2.5f, -20.0f)}) {
    FrameLight light{};
    light.position_m = at;
    light.direction = {0.0f, -1.0f, 0.0f};
    light.intensity = glm::vec3(300.0f);
    light.source_radius_m = 0.1f;
    light.kind = LIGHT_POINT;
    light.lights_rain = true;
    frame.lights.push_back(light);
  }
  const auto cone = light_of(*s, frame);
  set_cone(*frame.rain, {}, frame.camera, 1.0f / 60.0f, 6.4);
  const auto later = light_of(*s, frame);
  double change = 0.0;
  for (std::size_t p = 0; p < cone.size(); p += 4) change += std::abs(cone[p] - later[p]) / (double(cone.size()) / 4.0);
  frame.rain->techniques.set(Effect::rainfall, RainRung::fog);
  const auto fog = light_of(*s, frame);
  EXPECT_GT(mean_of(fog), 0.0);
  EXPECT_NEAR(mean_of(cone) / mean_of(fog), 1.0, 0.15);
  EXPECT_GT(change, 0.1 * mean_of(cone));  // streaks, not a glow
}

TEST_F(ConePicture, IsDryUnderARoof) {
  // A roof 3 m above all that is left of the camera.
  StageSet set = wall(15.0f);
  set.fog = false;
  set.map = true;
  set.roof_m = 3.0f;
  const auto s = stage(set);
  Frame frame = rain_frame(100.0f, 1.0f / 60.0f, 6.0);
  frame.camera.vertical_fov_rad = 0.3f;  // not above the roof
  const auto light = light_of(*s, frame);
  double taken[2] = {};
  for (int y = 0; y < 90; ++y)
    for (int x = 0; x < 160; ++x) {
      if (std::abs(x - 80) < 12) continue;
      taken[x > 80] += 1.0 - light[4 * std::size_t(y * 160 + x)];
    }
  EXPECT_GT(taken[1], 1.0);
  EXPECT_LT(taken[0], 1e-3 * taken[1]);
}

TEST_F(ConePicture, KnobsLeaveTheMean) {
  const auto s = stage(wall(18.0f));
  Frame plain = rain_frame(20.0f, 1.0f / 60.0f, 4.0);
  const auto first = light_of(*s, plain);
  DoubleCone longer, faster, farther, nearer, drizzle, flakes;
  longer.streak_length = 2.0f;
  faster.scroll_speed = 1.7f;
  farther.parallax = 2.0f;
  nearer.parallax = 0.5f;
  drizzle.texture = ConeTexture::drizzle;
  flakes.texture = ConeTexture::snow_coarse;
  for (const DoubleCone& set : {longer, faster, farther, nearer, drizzle, flakes}) {
    Frame frame = rain_frame(20.0f, 1.0f / 60.0f, 4.0, set);
    const auto light = light_of(*s, frame);
    EXPECT_NE(light, first);
    EXPECT_NEAR(1.0 - mean_of(light), 1.0 - mean_of(first), 0.1 * (1.0 - mean_of(first)));
  }
}

TEST_F(ConePicture, OfSnowHasTheMeanOfItsHaze) {
  for (const float wall_m : {3.0f, 15.0f}) {
    StageSet set = wall(wall_m);
    set.fog = false;
    const auto s = stage(set);
    double cone = 0.0, extinction = 0.0;
    for (int i = 0; i < 4; ++i) {
      Frame frame = stage_frame(160, 90, {3.0, 1.7, -8.0});
      frame.sky.zenith_cd_m2 = frame.sky.horizon_cd_m2 = glm::vec3(0.0f);
      frame.time_s = 3.0 + i;
      Snowfall snowfall;
      snowfall.snow_mm_per_hour = 2.0f;
      snowfall.maximum_flakes = 1000;
      frame.snow = make_frame_snow(snowfall, start_snow_motion({}), frame.camera, 160, 90, frame.time_s);
      frame.snow->techniques.set(Effect::snow, SnowRung::double_cone);
      set_cone(*frame.snow, {}, frame.camera, 1.0f / 60.0f, frame.time_s);
      extinction = frame.snow->extinction_per_m;
      const auto light = light_of(*s, frame);
      cone += mean_of(light) / 4.0;
      EXPECT_GT(deviation_of(light), 1e-4);
    }
    const double tall = std::tan(0.5 * 1.0471976), truth = [&] {
      double sum = 0.0;
      for (int y = 0; y < 90; ++y)
        for (int x = 0; x < 160; ++x) {
          const double u = ((x + 0.5) / 80.0 - 1.0) * tall * 16.0 / 9.0, v = ((y + 0.5) / 45.0 - 1.0) * tall;
          const double away = wall_m * std::sqrt(1.0 + u * u + v * v);
          sum += std::exp(-extinction * std::min(away, double(cone_edges_m[cone_layers])));
        }
      return sum / (160 * 90);
    }();
    EXPECT_NEAR(cone, truth, 0.005);
    EXPECT_NEAR(1.0 - cone, 1.0 - truth, 0.1 * (1.0 - truth)) << wall_m;
  }
}

}  // namespace
}  // namespace petrichor
