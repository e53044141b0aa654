// The pass of ripples: the same state in whatever order frames are drawn, rings where drops land, round and of no
// volume.
#include "systems/ripple/waves.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstring>

#include "systems/rainfall/extract.hpp"
#include "systems/ripple/history.hpp"
#include "systems/ripple/ripple.hpp"
#include "systems/ripple/seeds.hpp"
#include "systems/ripple/stage.hpp"
#include "systems/ripple_frame.hpp"
#include "tests/systems/geometry/stage.hpp"
#include "tests/systems/rainfall/field.hpp"

namespace petrichor::test {
namespace {

class RippleWavesGl : public testing::Test {
 protected:
  void SetUp() override {
    if (!stage_context()) GTEST_SKIP() << "no OpenGL";
  }
  static void draw(RippleStage& stage, double before = 0.0) {
    const auto drawn = stage.draw(stage.frame(before));
    ASSERT_TRUE(drawn) << drawn.error().message;
    ASSERT_TRUE(stage.ran());
  }
};

bool same(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(glm::vec4)) == 0;
}

double rms(const std::vector<glm::vec4>& slopes) {
  double sum = 0.0;
  for (const glm::vec4& s : slopes) sum += double(s.x) * s.x + double(s.y) * s.y;
  return std::sqrt(sum / static_cast<double>(slopes.size()));
}

TEST_F(RippleWavesGl, FramesDrawnOneByOneEqualAFrameDrawnAlone) {
  // Past the swaps of epochs, each 2.5 s, and a cut of the camera at 7 s. Every third frame is skipped in one of them.
  RippleStage each, alone;
  ASSERT_TRUE(each.load(64));
  ASSERT_TRUE(alone.load(64));
  const auto step = [](RippleStage& stage) {
    const double t = static_cast<double>(stage.ticks()) / 120.0;
    stage.wind().velocity_mps.x = t > 2.0 ? 3.0f : 0.0f;
    stage.emitter().rain_mm_per_hour = t > 5.0 ? 20.0f : 10.0f;
    const double cut = t > 7.0 ? 20.0 : 0.0;
    stage.look({1.2 * t + cut, 1.6, 2.0 - 0.3 * t}, glm::normalize(glm::vec3(std::sin(t), -0.5f, -1)));
    stage.tick();
  };
  for (const double until : {2.4, 2.6, 5.05, 7.5}) {
    while (static_cast<double>(each.ticks()) < until * 120.0) {
      step(each);
      if (each.ticks() % 2 == 0 && each.ticks() % 6 != 0) draw(each);
    }
    while (static_cast<double>(alone.ticks()) < until * 120.0) step(alone);
    RippleStage fresh;  // as if the program had begun now: the GPU knows nothing
    draw(each, 0.25);
    ASSERT_TRUE(alone.load(64));
    draw(alone, 0.25);
    for (int layer = 0; layer < 2; ++layer) {
      EXPECT_TRUE(same(each.layer(layer), alone.layer(layer))) << "layer " << layer << " at " << until;
      EXPECT_GT(rms(alone.layer(layer)), 0.002) << "layer " << layer << " at " << until;
    }
  }
}

TEST_F(RippleWavesGl, SlopesAreOfTheSizeThatTheBalanceSays) {
  RippleStage stage;
  ASSERT_TRUE(stage.load(128));
  for (const float rate : {10.0f, 50.0f}) {
    stage.emitter().rain_mm_per_hour = rate;
    stage.run(4.0);
    stage.techniques.set(Effect::ripples, RippleRung::near_tile);
    draw(stage);
    const double shared = rms(stage.layer(0)), near = rms(stage.layer(1));
    const double balance = std::sqrt(double(stage.frame().ripples->at(stage.ticks() - 1)->slope_variance));
    std::printf("%2.0f mm/h: rms slope %.4f shared, %.4f near, %.4f by the balance\n", rate, shared, near, balance);
    // Shared physics 5: 0.02 to 0.10 at 10 mm/h, 0.05 to 0.26 at 50, of rings as they are. The lattice has seeds as wide
    // as theirs; of their slopes Sobel's filter over five cells a wave leaves some three quarters.
    RippleSettings natural;
    natural.seed_cells = 0.0f;
    const double true_slope = std::sqrt(make_ripple_rain(stage.emitter(), natural)->slope_variance_per_s /
                                        (2.0 * stage.ripples().decay_per_s));
    EXPECT_GT(true_slope, rate < 20.0f ? 0.02 : 0.05);
    EXPECT_LT(true_slope, rate < 20.0f ? 0.10 : 0.26);
    EXPECT_NEAR(shared / balance, 0.75, 0.2);
    // Seeds of one and a half cells: 8.8 mm wide there, 12 mm here.
    EXPECT_NEAR(near / shared, 8.8 / 12.0, 0.15);
  }
}

// The streak that falls there, the splash and the ring are one drop.
TEST_F(RippleWavesGl, RingsBeginWhereTheFieldsDropsLand) {
  RippleStage stage;
  stage.run(3.0);
  const Frame f = stage.frame();
  const std::int64_t tick = f.ripples->tick;
  const auto impacts = field_impacts(*f.ripples, tick, tick, 0, 256);
  const FrameRain rain = make_frame_rain(stage.emitter(), start_rain_motion(stage.emitter(), {}), f.camera, 160, 90,
                                         static_cast<double>(tick) / 120.0);
  const RippleTick& t = *f.ripples->at(tick);
  const glm::dvec2 middle = glm::dvec2(t.near_centre) * double(t.near_cell_m);
  std::size_t due = 0, found = 0;
  const RainBox below{{middle.x - 1.0, -0.1, middle.y - 1.0}, {middle.x + 1.0, 0.0, middle.y + 1.0}};
  for (const FieldDrop& d : drops_in(rain, glm::dvec3(0.0), below)) {
    const RainClass& c = rain.classes[d.cls];
    // Below the level, by less than it falls in a tick.
    if (c.diameter_mm < smallest_ring_mm || d.position_m.y < -c.fall_speed_mps / 120.0 + 1e-4 || d.position_m.y > -1e-4)
      continue;
    ++due;
    for (const RippleImpact& i : impacts)
      found +=
          i.diameter_mm == c.diameter_mm && glm::distance(i.place_m, glm::dvec2(d.position_m.x, d.position_m.z)) < 1e-3;
  }
  EXPECT_GT(due, 15u);  // 1300 a square metre and second
  EXPECT_EQ(found, due);
  // Asked tick by tick or all at once, with what it has found ahead: the same.
  FieldDrops each;
  std::size_t one_by_one = 0;
  for (std::int64_t i = tick - 30; i <= tick; ++i) one_by_one += each.impacts(*f.ripples, i, i, 0, 256).size();
  const auto together = field_impacts(*f.ripples, tick - 30, tick, 0, 256);
  EXPECT_EQ(one_by_one, together.size());
}

TEST_F(RippleWavesGl, ARingIsRoundAndRunsAtTheWavesSpeed) {
  RippleStage stage;
  stage.emitter().rain_mm_per_hour = 0.0f;
  stage.techniques.set(Effect::ripples, RippleRung::verlet9);
  ASSERT_TRUE(stage.load(128));
  DripLanding drip{};
  stage.run(1.0);
  drip.time_s = 0.9;
  stage.landings = {drip};  // somewhere, or all is calm and there is no frame of it
  const Frame first = stage.frame();
  const RippleTick& t = *first.ripples->at(stage.ticks() - 1);
  const glm::dvec2 middle = glm::dvec2(t.near_centre) * double(t.near_cell_m);
  drip.place_m = {middle.x, 0.0, middle.y};
  drip.time_s = static_cast<double>(stage.ticks() - 1) / 120.0 - 0.4;
  drip.diameter_mm = 4.5f;
  drip.velocity_mps = {0, -7, 0};
  stage.landings = {drip};
  draw(stage);
  const auto slopes = stage.layer(2);
  // Where the slopes are, by sectors: their mean radius and their squares' sum.
  std::array<double, 8> radius{}, sum{};
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x) {
      const glm::vec2 away(x - 63.5f, y - 63.5f);
      const glm::vec4& s = slopes[static_cast<std::size_t>(y) * 128 + x];
      const double square = double(s.x) * s.x + double(s.y) * s.y;
      const int sector = static_cast<int>(std::floor((std::atan2(away.y, away.x) / M_PI + 1.0) * 4.0)) & 7;
      radius[sector] += square * glm::length(away) * t.near_cell_m;
      sum[sector] += square;
    }
  for (int i = 0; i < 8; ++i) {
    EXPECT_NEAR(sum[i] / sum[0], 1.0, 0.1);
    EXPECT_NEAR(radius[i] / sum[i], radius[0] / sum[0], 0.03 * radius[0] / sum[0]);
  }
  // In 0.4 s, at 0.18 to 0.35 m/s.
  EXPECT_GT(radius[0] / sum[0], 0.06);
  EXPECT_LT(radius[0] / sum[0], 0.15);
}

TEST_F(RippleWavesGl, UnderARoofOnlyDripsRingAndFarWaterIsRough) {
  RippleStage stage;
  ASSERT_TRUE(stage.load(128));
  stage.run(3.0);
  const Frame f = stage.frame();
  const RippleTick& t = *f.ripples->at(stage.ticks() - 1);
  const glm::dvec3 eye = f.camera.position_m;
  const glm::dvec2 middle = glm::dvec2(t.near_centre) * double(t.near_cell_m);
  const glm::vec3 near(glm::dvec3(middle.x + 0.05, 0.0, middle.y) - eye);
  for (int i = 0; i < 64; ++i) {
    stage.questions.emplace_back(near + glm::vec3(0.003f * i, 0, 0), 1.0f);
    stage.questions.emplace_back(near + glm::vec3(0.003f * i, 0, 0), 0.0f);
    stage.questions.emplace_back(glm::vec3(0.13f * i, -1.6f, -4.5f), 1.0f);
    stage.questions.emplace_back(glm::vec3(0.13f * i, -1.6f, -40.0f), 1.0f);
  }
  Frame wide = stage.frame();
  wide.width = 1280, wide.height = 720;
  ASSERT_TRUE(stage.draw(wide));
  const auto answers = stage.answers();
  std::array<double, 4> shown{}, unseen{};
  for (std::size_t i = 0; i < answers.size(); ++i) {
    shown[i % 4] += double(answers[i].x) * answers[i].x + double(answers[i].y) * answers[i].y;
    unseen[i % 4] += answers[i].z;
  }
  EXPECT_GT(shown[0], 0.0);
  EXPECT_EQ(shown[1], 0.0) << "a roof";
  EXPECT_EQ(unseen[1], 0.0);
  // 40 m away a pixel holds many rings: what it does not show is roughness, and all of it together is the same.
  EXPECT_LT(shown[3], 0.1 * shown[0]);
  EXPECT_GT(unseen[3], 5.0 * unseen[0]);
  EXPECT_NEAR(unseen[3] / 64.0, double(t.slope_variance), 0.3 * t.slope_variance);
  for (const glm::vec4& a : answers) ASSERT_TRUE(std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z));
}

TEST_F(RippleWavesGl, WadersLeaveAWakeAndStillOnesNone) {
  RippleStage stage;
  ASSERT_TRUE(stage.load(128));
  stage.run(0.1);
  const Frame first = stage.frame();
  const RippleTick& t = *first.ripples->at(stage.ticks() - 1);
  stage.emitter().rain_mm_per_hour = 0.0f;
  stage.run(9.0);
  const glm::vec2 middle = glm::vec2(t.near_centre) * t.near_cell_m;
  const Entity wader = stage.add_wader({0.06f, 6.0f, 0.4f}, {middle.x - 0.2f, 0.1f, middle.y});
  stage.run(0.5);
  EXPECT_FALSE(stage.frame().ripples);  // it costs nothing until it moves
  for (int i = 0; i < 60; ++i) {
    stage.place(wader, {middle.x - 0.2f + 0.005f * i, 0.1f, middle.y});
    stage.tick();
  }
  draw(stage);
  EXPECT_GT(rms(stage.layer(1)), 0.003);
  // Under the water's level it is somewhere else: a cellar.
  for (int i = 0; i < 600; ++i) {
    stage.place(wader, {middle.x + 0.1f - 0.0005f * i, -2.0f, middle.y});
    stage.tick();
  }
  EXPECT_FALSE(stage.frame().ripples);
}

TEST_F(RippleWavesGl, NothingRunsWithoutWaterOrRungOrRings) {
  RippleStage stage;
  ASSERT_TRUE(stage.load(64));
  stage.run(0.2);
  draw(stage);
  Frame dry = stage.frame();
  dry.ripples.reset();
  ASSERT_TRUE(stage.draw(dry));
  EXPECT_FALSE(stage.ran());
  stage.techniques.set(Effect::ripples, RippleRung::none);
  ASSERT_TRUE(stage.draw(stage.frame()));
  EXPECT_FALSE(stage.ran());
  stage.techniques.set(Effect::ripples, RippleRung::verlet9);
  stage.look({0.0, 1.6, 2.0}, glm::normalize(glm::vec3(0, 1, -0.2f)));  // at the sky
  ASSERT_TRUE(stage.draw(stage.frame()));
  EXPECT_FALSE(stage.ran());
  EXPECT_EQ(ripples_ladder().coverage(stage.frame()), 0.0);
  stage.look({0.0, 1.6, 2.0}, glm::normalize(glm::vec3(0, -0.5f, -1)));
  EXPECT_GT(ripples_ladder().coverage(stage.frame()), 0.0);
  // It has stopped raining, and the rings have died.
  stage.emitter().rain_mm_per_hour = 0.0f;
  stage.run(8.0);
  EXPECT_EQ(stage.frame().ripples, nullptr);
}

}  // namespace
}  // namespace petrichor::test
