// Splashes on the GPU against the drop field enumerated here: same seed, same cells, same places and times.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/core/random.hpp"
#include "engine/platform/context.hpp"
#include "systems/drip_frame.hpp"
#include "systems/drops/layers.hpp"
#include "systems/rainfall/extract.hpp"
#include "systems/splash/impact.h"
#include "systems/splash/stage.hpp"

namespace petrichor {
namespace {

class SplashField : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto made = make_headless_context({.debug = true});
    if (made) context = std::move(*made);
  }
  static void TearDownTestSuite() { context.reset(); }
  void SetUp() override {
    if (!context) GTEST_SKIP() << "no OpenGL 4.5";
    errors = gl_error_count();
  }
  void TearDown() override { EXPECT_EQ(context ? gl_error_count() : errors, errors) << last_gl_error(); }

  static std::unique_ptr<SplashStage> stage(SplashStageSet set = {}) {
    set.software = context->device().software;
    auto made = SplashStage::make(set);
    EXPECT_TRUE(made) << (made ? "" : made.error().message);
    return made ? std::move(*made) : nullptr;
  }
  static void rain_on(Frame& f, float rate, const Wind& wind = {}) {
    Emitter emitter;
    emitter.rain_mm_per_hour = rate;
    f.rain = make_frame_rain(emitter, start_rain_motion(emitter, wind), f.camera, f.width, f.height, f.time_s);
  }

  inline static std::unique_ptr<Context> context;
  int errors = 0;
};

struct Landed {
  glm::dvec3 place_m;
  double age_s;
  float diameter_m;
};

// Every drop of the field that came through the level y = 0 within the last `age_s`, inside the box.
std::vector<Landed> landed_in(const FrameRain& rain, const glm::dvec2& low, const glm::dvec2& high, double age_s) {
  std::vector<Landed> all;
  for (std::size_t k = 0; k < rain.classes.size(); ++k) {
    const RainClass& c = rain.classes[k];
    const glm::dvec3 velocity(c.velocity_mps);
    int number = 0;
    for (const RainLayer& layer : layers_of(c)) {
      const double e = layer.edge_m;
      const glm::dvec3 moved = velocity * age_s;
      const glm::dvec3 from = glm::min(glm::dvec3(low.x, 0, low.y), glm::dvec3(low.x, 0, low.y) + moved) - c.origin_m;
      const glm::dvec3 to = glm::max(glm::dvec3(high.x, 0, high.y), glm::dvec3(high.x, 0, high.y) + moved) - c.origin_m;
      for (auto i = std::int64_t(std::floor(from.x / e)); i <= std::int64_t(std::floor(to.x / e)); ++i)
        for (auto j = std::int64_t(std::floor(from.y / e)); j <= std::int64_t(std::floor(to.y / e)); ++j)
          for (auto l = std::int64_t(std::floor(from.z / e)); l <= std::int64_t(std::floor(to.z / e)); ++l) {
            const std::uint32_t salt = std::uint32_t(k << 8 | unsigned(number)) ^ (rain.seed * 0x9e3779b9u);
            const glm::uvec4 bits =
                random_bits4(glm::uvec4(std::uint32_t(i), std::uint32_t(j), std::uint32_t(l), salt));
            const unsigned count = poisson_count(unit_float(bits.x), layer.expected, std::exp(-layer.expected), 255u);
            for (unsigned m = 0; m < count; ++m) {
              const glm::uvec4 b = random_bits4(glm::uvec4(bits.y, bits.z, m, bits.w));
              const glm::dvec3 at = c.origin_m + e * (glm::dvec3(double(i), double(j), double(l)) +
                                                      glm::dvec3(unit_float(b.x), unit_float(b.y), unit_float(b.z)));
              const double age = at.y / velocity.y;
              if (age < 0.0 || age > age_s) continue;
              const glm::dvec3 place = at - velocity * age;
              if (place.x < low.x || place.x > high.x || place.z < low.y || place.z > high.y) continue;
              all.push_back({place, age, c.diameter_mm * 1e-3f});
            }
          }
      ++number;
    }
  }
  return all;
}

void expect_same_impacts(SplashStage& s, const Wind& wind, double tolerance_m) {
  Frame f = s.frame(160, 90);
  f.time_s = 31.0;
  f.techniques.set(Effect::splashes, SplashRung::field);
  Emitter emitter;
  emitter.rain_mm_per_hour = 20.0f;
  f.rain = make_frame_rain(emitter, start_rain_motion(emitter, wind), f.camera, f.width, f.height, f.time_s);
  auto all = default_splashes();
  all->most_splashes = 100000;
  f.splashes = all;
  ASSERT_TRUE(s.draw(f));
  const std::vector<SplashGpu> drawn = read_splashes();
  // A piece of the ground that is in view.
  const glm::dvec2 low(-0.8, -4.5), high(0.8, -3.0);
  std::vector<Landed> truth = landed_in(*f.rain, low, high, 0.2);
  std::erase_if(truth, [&](const Landed& t) {
    // Alive while the shutter is open, and a splash on dry asphalt.
    const auto c = std::find_if(f.rain->classes.begin(), f.rain->classes.end(),
                                [&](const RainClass& k) { return k.diameter_mm * 1e-3f == t.diameter_m; });
    const float speed = -c->velocity_mps.y;
    return impact::splash_on_dry(t.diameter_m, speed) <= 1.0f ||
           t.age_s - f.camera.exposure_s >= impact::splash_life(t.diameter_m);
  });
  ASSERT_GT(truth.size(), 40u);
  std::size_t found = 0, within = 0;
  for (const Landed& t : truth) {
    const bool same = std::any_of(drawn.begin(), drawn.end(), [&](const SplashGpu& g) {
      const glm::dvec3 place = f.camera.position_m + glm::dvec3(glm::vec3(g.place_radius));
      return g.drop.x == t.diameter_m && glm::distance(place, t.place_m) < tolerance_m &&
             std::abs(g.axis_age.w - t.age_s) < 0.001;
    });
    found += same;
  }
  for (const SplashGpu& g : drawn) {
    const glm::dvec3 place = f.camera.position_m + glm::dvec3(glm::vec3(g.place_radius));
    within += place.x >= low.x && place.x <= high.x && place.z >= low.y && place.z <= high.y;
  }
  EXPECT_GE(found, truth.size() * 99 / 100) << truth.size();
  EXPECT_NEAR(double(within), double(truth.size()), 2.0 + 0.01 * truth.size());
}

TEST_F(SplashField, EverySplashIsADropOfTheFieldAndEveryDropASplash) {
  auto s = stage();
  ASSERT_TRUE(s);
  expect_same_impacts(*s, {}, 0.003);
}

TEST_F(SplashField, InWindTheyLandWhereTheirStreaksEnd) {
  auto s = stage();
  ASSERT_TRUE(s);
  Wind wind;
  wind.velocity_mps = {4.0f, 0.0f, 2.0f};
  // Small drops come in flatter than the one map: the G-buffer's plane mends their place and time.
  expect_same_impacts(*s, wind, 0.01);
}

TEST_F(SplashField, OfFilmsAndPolishedStoneOtherDropsSplash) {
  const auto least = [&](SplashStageSet set) {
    auto s = stage(set);
    Frame f = s->frame(160, 90);
    f.time_s = 10.0;
    f.techniques.set(Effect::splashes, SplashRung::field);
    rain_on(f, 30.0f);
    EXPECT_TRUE(s->draw(f));
    float d = 1.0f;
    for (const SplashGpu& g : read_splashes()) d = std::min(d, g.drop.x);
    return d * 1e3f;
  };
  const float dry = least({}), wet = least({.film_mm = 1.5f}), polished = least({.roughness = 0.1f});
  EXPECT_LT(dry, 0.85f);
  EXPECT_GT(wet, 1.2f);
  EXPECT_GT(polished, 3.3f);
}

TEST_F(SplashField, NothingRunsWhereItDoesNotRain) {
  auto s = stage();
  Frame f = s->frame(160, 90);
  f.splashes.reset();
  ASSERT_TRUE(s->draw(f));
  for (const PassReport& r : s->report())
    if (r.name.rfind("splash_", 0) == 0 || r.name == "rain_composite") EXPECT_TRUE(r.culled) << r.name;
}

TEST_F(SplashField, NothingRunsWhereNoSurfaceIsInView) {
  auto s = stage();
  Frame f = s->frame(160, 90);
  f.techniques.set(Effect::splashes, SplashRung::field);
  rain_on(f, 30.0f);
  const auto culled = [&] {
    int count = 0;
    for (const PassReport& r : s->report()) count += (r.name == "splash_list" || r.name == "splash_draw") && r.culled;
    return count;
  };
  ASSERT_TRUE(s->draw(f));
  EXPECT_EQ(culled(), 0);
  f.camera.orientation = glm::angleAxis(1.5707963f, glm::vec3(1.0f, 0.0f, 0.0f));  // straight up
  ASSERT_TRUE(s->draw(f));
  EXPECT_EQ(culled(), 2);
}

TEST_F(SplashField, RungsGiveTheSameMeanLight) {
  auto s = stage({.film_mm = 0.4f});
  const auto mean = [&](SplashRung rung, SplashRung from, float blend) {
    double sum = 0.0, dry = 0.0;
    for (int i = 0; i < 6; ++i) {
      Frame f = s->frame(160, 90);
      f.time_s = 10.0 + 0.37 * i;
      rain_on(f, 50.0f);
      auto set = default_splashes();
      set->secondary_reach_m = 0.0f;
      set->most_splashes = 200000;
      set->reach_m = 8.0f;
      f.splashes = set;
      f.techniques.set(Effect::splashes, rung);
      f.techniques[Effect::splashes].from = static_cast<std::uint8_t>(from);
      f.techniques[Effect::splashes].blend = blend;
      EXPECT_TRUE(s->draw(f));
      for (const float v : s->light()) sum += v, dry += 0.02;
    }
    return (sum - dry) / dry;
  };
  const double field = mean(SplashRung::field, SplashRung::field, 1.0f);
  const double random = mean(SplashRung::random, SplashRung::random, 1.0f);
  const double half = mean(SplashRung::field, SplashRung::random, 0.5f);
  EXPECT_GT(field, 0.0);
  EXPECT_NEAR(random / field, 1.0, 0.1);
  EXPECT_NEAR(half / field, 1.0, 0.1);
}

TEST_F(SplashField, DripsSplashWhereTheyLand) {
  auto s = stage({.film_mm = 0.4f});
  Frame f = s->frame(160, 90);
  f.time_s = 10.0;
  auto drips = std::make_shared<FrameDrips>();
  drips->landings.push_back({{0.1, 0.0, -3.0}, 9.99, 4.5f, {0.0f, -6.0f, 0.0f}, 77u});
  drips->landings.push_back({{0.4, 0.0, -3.0}, 9.0, 4.5f, {0.0f, -6.0f, 0.0f}, 78u});  // long over
  f.drips = drips;
  ASSERT_TRUE(s->draw(f));
  const std::vector<SplashGpu> drawn = read_splashes();
  ASSERT_EQ(drawn.size(), 1u);
  EXPECT_NEAR(drawn[0].place_radius.x, 0.1f, 1e-3f);
  EXPECT_NEAR(drawn[0].axis_age.w, 0.01f, 1e-4f);
}

TEST_F(SplashField, GlowsThatAreNoLightsLightThem) {
  auto s = stage({.film_mm = 0.4f});
  const auto mean = [&](bool glow) {
    Frame f = s->frame(160, 90);
    f.time_s = 10.0;
    f.lights.resize(1);
    f.lights[0].intensity = glm::vec3(0.01f);
    rain_on(f, 50.0f);
    auto set = default_splashes();
    if (glow) set->glows.push_back({{0.0f, 2.0f, -6.0f}, {0.0f, 0.0f, 0.0f}, {400.0f, 300.0f, 200.0f}});
    f.splashes = set;
    EXPECT_TRUE(s->draw(f));
    double sum = 0.0;
    for (const float v : s->light()) sum += v;
    return sum;
  };
  EXPECT_GT(mean(true), 1.01 * mean(false));
}

}  // namespace
}  // namespace petrichor
