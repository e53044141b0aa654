// Where drawn drips could break.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "systems/drip/chart.hpp"
#include "systems/drip/stage.hpp"
#include "systems/drip_frame.hpp"
#include "tests/engine/platform/gl_test.hpp"

namespace petrichor::test {
namespace {

constexpr int width = 160, height = 90;

class DrawnDrips : public testing::Test {
 protected:
  void SetUp() override {
    if (!shared_gl_context()) GTEST_SKIP() << "no OpenGL 4.5";
    auto made = DripStage::make(true);
    ASSERT_TRUE(made) << made.error().message;
    stage = std::move(*made);
    set.source.length_m = 3.0f;
    set.source.catchment_depth_m = 1.0f;
  }
  std::vector<float> picture(Frame& f) {
    const auto drawn = stage->draw(f);
    EXPECT_TRUE(drawn) << (drawn ? "" : drawn.error().message);
    return stage->read_light();
  }
  static double mean(const std::vector<float>& a) {
    double sum = 0.0;
    for (const float v : a) sum += v;
    return sum / static_cast<double>(a.size());
  }
  std::unique_ptr<DripStage> stage;
  DripSet set;
};

// Rungs may differ in what they show, not in how bright the picture is on average; the printed opacity does.
TEST_F(DrawnDrips, RungsKeepTheMeanOfTheTruthAndThePrintedOpacityDoesNot) {
  const auto truth = true_drips(*stage, set, width, height, 3, 6);
  ASSERT_TRUE(truth);
  double published = 0.0, worst = 0.0;
  for (const DripRung rung : {DripRung::billboards, DripRung::streaks, DripRung::refracting}) {
    const auto c = compare_drips(*stage, *truth, set, rung, width, height);
    ASSERT_TRUE(c);
    std::printf("rung %d: error %.3f, mean %+.5f of %+.5f\n", int(rung), c->error, c->mean_shift, c->true_shift);
    worst = std::max(worst, std::abs(c->mean_shift / c->true_shift));
    EXPECT_LT(c->error, 0.8) << int(rung);
    // Of the truth's own change, not of the background: drips are few.
    EXPECT_LT(std::abs(c->mean_shift), 0.2 * std::abs(c->true_shift)) << int(rung);
  }
  // The measure can fail: where nothing is drawn, all of the change is missing.
  const auto nothing = compare_drips(*stage, *truth, set, DripRung::none, width, height);
  ASSERT_TRUE(nothing);
  EXPECT_NEAR(nothing->error, 1.0, 1e-6);
  EXPECT_GT(std::abs(nothing->mean_shift), 0.9 * std::abs(nothing->true_shift));
  set.source.published = true;
  const auto c = compare_drips(*stage, *truth, set, DripRung::billboards, width, height);
  ASSERT_TRUE(c);
  published = std::abs(c->mean_shift / c->true_shift);
  EXPECT_GT(published, worst);
}

TEST_F(DrawnDrips, NoPassRunsWhereNoneIsInView) {
  Frame f = stage->frame(set, width, height, 1.0, 4096);
  const auto ran = [&](std::string_view name) {
    for (const PassReport& r : stage->report())
      if (r.name == name) return !r.culled;
    return false;
  };
  picture(f);
  EXPECT_TRUE(ran("drips"));
  f.techniques.set(Effect::drips, DripRung::none);
  picture(f);
  EXPECT_FALSE(ran("drips"));
  EXPECT_FALSE(ran("drips_over"));
  set.rain_mm_per_hour = 0.0f;
  Frame dry = stage->frame(set, width, height, 1.0, 4096);
  EXPECT_FALSE(dry.drips);
  picture(dry);
  EXPECT_FALSE(ran("drips"));
  EXPECT_FALSE(ran("drips_over"));
}

TEST_F(DrawnDrips, TheSamePictureWhateverWasDrawnBefore) {
  Frame f = stage->frame(set, width, height, 1.0, 4096), other = stage->frame(set, width, height, 0.4, 4096);
  const auto first = picture(f);
  picture(other);
  EXPECT_EQ(first, picture(f));
}

// While the director changes over, each drop is drawn by one rung or the other.
TEST_F(DrawnDrips, AFadeKeepsTheMean) {
  Frame f = stage->frame(set, width, height, 1.0, 4096);
  f.techniques.set(Effect::drips, DripRung::none);
  const double off = mean(picture(f));
  f.techniques.set(Effect::drips, DripRung::streaks);
  const double streaks = mean(picture(f)) - off;
  f.techniques[Effect::drips] = {std::uint8_t(DripRung::refracting), std::uint8_t(DripRung::streaks), 0.5f};
  EXPECT_NEAR(mean(picture(f)) - off, streaks, 0.15 * std::abs(streaks));
  f.techniques[Effect::drips] = {std::uint8_t(DripRung::streaks), std::uint8_t(DripRung::none), 0.5f};
  EXPECT_NEAR(mean(picture(f)) - off, 0.5 * streaks, 0.15 * std::abs(streaks));
}

// Lightning makes drops clearer (section 3.2): the flash that makes them opaque or worse than black would be a sign
// error of 1 - l_b / 2.
TEST_F(DrawnDrips, AFlashMakesBillboardsClearerAndNeverNegative) {
  Frame f = stage->frame(set, width, height, 1.0, 4096);
  f.lights.clear();
  f.techniques.set(Effect::drips, DripRung::none);
  const auto off = picture(f);
  f.techniques.set(Effect::drips, DripRung::billboards);
  f.rain.emplace();
  double before = 1e9;
  for (const float flash : {0.0f, 0.5f, 1.0f, 2.0f, 10.0f}) {
    f.rain->layered.lightning = flash;
    const auto p = picture(f);
    double change = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i) {
      ASSERT_TRUE(std::isfinite(p[i]) && p[i] >= 0.0f);
      change += std::abs(p[i] - off[i]);
    }
    EXPECT_LE(change, before + 1e-4) << flash;
    before = change;
  }
  EXPECT_LT(before, 1e-3);
}

}  // namespace
}  // namespace petrichor::test
