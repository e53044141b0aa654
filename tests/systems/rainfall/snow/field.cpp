// Falling snow as a field: the water that reaches the ground, the wind, time.
#include "../field.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>

#include "systems/rainfall/snow/extract.hpp"
#include "systems/rainfall/snow/flakes.hpp"

namespace petrichor {
namespace {

Snowfall snow_of(float mm_per_hour) {
  Snowfall s;
  s.snow_mm_per_hour = mm_per_hour;
  s.maximum_flakes = 400'000'000;
  return s;
}

FrameSnow snow_at(const Snowfall& s, const WindMotion& motion, double time_s) {
  return make_frame_snow(s, motion, FrameCamera{}, 160, 90, time_s);
}

TEST(SnowField, TheAskedWaterFallsThroughAPlane) {
  // Counts flakes of the field through 10 m x 10 m, two seconds at a time. Some 100,000 flakes: their water is known
  // to about 1.5%.
  for (const float rate : {0.3f, 3.0f}) {
    Wind wind;
    wind.velocity_mps = {1.0f, 0.0f, 0.5f};
    const WindMotion motion = start_snow_motion(wind);
    double mg = 0.0, seconds = 0.0;
    for (int i = 0; i < 8; ++i) {
      const double start = 7.0 * i, step = 2.0;
      const FrameSnow before = snow_at(snow_of(rate), motion, start),
                      now = snow_at(snow_of(rate), motion, start + step);
      double deepest = 0.0;
      for (std::size_t k = 0; k < now.classes.size(); ++k)
        deepest = std::max(deepest, before.classes[k].origin_m.y - now.classes[k].origin_m.y);
      const RainBox box{glm::dvec3(-5.0, -deepest, -5.0), glm::dvec3(5.0, 0.0, 5.0)};
      for (const FieldDrop& flake : drops_in(flake_field(now), glm::dvec3(0.0), box)) {
        const double was =
            flake.position_m.y + before.classes[flake.cls].origin_m.y - now.classes[flake.cls].origin_m.y;
        if (was > 0.0) mg += flake_mass_mg(now.classes[flake.cls].diameter_mm);
      }
      seconds += step;
    }
    EXPECT_NEAR(mg * 3.6e-3 / (100.0 * seconds) / rate, 1.0, 0.05) << rate;
  }
}

TEST(SnowField, FollowsTheWindWithinATenthOfASecond) {
  // From calm to 5 m/s: each class relaxes at g / V, and a tenth of a second without a tick makes no difference.
  FrameSnow snow[2];
  for (const bool hitch : {false, true}) {
    Registry registry;
    const Entity entity = registry.create();
    registry.emplace<Snowfall>(entity, snow_of(1.0f));
    registry.emplace<Wind>(entity);
    for (int tick = 0; tick <= 240; ++tick) {
      if (tick == 120) registry.find<Wind>(entity)->velocity_mps = {5.0f, 0.0f, 0.0f};
      if (hitch && tick > 120 && tick < 132) continue;
      simulate_snowfall(registry, tick / 120.0);
      if (tick != 132) continue;
      Frame frame;
      frame.width = 160, frame.height = 90;
      extract_snowfall(registry, frame, 1.1);
      ASSERT_TRUE(frame.snow);
      snow[hitch] = *frame.snow;
      for (const SnowClass& c : frame.snow->classes)  // the wind turned at 1 s
        EXPECT_NEAR(c.velocity_mps.x, 5.0 * (1.0 - std::exp(-0.1 * 9.81 / c.fall_speed_mps)), 1e-3);
    }
    Frame frame;
    frame.width = 160, frame.height = 90;
    extract_snowfall(registry, frame, 2.0);
    for (const SnowClass& c : frame.snow->classes) EXPECT_NEAR(c.velocity_mps.x, 5.0f, 0.02f);
    // The direction of the occlusion map: 5 m/s sideways, about 1.1 m/s down.
    EXPECT_NEAR(frame.snow->mean_velocity_mps.x, 5.0f, 0.02f);
    EXPECT_NEAR(frame.snow->mean_velocity_mps.y, -1.15f, 0.15f);
  }
  for (std::size_t k = 0; k < snow[0].classes.size(); ++k)
    EXPECT_LT(glm::length(snow[0].classes[k].origin_m - snow[1].classes[k].origin_m), 1e-9);
}

TEST(SnowField, IsTheSameAt200AndAt5FramesASecond) {
  Registry registries[2];
  for (Registry& registry : registries) {
    const Entity entity = registry.create();
    registry.emplace<Snowfall>(entity, snow_of(1.0f));
    registry.emplace<Wind>(entity, Wind{{1.0f, 0.0f, 0.2f}, 0.8f, 3.0f, 0.4f});
  }
  // The ticks are the simulation's; the frames ask when they like.
  for (int tick = 0; tick <= 120 * 4; ++tick)
    for (Registry& registry : registries) simulate_snowfall(registry, tick / 120.0);
  Frame often, seldom;
  often.width = seldom.width = 160;
  often.height = seldom.height = 90;
  for (int i = 0; i <= 800; ++i) extract_snowfall(registries[0], often, i / 200.0);
  for (int i = 0; i <= 20; ++i) extract_snowfall(registries[1], seldom, i / 5.0);
  ASSERT_TRUE(often.snow && seldom.snow);
  EXPECT_EQ(often.snow->clock_s, seldom.snow->clock_s);
  for (std::size_t k = 0; k < often.snow->classes.size(); ++k)
    EXPECT_EQ(often.snow->classes[k].origin_m, seldom.snow->classes[k].origin_m);
}

TEST(SnowField, FlakesStayWhereTheyAreWhileTheRateChanges) {
  const WindMotion motion = start_snow_motion({});
  const FrameSnow light = snow_at(snow_of(0.5f), motion, 5.0), heavy = snow_at(snow_of(4.0f), motion, 5.0);
  const RainBox box{glm::dvec3(-3.0), glm::dvec3(3.0)};
  using Key = std::tuple<std::size_t, std::uint32_t, int, int, int, std::uint32_t>;
  std::map<Key, glm::dvec3> places;
  for (const FieldDrop& d : drops_in(flake_field(light), glm::dvec3(0.0), box))
    places[{d.cls, d.layer, d.cell.x, d.cell.y, d.cell.z, d.number}] = d.position_m;
  std::size_t kept = 0;
  std::map<std::size_t, std::size_t> before, now, lost;
  for (const auto& [key, place] : places) ++before[std::get<0>(key)];
  for (const FieldDrop& d : drops_in(flake_field(heavy), glm::dvec3(0.0), box)) {
    ++now[d.cls];
    const auto found = places.find({d.cls, d.layer, d.cell.x, d.cell.y, d.cell.z, d.number});
    if (found == places.end()) continue;
    EXPECT_EQ(found->second, d.position_m);
    ++kept;
  }
  // Of each class the fewer are a part of the more.
  std::size_t fewer = 0;
  for (const auto& [cls, count] : before) fewer += std::min(count, now[cls]);
  EXPECT_GE(kept, fewer * 98 / 100);
  EXPECT_GT(kept, 1000u);
}

TEST(SnowField, HasABudget) {
  Snowfall s = snow_of(2.0f);
  FrameCamera camera;
  const FrameSnow all = make_frame_snow(s, start_snow_motion({}), camera, 640, 360, 1.0);
  EXPECT_NEAR(all.drawn_distance_m, 25.0f, 0.1f);
  s.maximum_flakes = 20'000;
  const FrameSnow few = make_frame_snow(s, start_snow_motion({}), camera, 640, 360, 1.0);
  EXPECT_NEAR(few.expected_flakes, 20'000.0f, 200.0f);
  EXPECT_EQ(few.extinction_per_m, all.extinction_per_m);
  // Large flakes reach farther than small ones: they are seen from farther.
  EXPECT_LT(few.classes.front().reach, 0.2f * few.classes.back().reach);
}

TEST(SnowField, HazeAndFlakesShareTheExtinction) {
  for (const SnowRung rung : {SnowRung::fog, SnowRung::double_cone, SnowRung::field}) {
    Snowfall s = snow_of(2.0f);
    s.maximum_flakes = 5000;
    FrameSnow snow = make_frame_snow(s, start_snow_motion({}), FrameCamera{}, 640, 360, 1.0);
    snow.techniques.set(Effect::snow, rung);
    update_onsets(snow);
    float sum = snow.fog_extinction_per_m;
    for (const RainOnset& o : snow.onsets) sum += o.extinction_per_m;
    EXPECT_NEAR(sum / snow.extinction_per_m, 1.0f, 1e-4f);
    EXPECT_NEAR(snow.fog_extinction_per_m, rung == SnowRung::fog ? snow.extinction_per_m : 0.0f,
                1e-4f * snow.extinction_per_m);
  }
}

TEST(SnowField, IsOfTheFirstThatSnows) {
  // Every emitter carries a snowfall, most of rate 0.
  Registry registry;
  const Entity dry = registry.create(), first = registry.create(), second = registry.create();
  registry.emplace<Snowfall>(second, snow_of(5.0f));
  registry.emplace<Snowfall>(first, snow_of(2.0f));
  registry.emplace<Snowfall>(dry);
  simulate_snowfall(registry, 0.0);
  EXPECT_TRUE(registry.find<SnowMotion>(first));
  EXPECT_FALSE(registry.find<SnowMotion>(dry));
  Frame frame;
  extract_snowfall(registry, frame, 0.0);
  ASSERT_TRUE(frame.snow);
  EXPECT_EQ(frame.snow->snow_mm_per_hour, 2.0f);
  registry.get<Snowfall>(dry).snow_mm_per_hour = 0.5f;
  extract_snowfall(registry, frame, 0.0);
  EXPECT_EQ(frame.snow->snow_mm_per_hour, 0.5f);
}

TEST(SnowField, NoSnowNoFrame) {
  Registry registry;
  Frame frame;
  extract_snowfall(registry, frame, 0.0);
  EXPECT_FALSE(frame.snow);
  registry.emplace<Snowfall>(registry.create());
  simulate_snowfall(registry, 0.0);
  extract_snowfall(registry, frame, 0.0);
  EXPECT_FALSE(frame.snow);
}

}  // namespace
}  // namespace petrichor
