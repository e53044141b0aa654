// Streak sprites: the same rain as fog, frames that stand alone, and Tariq's controls.
#include "systems/rainfall/sprites/sprites.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <memory>

#include "components/weather.hpp"
#include "systems/rainfall/extract.hpp"
#include "systems/rainfall/passes.hpp"
#include "systems/rainfall/stage.hpp"
#include "tests/engine/platform/gl_test.hpp"

namespace petrichor {
namespace {

class Sprites : public test::GlTest {
 protected:
  // A wall behind drops that shine with nothing: the picture is the transmittance.
  static std::unique_ptr<RainStage> stage(float wall_m, int path = 0, float wall_cd_m2 = 1.0f) {
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

Frame frame_of(double time_s, int width = 160, int height = 90) {
  Frame frame = stage_frame(width, height, {3.0, 1.7, -8.0});
  frame.sky.zenith_cd_m2 = frame.sky.horizon_cd_m2 = glm::vec3(0.0f);
  frame.time_s = time_s;
  frame.number = static_cast<std::uint64_t>(time_s * 60.0);
  return frame;
}

Emitter rain_of(float mm_per_hour, std::int32_t drops = 100'000) {
  Emitter emitter;
  emitter.rain_mm_per_hour = mm_per_hour;
  emitter.maximum_drops = drops;
  return emitter;
}

void rain_on(Frame& frame, const Emitter& emitter, RainRung rung = RainRung::sprites,
             const StreakSprites& settings = {}, const Wind& wind = {}) {
  frame.rain =
      make_frame_rain(emitter, start_rain_motion(emitter, wind), frame.camera, frame.width, frame.height, frame.time_s);
  frame.rain->techniques.set(Effect::rainfall, rung);
  frame.rain->sprites = make_frame_sprites(settings, *frame.rain);
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
  double squares = 0.0;
  const double mean = mean_of(light);
  for (std::size_t p = 0; p < light.size(); p += 4) squares += (light[p] - mean) * (light[p] - mean);
  return std::sqrt(squares / (static_cast<double>(light.size()) / 4.0));
}

// Mean difference of neighbours: 0 where nothing single is to be seen.
double roughness_of(const std::vector<float>& light) {
  double sum = 0.0;
  for (std::size_t p = 4; p < light.size(); p += 4) sum += std::abs(light[p] - light[p - 4]);
  return sum / (static_cast<double>(light.size()) / 4.0);
}

FrameLight lamp_at(const glm::vec3& position_m, int kind) {
  FrameLight light{};
  light.position_m = position_m;
  light.direction = {0.0f, 0.0f, 1.0f};
  light.intensity = glm::vec3(kind == LIGHT_DIRECTIONAL ? 5.0f : 100.0f);
  light.source_radius_m = 0.08f;
  light.kind = kind;
  light.lights_rain = true;
  return light;
}

TEST_F(Sprites, MeanIsThatOfFogAtEveryDistance) {
  for (const float wall_m : {2.0f, 5.0f, 10.0f, 20.0f}) {
    const auto s = stage(wall_m);
    for (const float rate : {1.0f, 10.0f, 50.0f}) {
      double single = 0.0, fog = 0.0, varied = 0.0;
      constexpr int frames = 3;
      for (int i = 0; i < frames; ++i) {
        Frame frame = frame_of(20.0 + 0.7 * i), plain = frame_of(20.0 + 0.7 * i);
        rain_on(frame, rain_of(rate));
        rain_on(plain, rain_of(rate), RainRung::fog);
        const auto light = light_of(*s, frame);
        single += mean_of(light) / frames;
        varied += deviation_of(light) / frames;
        fog += mean_of(light_of(*s, plain)) / frames;
      }
      EXPECT_NEAR(single, fog, 0.005) << wall_m << " m, " << rate << " mm/h";
      // Closer, where enough drops are drawn that chance leaves a tenth of what they take.
      if (rate > 5.0f && wall_m > 4.0f)
        EXPECT_NEAR(1.0 - single, 1.0 - fog, 0.1 * (1.0 - fog)) << wall_m << ' ' << rate;
      EXPECT_GT(varied, 3e-4) << "no single drop to be seen";
    }
  }
}

TEST_F(Sprites, MeanStaysWhileTechniquesGiveWayToEachOther) {
  const auto s = stage(12.0f);
  for (const RainRung other : {RainRung::fog, RainRung::drop_field}) {
    double mixed = 0.0, fog = 0.0;
    constexpr int frames = 4;
    for (int i = 0; i < frames; ++i) {
      Frame frame = frame_of(30.0 + 0.7 * i), plain = frame_of(30.0 + 0.7 * i);
      rain_on(frame, rain_of(50.0f));
      frame.rain->techniques[Effect::rainfall].from = static_cast<std::uint8_t>(other);
      frame.rain->techniques[Effect::rainfall].blend = 0.5f;
      rain_on(plain, rain_of(50.0f), RainRung::fog);
      mixed += mean_of(light_of(*s, frame)) / frames;
      fog += mean_of(light_of(*s, plain)) / frames;
    }
    EXPECT_NEAR(1.0 - mixed, 1.0 - fog, 0.08 * (1.0 - fog)) << int(other);
  }
}

TEST_F(Sprites, BothPathsDrawTheSameDrops) {
  std::vector<float> light[2];
  std::uint32_t drops[2];
  for (const int path : {1, 2}) {
    const auto s = stage(12.0f, path);
    Frame frame = frame_of(7.0);
    rain_on(frame, rain_of(20.0f));
    frame.lights.push_back(lamp_at({3.0f, 3.0f, -14.0f}, LIGHT_POINT));
    light[path - 1] = light_of(*s, frame);
    drops[path - 1] = rain_stats(frame).drops_drawn;
  }
  EXPECT_EQ(drops[0], drops[1]);
  EXPECT_GT(drops[0], 10'000u);
  EXPECT_NEAR(mean_of(light[0]), mean_of(light[1]), 1e-3 * mean_of(light[0]));
}

TEST_F(Sprites, AnyFrameStandsAlone) {
  // The same bytes whichever frames came before, whatever else the particles were told meanwhile.
  const auto used = stage(9.0f), fresh = stage(9.0f);
  Wind wind;
  wind.velocity_mps = {3.0f, 0.0f, 1.0f};
  wind.gust_mps = 2.0f;
  for (const double time_s : {3.0, 1.0, 3.1, 50.0}) {
    Frame frame = frame_of(time_s);
    rain_on(frame, rain_of(40.0f), RainRung::sprites, {.published = time_s == 1.0}, wind);
    light_of(*used, frame);
  }
  Frame again = frame_of(15.0), alone = frame_of(15.0);
  rain_on(again, rain_of(10.0f), RainRung::sprites, {}, wind);
  rain_on(alone, rain_of(10.0f), RainRung::sprites, {}, wind);
  EXPECT_EQ(light_of(*used, again), light_of(*fresh, alone));
}

TEST_F(Sprites, TheBudgetShrinksTheBox) {
  Frame frame = frame_of(0.0);
  rain_on(frame, rain_of(10.0f, 1'000'000));
  const float wide = frame.rain->sprites.box_m;
  rain_on(frame, rain_of(10.0f, 10'000));
  const FrameSprites& few = frame.rain->sprites;
  EXPECT_LT(few.box_m, 0.5f * wide);
  EXPECT_LE(few.count, 80'000);
  EXPECT_GT(few.count, 40'000);
  const auto s = stage(20.0f);
  EXPECT_NEAR(mean_of(light_of(*s, frame)), 1.0, 0.1);
  EXPECT_LE(rain_stats(frame).drops_drawn, 10'000u);
  // The largest: out to the distance asked for.
  rain_on(frame, rain_of(1.0f, 400'000'000));
  EXPECT_EQ(frame.rain->sprites.box_m, 2.0f * frame.rain->asked_distance_m);
  rain_on(frame, rain_of(10.0f, 0));
  EXPECT_EQ(frame.rain->sprites.count, 0);
}

TEST_F(Sprites, NumbersFollowTheRateDropByDrop) {
  // While the box stays, a higher rate adds particles behind those of each class that are there.
  Frame frame = frame_of(4.0);
  std::map<int, std::uint32_t> before;
  float box_m = 0.0f;
  for (const float rate : {2.0f, 2.5f, 3.0f}) {
    rain_on(frame, rain_of(rate));
    if (box_m == 0.0f) box_m = 0.5f * frame.rain->sprites.box_m;
    frame.rain->sprites.box_m = box_m;
    const SpriteClasses made = sprite_classes(*frame.rain, frame.camera.position_m, 1.0);
    std::map<int, std::uint32_t> now;
    for (std::size_t i = 0; i < made.classes.size(); ++i) {
      const auto end = i + 1 < made.classes.size() ? std::uint32_t(made.classes[i + 1].numbers.y) : made.particles;
      now[made.classes[i].numbers.z] = end - std::uint32_t(made.classes[i].numbers.y);
    }
    double expected = 0.0;
    for (std::size_t k = 0; k < frame.rain->classes.size(); ++k) {
      const RainClass& c = frame.rain->classes[k];
      if (!c.drawn) continue;
      const double mean = double(c.drops_per_m3) * box_m * box_m * box_m;
      EXPECT_LE(std::abs(now[int(k)] - mean), 1.0) << k;
      EXPECT_GE(now[int(k)], before[int(k)]) << k;
      expected += mean;
    }
    EXPECT_NEAR(made.particles, expected, 16.0);
    before = now;
  }
}

TEST_F(Sprites, FreezeHoldsTheDropsAndLetsThemGoOnFromThere) {
  Registry registry;
  const Entity entity = registry.create();
  registry.emplace<Emitter>(entity, rain_of(20.0f));
  Wind wind;
  wind.velocity_mps = {2.0f, 0.0f, 0.0f};
  wind.gust_mps = 1.0f;
  registry.emplace<Wind>(entity, wind);
  registry.emplace<StreakSprites>(entity);
  const auto s = stage(9.0f);
  std::vector<std::vector<float>> light;
  std::vector<glm::dvec3> places;
  for (int tick = 0; tick <= 240; ++tick) {
    const double time_s = tick / 120.0;
    registry.find<StreakSprites>(entity)->freeze = tick > 60 && tick <= 180;
    simulate_rainfall(registry, time_s);
    simulate_sprites(registry, time_s);
    if (tick % 60 != 0) continue;
    Frame frame = frame_of(time_s);
    frame.techniques.set(Effect::rainfall, RainRung::sprites);
    extract_rainfall(registry, frame, time_s);
    extract_sprites(registry, frame, time_s);
    ASSERT_TRUE(frame.rain && frame.rain->sprites.offset_m.size() == frame.rain->classes.size());
    places.push_back(frame.rain->classes[12].origin_m + frame.rain->sprites.offset_m[12]);
    if (tick == 60) EXPECT_EQ(frame.rain->sprites.offset_m[12], glm::dvec3(0.0));
    light.push_back(light_of(*s, frame));
  }
  EXPECT_LT(glm::length(places[2] - places[1]), 1e-9);
  EXPECT_LT(glm::length(places[3] - places[1]), 1e-9);
  EXPECT_NEAR(places[4].y - places[3].y, places[1].y - places[0].y, 1e-9);  // half a second each
  // Gusts bend the streaks of drops that stand, so their pictures are alike, not the same.
  double still = 0.0, moving = 0.0;
  for (std::size_t p = 0; p < light[1].size(); p += 4) {
    still += std::abs(light[2][p] - light[1][p]);
    moving += std::abs(light[4][p] - light[1][p]);
  }
  EXPECT_LT(still, 0.6 * moving);
}

TEST_F(Sprites, WindMultipliesTheWind) {
  Registry registry[2];
  glm::dvec3 places[2];
  Frame frames[2];
  for (int i = 0; i < 2; ++i) {
    const Entity entity = registry[i].create();
    registry[i].emplace<Emitter>(entity, rain_of(20.0f));
    Wind wind;
    wind.velocity_mps = {2.0f, 0.0f, 1.0f};
    registry[i].emplace<Wind>(entity, wind);
    registry[i].emplace<StreakSprites>(entity).wind = i == 0 ? 1.0f : 3.0f;
    frames[i] = frame_of(1.5);
    for (int tick = 0; tick <= 180; ++tick) {
      simulate_rainfall(registry[i], tick / 120.0);
      simulate_sprites(registry[i], tick / 120.0);
    }
    extract_rainfall(registry[i], frames[i], 1.5);
    extract_sprites(registry[i], frames[i], 1.5);
    places[i] = frames[i].rain->classes[14].origin_m + frames[i].rain->sprites.offset_m[14];
  }
  EXPECT_NEAR(places[0].x, 3.0, 1e-6);
  EXPECT_NEAR(places[1].x, 9.0, 1e-6);
  EXPECT_NEAR(places[1].z, 4.5, 1e-6);
  EXPECT_NEAR(places[1].y, places[0].y, 1e-6);
  const SpriteClasses blown = sprite_classes(*frames[1].rain, frames[1].camera.position_m, 1.0);
  for (const SpriteClassGpu& c : blown.classes) {
    EXPECT_NEAR(c.velocity_diameter.x, 6.0f, 1e-4f);
    EXPECT_NEAR(c.velocity_diameter.y, -c.origin_speed.w, 1e-4f);
  }
}

TEST_F(Sprites, RainAndBackgroundCanBeHidden) {
  const auto s = stage(9.0f);
  Frame frame = frame_of(5.0);
  rain_on(frame, rain_of(50.0f), RainRung::sprites, {.hide_rain = true});
  const auto wall = light_of(*s, frame);
  EXPECT_LT(roughness_of(wall), 2e-4);  // nothing but the fog beyond the box: half a step of the picture's format
  EXPECT_EQ(rain_stats(frame).drops_drawn, 0u);
  rain_on(frame, rain_of(50.0f), RainRung::sprites, {.hide_background = true});
  frame.sky.zenith_cd_m2 = frame.sky.horizon_cd_m2 = glm::vec3(2.0f);
  const auto drops = light_of(*s, frame);
  EXPECT_GT(rain_stats(frame).drops_drawn, 10'000u);
  EXPECT_GT(roughness_of(drops), 2e-3);
  // Drops of 2 cd/m2 before nothing: what they cover times that.
  const double covered = 1.0 - std::exp(-double(frame.rain->drawn_extinction_per_m) * frame.rain->sprites.onset_m());
  EXPECT_NEAR(mean_of(drops), 2.0 * covered, 0.35 * 2.0 * covered);
  rain_on(frame, rain_of(50.0f), RainRung::sprites, {.hide_rain = true, .hide_background = true});
  EXPECT_EQ(mean_of(light_of(*s, frame)), 0.0);
}

TEST_F(Sprites, FractionDrawsAFraction) {
  const auto s = stage(9.0f);
  double taken[2];
  std::uint32_t drops[2];
  for (int i = 0; i < 2; ++i) {
    Frame frame = frame_of(5.0);
    rain_on(frame, rain_of(50.0f), RainRung::sprites, {.fraction = i == 0 ? 1.0f : 0.25f});
    Frame bare = frame_of(5.0);
    rain_on(bare, rain_of(50.0f), RainRung::sprites, {.hide_rain = true});
    const double without = mean_of(light_of(*s, bare));
    taken[i] = without - mean_of(light_of(*s, frame));
    drops[i] = rain_stats(frame).drops_drawn;
  }
  EXPECT_NEAR(drops[1], 0.25 * drops[0], 5.0 * std::sqrt(0.25 * drops[0]));
  EXPECT_NEAR(taken[1], 0.25 * taken[0], 0.3 * 0.25 * taken[0]);
}

TEST_F(Sprites, RespondsToLightsAsAsked) {
  const auto s = stage(9.0f, 0, 0.0f);
  const auto light_with = [&](int kind, const StreakSprites& settings) {
    Frame frame = frame_of(5.0);
    rain_on(frame, rain_of(50.0f), RainRung::sprites, settings);
    frame.lights.push_back(lamp_at({2.0f, 2.5f, -16.0f}, kind));
    return mean_of(light_of(*s, frame));
  };
  for (const int kind : {LIGHT_DIRECTIONAL, LIGHT_POINT}) {
    const bool sun = kind == LIGHT_DIRECTIONAL;
    const auto responding = [&](float response) {
      StreakSprites settings;
      (sun ? settings.directional_response : settings.lamp_response) = response;
      return light_with(kind, settings);
    };
    const double fog_alone = responding(0.0f);  // what stands in beyond the box is lit all the same
    const double once = responding(1.0f);
    EXPECT_GT(once, 1.3 * fog_alone) << kind;
    EXPECT_NEAR(responding(2.0f) - fog_alone, 2.0 * (once - fog_alone), 0.02 * once) << kind;
    StreakSprites other;
    (sun ? other.lamp_response : other.directional_response) = 0.0f;
    EXPECT_DOUBLE_EQ(light_with(kind, other), once) << kind;
  }
}

}  // namespace
}  // namespace petrichor
