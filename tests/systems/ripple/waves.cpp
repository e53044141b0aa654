// The pass of ripples: the same state in whatever order frames are drawn, rings where drops land, round and of no
// volume.
#include "systems/ripple/waves.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "systems/ripple/history.hpp"
#include "systems/ripple/seeds.hpp"
#include "systems/ripple/stage.hpp"
#include "systems/ripple_frame.hpp"
#include "tests/systems/geometry/stage.hpp"

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
  // Past the first swap of epochs at 6 s, and a cut of the camera at 7 s. Every third frame is skipped in one of them.
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
  for (const double until : {3.0, 5.9, 6.05, 7.5}) {
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
    // Shared physics 5: 0.02 to 0.10 at 10 mm/h, 0.05 to 0.26 at 50, of rings as they are. The lattice of 128 cells has
    // wider, lower seeds: twice as wide, half as steep.
    RippleSettings natural;
    natural.seed_cells = 0.0f;
    const double true_slope = std::sqrt(
        make_ripple_rain(stage.emitter(), natural)->slope_variance_per_s / (2.0 * stage.ripples().decay_per_s));
    EXPECT_GT(true_slope, rate < 20.0f ? 0.02 : 0.05);
    EXPECT_LT(true_slope, rate < 20.0f ? 0.10 : 0.26);
    EXPECT_NEAR(shared / balance, 0.5, 0.12);
    EXPECT_NEAR(near / shared, 1.0, 0.25);
  }
}

}  // namespace
}  // namespace petrichor::test
