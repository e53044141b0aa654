// Where splashes could break (shared physics, 6d): each test provokes one failure.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <random>

#include "engine/platform/context.hpp"
#include "systems/drops/drop_physics.hpp"
#include "systems/rainfall/extract.hpp"
#include "systems/splash/impact.h"
#include "systems/splash/stage.hpp"

namespace petrichor {
namespace {

TEST(Splashes, OneHundredThousandGiveNoMoreEnergyAndWaterThanTheyBring) {
  // As splash_draw.comp.glsl sends droplets out: number m of n has size (m + random) / n.
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  double most_energy = 0.0, most_mass = 0.0, whole = 0.0, given = 0.0;
  int splashed = 0;
  for (int event = 0; event < 100000; ++event) {
    const float d = 1e-3f * (0.7f + 5.3f * unit(random) * unit(random));
    const float v = static_cast<float>(terminal_speed_mps(1e3 * d)) * std::sqrt(unit(random));  // oblique, too
    if (impact::splash_number(d, v, 2e-3f * unit(random) * unit(random), unit(random)) <= 1.0f) continue;
    ++splashed;
    const double pi = std::numbers::pi, rho = impact::WATER_DENSITY, sigma = impact::WATER_TENSION;
    const double mass = rho * pi / 6.0 * std::pow(double(d), 3.0);
    const double incident = 0.5 * mass * v * v + pi * d * d * sigma;
    double energy = 0.0, shed = 0.0;
    const unsigned n = impact::secondary_count(d, v);
    for (unsigned m = 0; m < n; ++m) {
      const float s = impact::secondary_diameter(d, (float(m) + unit(random)) / float(n));
      const float u = impact::secondary_speed(v, d, s);
      const double droplet = rho * pi / 6.0 * std::pow(double(s), 3.0);
      shed += droplet;
      energy += 0.5 * droplet * u * u + pi * double(s) * s * sigma;
    }
    most_energy = std::max(most_energy, energy / incident);
    most_mass = std::max(most_mass, shed / mass);
    whole += incident;
    given += energy;
  }
  EXPECT_GT(splashed, 20000);
  EXPECT_LE(most_energy, 1.0);
  EXPECT_LE(most_mass, 1.0);
  EXPECT_LT(given, 0.2 * whole);  // most goes into the crown, its film and heat
  RecordProperty("most_energy", std::to_string(most_energy));
  RecordProperty("most_mass", std::to_string(most_mass));
}

// Drag only takes: no droplet is ever faster than it left, but for what it falls.
TEST(Splashes, DropletsGainNoSpeedInTheAir) {
  for (const float d : {5e-5f, 2e-4f, 1e-3f})
    for (const float u : {0.5f, 3.0f, 9.0f})
      for (float t = 0.0f; t < 0.16f; t += 0.01f) {
        const auto a = impact::secondary_way(u, d, t), b = impact::secondary_way(u, d, t + 0.001f);
        EXPECT_LE((b.x - a.x) / 0.001f, u * 1.01f + 1e-3f);
        EXPECT_LE((b.y - a.y) / 0.001f, impact::droplet_fall_speed(d) * 1.01f + 2e-2f);
        EXPECT_TRUE(std::isfinite(b.x) && std::isfinite(b.y));
      }
}

class SplashesDrawn : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto made = make_headless_context({.debug = true});
    if (!made) return;
    context = std::move(*made);
    auto with = SplashStage::make({.software = context->device().software, .awning = true, .film_mm = 0.4f});
    EXPECT_TRUE(with) << (with ? "" : with.error().message);
    if (with) stage = std::move(*with);
  }
  static void TearDownTestSuite() {
    stage.reset();
    context.reset();
  }
  void SetUp() override {
    if (!context) GTEST_SKIP() << "no OpenGL 4.5";
    ASSERT_TRUE(stage);
    errors = gl_error_count();
  }
  void TearDown() override { EXPECT_EQ(context ? gl_error_count() : errors, errors) << last_gl_error(); }

  static Frame frame(double time_s, float rate, const Wind& wind = {}) {
    Frame f = stage->frame(160, 90);
    f.time_s = time_s;
    Emitter emitter;
    emitter.rain_mm_per_hour = rate;
    f.rain = make_frame_rain(emitter, start_rain_motion(emitter, wind), f.camera, f.width, f.height, time_s);
    f.techniques.set(Effect::splashes, SplashRung::field);
    return f;
  }
  static double brightness(Frame& f) {
    EXPECT_TRUE(stage->draw(f));
    double sum = 0.0;
    for (const float v : stage->light()) {
      EXPECT_TRUE(std::isfinite(v));
      sum += v - 0.02;
    }
    return sum;
  }

  inline static std::unique_ptr<Context> context;
  inline static std::unique_ptr<SplashStage> stage;
  int errors = 0;
};

TEST_F(SplashesDrawn, NoneUnderAnAwning) {
  for (const float wind_mps : {0.0f, 3.0f}) {
    Wind wind;
    wind.velocity_mps = {wind_mps, 0.0f, 0.0f};
    for (const SplashRung rung : {SplashRung::field, SplashRung::random}) {
      Frame f = frame(9.0, 50.0f, wind);
      f.techniques.set(Effect::splashes, rung);
      ASSERT_TRUE(stage->draw(f));
      int under = 0, on_ground = 0;
      // Where rain of the mean fall cannot come: its shadow on the ground, less a map's texel and a half on each side.
      const glm::vec3 fall = f.rain->mean_velocity_mps / -f.rain->mean_velocity_mps.y;
      const float drift = 3.0f * fall.x, margin = 0.2f;
      for (const SplashGpu& g : read_splashes()) {
        const glm::dvec3 at = f.camera.position_m + glm::dvec3(glm::vec3(g.place_radius));
        if (at.y > 1.0) continue;  // on the roof
        ++on_ground;
        under += at.x > -2.0f + drift + margin && at.x < 2.0f + drift - margin && at.z > -6.0f + margin &&
                 at.z < -2.0f - margin;
      }
      EXPECT_GT(on_ground, 200);
      EXPECT_EQ(under, 0) << wind_mps;
    }
  }
}

TEST_F(SplashesDrawn, ObliqueDropsStrikeWithTheirNormalSpeedOnly) {
  Wind wind;
  wind.velocity_mps = {14.0f, 0.0f, 0.0f};
  Frame f = frame(9.0, 30.0f, wind);
  ASSERT_TRUE(stage->draw(f));
  int seen = 0;
  for (const SplashGpu& g : read_splashes()) {
    ++seen;
    // On level ground that is the fall speed, whatever the wind adds.
    EXPECT_LE(g.drop.y, terminal_speed_mps(1e3 * g.drop.x) * 1.03 + 0.05) << g.drop.x;
  }
  EXPECT_GT(seen, 50);
}

TEST_F(SplashesDrawn, AFloodIsCappedAndKeepsItsBrightness) {
  // 50 mm/h over 100 m2 and more: 375,000 impacts of drops above 1 mm a second, thousands of them alive.
  double all = 0.0, capped = 0.0;
  std::uint32_t listed_all = 0, listed = 0;
  for (int i = 0; i < 12; ++i) {
    for (const int most : {200000, 800}) {
      Frame f = frame(5.0 + 0.31 * i, 50.0f);
      auto set = default_splashes();
      set->most_splashes = most;
      f.splashes = set;
      (most == 800 ? capped : all) += brightness(f);
      (most == 800 ? listed : listed_all) += static_cast<std::uint32_t>(splash_stats().drawn);
    }
  }
  EXPECT_GT(listed_all / 12, 4000u);
  EXPECT_LE(listed / 12, 800u);
  EXPECT_GT(listed / 12, 700u);  // and not far fewer than may be
  EXPECT_NEAR(capped / all, 1.0, 0.06);
  RecordProperty("all", std::to_string(listed_all / 12));
  RecordProperty("listed", std::to_string(listed / 12));
  RecordProperty("ratio", std::to_string(capped / all));
}

// The awning is 10 cm thick: what lands on it is no further from its underside than maps of shelter are wrong.
TEST_F(SplashesDrawn, NoneShowsThroughARoofThatIsSeenFromBelow) {
  Frame f = frame(9.0, 50.0f);
  f.camera.position_m = {0.0, 1.6, -1.0};
  f.camera.orientation = glm::angleAxis(glm::radians(35.0f), glm::vec3(1, 0, 0));
  ASSERT_TRUE(stage->draw(f));
  int on_roof = 0;
  for (const SplashGpu& g : read_splashes()) on_roof += f.camera.position_m.y + double(g.place_radius.y) > 2.5;
  EXPECT_EQ(on_roof, 0);
  // From above they are there.
  f.camera.position_m = {0.0, 5.5, -1.0};
  f.camera.orientation = glm::angleAxis(glm::radians(-40.0f), glm::vec3(1, 0, 0));
  ASSERT_TRUE(stage->draw(f));
  for (const SplashGpu& g : read_splashes()) on_roof += f.camera.position_m.y + double(g.place_radius.y) > 2.5;
  EXPECT_GT(on_roof, 20);
}

// Droplets outlive their crown tenfold: at a small cap they must not take the crowns' places.
TEST_F(SplashesDrawn, DropletsDoNotUseUpTheCapOfCrowns) {
  int crowns[2] = {0, 0};
  for (int i = 0; i < 4; ++i)
    for (const SplashRung rung : {SplashRung::field, SplashRung::secondary}) {
      Frame f = frame(5.0 + 0.31 * i, 50.0f);
      auto set = default_splashes();
      set->most_splashes = 400;
      f.splashes = set;
      f.techniques.set(Effect::splashes, rung);
      ASSERT_TRUE(stage->draw(f));
      for (const SplashGpu& g : read_splashes())
        crowns[rung == SplashRung::secondary] += (g.bits.y & SPLASH_CROWN) != 0u;
    }
  EXPECT_GT(crowns[0], 400);
  EXPECT_GT(crowns[1], 0.8 * crowns[0]);
}

TEST_F(SplashesDrawn, AnyOrderOfFramesGivesTheSameBytes) {
  const auto picture = [&](double time_s, double x) {
    Frame f = frame(time_s, 50.0f);
    f.camera.position_m.x = x;
    f.techniques.set(Effect::splashes, SplashRung::secondary);
    EXPECT_TRUE(stage->draw(f));
    return stage->light();
  };
  const auto first = picture(100.0, 0.0);
  const auto far = picture(3.0, 25.0);
  const auto back = picture(101.0, 0.3);
  const auto again = picture(100.0, 0.0);
  EXPECT_EQ(std::memcmp(first.data(), again.data(), first.size() * sizeof(float)), 0);
  EXPECT_NE(std::memcmp(first.data(), back.data(), first.size() * sizeof(float)), 0);
  EXPECT_NE(std::memcmp(first.data(), far.data(), first.size() * sizeof(float)), 0);
}

// Opacity that lightning takes (as printed) darkened splashes in a flash.
TEST_F(SplashesDrawn, AFlashMakesThemBrighterWithAndWithoutLamps) {
  for (const bool lamps : {true, false})
    for (const float sky : {0.01f, 0.0f}) {
      double before = 0.0;
      for (const float flash : {0.0f, 1.0f, 3.0f}) {
        Frame f = frame(9.0, 50.0f);
        f.sky.zenith_cd_m2 = f.sky.horizon_cd_m2 = glm::vec3(sky);
        if (!lamps) f.lights.clear();
        Frame none = f;
        f.rain->layered.lightning = none.rain->layered.lightning = flash;
        none.techniques.set(Effect::splashes, SplashRung::none);
        const double added = brightness(f) - brightness(none);
        if (flash > 0.0f) EXPECT_GT(added, before) << flash << " lamps " << lamps << " sky " << sky;
        before = added;
      }
      EXPECT_GT(before, 0.0);
    }
}

// What shines from above falls on the first surface under the sky, which moves: a picture kept from another frame shows.
TEST_F(SplashesDrawn, AnyOrderOfFramesGivesTheSameBytesUnderGlowsAndARoofThatMoves) {
  const auto picture = [&](int number) {
    Frame f = frame(100.0 + number, 50.0f);
    f.camera.position_m.x = 0.37 * number;
    f.lights.resize(1);
    f.lights[0].intensity = glm::vec3(0.01f);
    f.instances[1].matrix = glm::translate(glm::mat4(1.0f), glm::vec3(0.9f * float(number), -1.5f, 0.0f));
    f.geometry_version = 100u + unsigned(number);
    auto set = default_splashes();
    set->glows.push_back({{0.0f, 2.5f, -5.0f}, {0.0f, 0.0f, 0.0f}, {400.0f, 300.0f, 200.0f}});
    f.splashes = set;
    EXPECT_TRUE(stage->draw(f));
    return stage->light();
  };
  // Thirty is steps away: what follows it is drawn from nothing.
  picture(30);
  const auto second = picture(2);
  picture(30);
  const auto first = picture(0), again = picture(2), once_more = picture(0);
  EXPECT_EQ(std::memcmp(second.data(), again.data(), second.size() * sizeof(float)), 0);
  EXPECT_EQ(std::memcmp(first.data(), once_more.data(), first.size() * sizeof(float)), 0);
  EXPECT_NE(std::memcmp(first.data(), second.data(), first.size() * sizeof(float)), 0);
}

TEST_F(SplashesDrawn, ACameraThatGrazesTheGroundSeesThemFiniteAndInItsOwnPixels) {
  for (const double height : {0.02, 0.15}) {
    Frame f = frame(6.0, 50.0f);
    f.camera.position_m.y = height;
    f.camera.orientation = glm::quat(1.0f, 0.0f, 0.0f, 0.0f);
    f.techniques.set(Effect::splashes, SplashRung::secondary);
    EXPECT_GT(brightness(f), 0.0);
    // Nothing high in the sky: crowns are centimetres tall.
    const std::vector<float> light = stage->light();
    double top = 0.0;
    for (std::size_t i = std::size_t(85) * 160 * 3; i < light.size(); ++i) top += light[i] - 0.02;
    EXPECT_LT(top, 0.02 * 160 * 5 * 3 * 0.02) << height;
  }
}

}  // namespace
}  // namespace petrichor
