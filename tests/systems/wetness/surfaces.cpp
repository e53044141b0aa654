// Pass wet_surfaces on a street with awnings.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "components/water.hpp"
#include "systems/occlusion/street.hpp"
#include "systems/systems.hpp"
#include "systems/wetness/history.hpp"
#include "systems/wetness/stage.hpp"
#include "systems/wetness/wetness.hpp"
#include "tests/systems/geometry/stage.hpp"

namespace petrichor {
namespace {

constexpr int width = 160, height = 90;

// Looks under the free-standing roof from the side.
class WetSurfaces : public testing::Test {
 protected:
  void SetUp() override {
    if (!context) GTEST_SKIP() << "no OpenGL context";
    build(stage, "");
    ground.initial_wetness = 0.0f;
    rain.rain_mm_per_hour = 10.0f;
  }

  static void build(WetStage& stage, const std::string& extras) {
    auto street = std::make_shared<Model>(*shelter_street());
    for (Material& m : street->materials) {
      m.base_colour = glm::vec4(0.2f, 0.2f, 0.2f, 1.0f);
      m.roughness = 0.6f;
      m.metallic = 0.0f;
      m.extras_json = extras;
    }
    stage.add(street);
    stage.frame.width = width;
    stage.frame.height = height;
    look(stage, {10.0, 1.6, 0.0}, {0.0f, 0.0f, 0.0f});
    const auto loaded = stage.load(all_passes(), 4);
    ASSERT_TRUE(loaded) << loaded.error().message;
  }

  void look(const glm::dvec3& eye, const glm::vec3& at) { look(stage, eye, at); }
  static void look(WetStage& stage, const glm::dvec3& eye, const glm::vec3& at) {
    stage.frame.camera.position_m = eye;
    stage.frame.camera.orientation = glm::quatLookAt(glm::normalize(at - glm::vec3(eye)), glm::vec3(0, 1, 0));
  }
  void pass(double seconds) {
    if (!started) history = start_wetness(rain, wind, ground, 0.0);
    started = true;
    for (const double end = time_s + seconds; time_s < end;) follow_rain(history, rain, wind, ground, time_s += 0.5);
  }
  WetPixels draw(WetnessRung rung = WetnessRung::sheltered) { return draw(stage, rung); }
  WetPixels draw(WetStage& stage, WetnessRung rung = WetnessRung::sheltered) {
    stage.frame.techniques.set(Effect::wetness, rung);
    stage.frame.wetness = make_frame_wetness(history, ground, time_s);
    stage.frame.rain.reset();
    if (history.raining) stage.frame.rain = stage.frame.wetness->rain;
    stage.frame.wind = wind;
    auto got = stage.draw();
    EXPECT_TRUE(got) << got.error().message;
    return got ? *got : WetPixels{};
  }
  // Of the pixel that shows this place.
  std::size_t pixel_of(const glm::vec3& place) const {
    const glm::vec4 clip =
        stage.frame.uniforms.view_projection * glm::vec4(place - glm::vec3(stage.frame.camera.position_m), 1.0f);
    const glm::vec2 at = (glm::vec2(clip) / clip.w * 0.5f + 0.5f) * glm::vec2(width, height);
    return static_cast<std::size_t>(at.y) * width + static_cast<std::size_t>(at.x);
  }
  static float albedo(const WetPixels& p, std::size_t i) { return p.albedo[i].x * p.albedo[i].x; }

  Context* context = test::stage_context();  // before what lives in it
  WetStage stage;
  Emitter rain;
  Wind wind;
  WetGround ground;
  WetnessHistory history;
  double time_s = 0.0;
  bool started = false;
};
TEST_F(WetSurfaces, ThePassDoesNotRunWhereNoSurfaceIsInView) {
  pass(600.0);
  draw();
  EXPECT_TRUE(stage.ran());
  const glm::quat there = stage.frame.camera.orientation;
  stage.frame.camera.position_m.y += 100.0;  // over the roofs, straight up
  stage.frame.camera.orientation = glm::angleAxis(1.5707963f, glm::vec3(1.0f, 0.0f, 0.0f));
  draw();
  EXPECT_FALSE(stage.ran());
  stage.frame.camera.position_m.y -= 100.0;
  stage.frame.camera.orientation = there;
  draw();
  EXPECT_TRUE(stage.ran());
}


TEST_F(WetSurfaces, AwningsKeepDryWhatTheWindLetsThem) {
  // Rain from -x: the shelter of a roof at 3 m moves 0.7 m (the largest drops) to 3 m (those of 0.5 mm) towards +x. (In
  // more wind than that small drops reach every place, and a tenth of the rain is half the film.)
  wind.velocity_mps = {2.0f, 0.0f, 0.0f};
  pass(600.0);
  const WetPixels dry = draw(WetnessRung::none), wet = draw();
  const std::size_t open = pixel_of({7.5f, 0.0f, 0.0f}), lee = pixel_of({1.7f, 0.0f, 0.0f}),
                    windward = pixel_of({-1.6f, 0.0f, 0.0f});
  EXPECT_GT(wet.water[open].y, 0.3f);
  EXPECT_LT(wet.water[lee].y, 0.01f);      // as far from its edge, and dry
  EXPECT_GT(wet.water[windward].y, 0.3f);  // under the roof, and wet
  EXPECT_NEAR(albedo(wet, lee), albedo(dry, lee), 0.006f);
  EXPECT_LT(albedo(wet, open), 0.62f * albedo(dry, open));
  EXPECT_LT(wet.normal[open].z, 0.6f * dry.normal[open].z);  // glossier
  EXPECT_FLOAT_EQ(wet.normal[lee].z, dry.normal[lee].z);
  for (std::size_t i = 0; i < wet.albedo.size(); ++i) ASSERT_LE(albedo(wet, i), albedo(dry, i) + 1e-6f);
}

// Share of a pixel whose first interface is water (gbuffer.glsl): it mirrors 0.02 head-on, stone 0.04.
double water_share(const WetPixels& p, std::size_t i) {
  return static_cast<double>(std::lround(p.normal[i].w * 65535.0f) % 32) / 31.0;
}

TEST_F(WetSurfaces, WhatAFilmCoversMirrorsAsWater) {
  wind.velocity_mps = {2.0f, 0.0f, 0.0f};
  pass(600.0);
  const WetPixels dry = draw(WetnessRung::none), wet = draw();
  const std::size_t open = pixel_of({7.5f, 0.0f, 0.0f}), lee = pixel_of({1.7f, 0.0f, 0.0f});
  for (std::size_t i = 0; i < dry.normal.size(); ++i) ASSERT_EQ(water_share(dry, i), 0.0) << i;
  EXPECT_GT(water_share(wet, open), 0.9);  // a film of 0.3 mm, where 20 um wet two thirds
  EXPECT_LT(water_share(wet, lee), 0.1);
  EXPECT_NEAR(wet.normal[open].w, dry.normal[open].w, 1.0 / 2047.0);  // occlusion, to who reads it whole
}

TEST_F(WetSurfaces, MaterialsSayWhetherAndHowTheyWet) {
  pass(600.0);
  const std::size_t open = pixel_of({7.5f, 0.0f, 0.0f});
  const WetPixels dry = draw(WetnessRung::none);
  std::vector<float> of;  // albedo, of porosities 0 and 1
  for (const char* extras : {R"({"water": {"porosity": 0}})", R"({"water": {"porosity": 1}})", R"({"water": false})"}) {
    for (const WetnessRung rung : {WetnessRung::everywhere, WetnessRung::sheltered, WetnessRung::flowing}) {
      WetStage own;
      build(own, extras);
      const WetPixels got = draw(own, rung);
      of.push_back(albedo(got, open));
      if (of.size() > 6) {
        EXPECT_EQ(of.back(), albedo(dry, open));
        EXPECT_EQ(got.normal[open], dry.normal[open]);
      }
    }
  }
  // optics.h: full pores leave 0.7 of what the film alone does.
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(of[i + 3] / of[i], 0.7f, 0.12f) << i;
}

TEST_F(WetSurfaces, WithoutAnyRainThePassDoesNotRun) {
  rain.rain_mm_per_hour = 0.0f;
  pass(5.0);
  EXPECT_EQ(make_frame_wetness(history, ground, time_s), nullptr);
  draw();
  EXPECT_FALSE(stage.ran());
  rain.rain_mm_per_hour = 10.0f;
  pass(5.0);
  draw();
  EXPECT_TRUE(stage.ran());
  draw(WetnessRung::none);
  EXPECT_FALSE(stage.ran());
}

TEST_F(WetSurfaces, AFrameIsTheSameWhicheverWasDrawnBefore) {
  wind.velocity_mps = {3.0f, 0.0f, 1.0f};
  pass(60.0);
  for (const WetnessRung rung : {WetnessRung::everywhere, WetnessRung::sheltered, WetnessRung::flowing}) {
    const WetPixels alone = draw(rung);
    const WetnessHistory then = history;
    const double then_s = time_s;
    look({-30.0, 9.0, 20.0}, {0.0f, 0.0f, 0.0f});
    wind.velocity_mps = {-3.0f, 0.0f, 1.0f};
    pass(30.0);
    draw(rung);
    look({10.0, 1.6, 0.0}, {0.0f, 0.0f, 0.0f});
    wind.velocity_mps = {3.0f, 0.0f, 1.0f};
    history = then;
    time_s = then_s;
    const WetPixels again = draw(rung);
    EXPECT_EQ(alone.albedo, again.albedo);
    EXPECT_EQ(alone.normal, again.normal);
    EXPECT_EQ(alone.water, again.water);
  }
}

TEST_F(WetSurfaces, ShelterIsRememberedAfterTheRain) {
  wind.velocity_mps = {2.0f, 0.0f, 0.0f};
  pass(600.0);
  rain.rain_mm_per_hour = 0.0f;
  wind.velocity_mps = {0.0f, 0.0f, 0.0f};  // and the wind has died
  pass(60.0);
  const WetPixels wet = draw();
  EXPECT_GT(wet.water[pixel_of({-1.6f, 0.0f, 0.0f})].y, 0.15f);
  EXPECT_LT(wet.water[pixel_of({1.7f, 0.0f, 0.0f})].y, 0.01f);
}

TEST_F(WetSurfaces, WhenTheWindTurnsBothEdgesAreThere) {
  wind.velocity_mps = {5.0f, 0.0f, 0.0f};
  pass(600.0);
  wind.velocity_mps = {-5.0f, 0.0f, 0.0f};
  pass(20.0);
  const WetPixels soon = draw();
  const std::size_t was_wet = pixel_of({-1.7f, 0.0f, 0.0f}), was_dry = pixel_of({2.8f, 0.0f, 0.0f});
  EXPECT_GT(soon.water[was_wet].y, 0.1f);  // sheltered now, still wet
  pass(240.0);
  const WetPixels later = draw();
  EXPECT_GT(later.water[was_dry].y, soon.water[was_dry].y + 0.1f);
  EXPECT_LT(later.water[was_wet].y, 0.85f * soon.water[was_wet].y);  // drains, in the outskirts of the penumbra
}

TEST_F(WetSurfaces, RungsGiveWayToOneAnotherEvenly) {
  wind.velocity_mps = {5.0f, 0.0f, 0.0f};
  pass(600.0);
  const WetPixels dry = draw(WetnessRung::none), wet = draw(WetnessRung::sheltered);
  stage.frame.techniques[Effect::wetness] = {static_cast<std::uint8_t>(WetnessRung::sheltered),
                                             static_cast<std::uint8_t>(WetnessRung::none), 0.5f};
  stage.frame.wetness = make_frame_wetness(history, ground, time_s);
  const auto half = stage.draw();
  ASSERT_TRUE(half) << half.error().message;
  const std::size_t open = pixel_of({7.5f, 0.0f, 0.0f});
  EXPECT_NEAR(albedo(*half, open), 0.5f * (albedo(dry, open) + albedo(wet, open)), 0.015f);
}

}  // namespace
}  // namespace petrichor
