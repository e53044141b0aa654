// The rungs of the ladder of shelter: one vertical map, one tilted, several; against rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "systems/occlusion/chart.hpp"
#include "systems/occlusion/falls.hpp"
#include "systems/occlusion/occlusion.hpp"
#include "systems/occlusion/stage.hpp"
#include "systems/occlusion/street.hpp"
#include "systems/rainfall/extract.hpp"
#include "tests/engine/platform/gl_test.hpp"
#include "tests/systems/geometry/stage.hpp"

namespace petrichor::test {
namespace {

FrameRain rain_at(const Emitter& emitter, const Wind& wind, double time_s) {
  return make_frame_rain(emitter, start_rain_motion(emitter, wind), {}, 1, 1, time_s);
}

Wind wind_of(float speed_mps, bool gusts) {
  Wind wind;
  wind.velocity_mps = {speed_mps, 0, 0};
  if (gusts) wind.gust_mps = 0.3f * speed_mps, wind.swirl_mps = 0.15f * speed_mps;
  return wind;
}

class ShelterLadder : public test::GlTest {
 protected:
  void SetUp() override {
    test::GlTest::SetUp();
    if (IsSkipped()) return;
    stage = std::make_unique<OcclusionStage>();
    stage->add_placed(shelter_street());
    emitter.rain_mm_per_hour = 10.0f;
  }
  void use(OcclusionRung rung, int maps, const Wind& wind, double time_s = 3.0) {
    const auto loaded = stage->load(1024, rung == OcclusionRung::jittered ? maps : 1, {{"maps", maps}});
    ASSERT_TRUE(loaded) << loaded.error().message;
    stage->frame.techniques.set(Effect::occlusion, rung);
    stage->frame.wind = wind;
    stage->frame.rain = rain_at(emitter, wind, time_s);
  }
  std::vector<ShelterAnswer> ask(const std::vector<ShelterQuestion>& questions) {
    auto answers = stage->ask(questions);
    EXPECT_TRUE(answers) << (answers ? "" : answers.error().message);
    return answers ? *answers : std::vector<ShelterAnswer>(questions.size());
  }
  double error(const std::vector<ShelterQuestion>& places, const Wind& wind) {
    const auto answers = ask(places);
    const ShelterRays rays = stage->rays();
    const auto falls = falls_over_time(rain_at, emitter, wind, 12);
    double sum = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      double kept = 0.0;
      for (const FallTruth& f : falls)
        kept += rays.sheltered(places[i].place_m, f.velocity_mps) ? double(f.water) : 0.0;
      sum += std::pow(static_cast<double>(answers[i].shelter) - kept, 2);
    }
    return std::sqrt(sum / static_cast<double>(places.size()));
  }

  std::unique_ptr<OcclusionStage> stage;
  Emitter emitter;
};

// The mark: K = 8 under a 3 m awning in 5 m/s of wind, against rays along the falls of all drops and gusts.
TEST_F(ShelterLadder, EightMapsUnderAnAwningAreWithinATenthOfRays) {
  const Wind wind = wind_of(5.0f, true);
  const auto places = shelter_places("awning", 0.37f);
  use(OcclusionRung::vertical, 1, wind);
  const double vertical = error(places, wind);
  use(OcclusionRung::tilted, 1, wind);
  const double tilted = error(places, wind);
  use(OcclusionRung::jittered, 8, wind);
  const double jittered = error(places, wind);
  std::printf("vertical %.3f, tilted %.3f, 8 jittered %.3f\n", vertical, tilted, jittered);
  EXPECT_LT(jittered, 0.1);
  EXPECT_LT(jittered, 0.5 * tilted);
  EXPECT_LT(tilted, vertical);
}

// By height x wind / fall speed, each size of drop by its own.
TEST_F(ShelterLadder, TheDryEdgeMovesByHeightTimesWindOverFallSpeed) {
  const float wind_mps = 5.0f, height_m = awning_height_m + 0.1f, texel_m = 0.125f;  // of the roof's upper edge
  std::vector<ShelterQuestion> line;
  const auto edge = [&](float fall_mps) {  // the last dry place down the wind
    line.clear();
    for (int i = 0; i < 1200; ++i)
      line.push_back({{0.01f * static_cast<float>(i), 0.0f, 0.03f}, {0, 1, 0}, {wind_mps, -fall_mps, 0}});
    const auto answers = ask(line);
    float last = -1.0f;
    for (std::size_t i = 0; i < line.size(); ++i)
      if (answers[i].sheltered_velocity) last = line[i].place_m.x;
    return last;
  };
  const auto truth = [&](float fall_mps) { return 2.0f + height_m * wind_mps / fall_mps; };
  const float large_mps = 8.83f, small_mps = 2.06f;  // 4 mm and 0.5 mm (Gunn and Kinzer)

  use(OcclusionRung::tilted, 1, wind_of(wind_mps, false));
  const float mean_mps = -stage->frame.rain->mean_velocity_mps.y;
  EXPECT_NEAR(edge(mean_mps), truth(mean_mps), texel_m + height_m * 0.02f);
  EXPECT_GT(truth(small_mps) - edge(small_mps), 3.0f) << "one map knows one fall: small drops go too far in";

  use(OcclusionRung::jittered, 8, wind_of(wind_mps, false));
  EXPECT_LT(std::abs(truth(small_mps) - edge(small_mps)), 1.5f);  // rare in water: its map is that of 1 mm
  // The others' maps lie some half a metre of edge apart: within half of that, and a texel.
  for (const float fall : {4.03f, 5.17f, 6.49f, 7.57f, large_mps})
    EXPECT_NEAR(edge(fall), truth(fall), 0.25f + texel_m) << fall;
}

TEST_F(ShelterLadder, BridgesAndArcadesAreDryBelowAndWetOnTop) {
  for (const OcclusionRung rung : {OcclusionRung::vertical, OcclusionRung::tilted, OcclusionRung::jittered}) {
    use(rung, 8, wind_of(3.0f, true));
    const auto answers = ask({{{23.5f, 0, 28}}, {{22, 5.6f, 28}}, {{27.5f, 0, -20}}, {{26, 8, -20}}, {{-20, 0, -40}}});
    EXPECT_GT(answers[0].shelter, 0.9f) << "under the bridge";
    EXPECT_LT(answers[1].shelter, 0.1f) << "on the bridge";
    EXPECT_GT(answers[2].shelter, 0.9f) << "at the arcade's back";
    EXPECT_LT(answers[3].shelter, 0.1f) << "on its roof";
    EXPECT_EQ(answers[4].shelter, 0.0f) << "in the open";
  }
}

TEST_F(ShelterLadder, TwoStoreysAgreeWithRays) {
  const Wind wind = wind_of(5.0f, true);
  for (const char* where : {"bridge", "arcade", "house"}) {
    const auto places = shelter_places(where, 0.7f);
    use(OcclusionRung::jittered, 8, wind);
    const double jittered = error(places, wind);
    use(OcclusionRung::vertical, 1, wind);
    const double vertical = error(places, wind);
    std::printf("%s: vertical %.3f, 8 jittered %.3f\n", where, vertical, jittered);
    EXPECT_LT(jittered, 0.1) << where;
    EXPECT_LT(jittered, 0.5 * vertical) << where;
  }
}

// Chen's incline coefficient is the still-air case of the deposit; walls get what the wind brings.
TEST_F(ShelterLadder, DepositIsTheCosineInStillAirAndWallsNeedWind) {
  std::vector<ShelterQuestion> slopes;
  for (int i = 0; i < 9; ++i) {
    const float angle = glm::radians(10.0f * static_cast<float>(i));
    slopes.push_back({{-20, 3, -40}, {std::sin(angle), std::cos(angle), 0}});  // in the open
  }
  slopes.push_back({{-3, 5, -27}, {-1, 0, 0}});  // the house's wall to windward, over its awning
  slopes.push_back({{3, 5, -27}, {1, 0, 0}});    // to leeward
  use(OcclusionRung::jittered, 8, wind_of(0.0f, false));
  const auto still = ask(slopes);
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(still[i].deposit, slopes[i].normal.y, 1e-4f) << i;
  EXPECT_NEAR(still[9].deposit, 0.0f, 1e-4f);
  EXPECT_EQ(stage->redrawn(), 1) << "in still air all drops fall straight down: one map";

  const Wind wind = wind_of(4.0f, false);
  use(OcclusionRung::jittered, 8, wind);
  const auto windy = ask(slopes);
  double tilt = 0.0;  // of all water
  for (const FallTruth& f : falls_over_time(rain_at, emitter, wind, 1))
    tilt += static_cast<double>(f.water * f.velocity_mps.x / -f.velocity_mps.y);
  EXPECT_NEAR(windy[9].deposit, tilt, 0.05 * tilt);
  EXPECT_EQ(windy[10].deposit, 0.0f);
  EXPECT_NEAR(windy[10].shelter_normal, 1.0f, 1e-5f);
  EXPECT_EQ(stage->redrawn(), 8);
}

TEST_F(ShelterLadder, SnowAloneIsShelteredToo) {
  use(OcclusionRung::tilted, 1, wind_of(1.2f, false));
  stage->frame.rain.reset();
  stage->frame.snow.emplace();
  stage->frame.snow->snow_mm_per_hour = 1.0f;
  stage->frame.snow->mean_velocity_mps = {1.2f, -1.2f, 0};
  SnowClass flakes{};
  flakes.diameter_mm = 3.0f;
  flakes.fall_speed_mps = 1.2f;
  flakes.flakes_per_m3 = 100.0f;
  flakes.velocity_mps = {1.2f, -1.2f, 0.0f};
  stage->frame.snow->classes = {flakes};
  for (const OcclusionRung rung : {OcclusionRung::tilted, OcclusionRung::jittered}) {
    stage->frame.techniques.set(Effect::occlusion, rung);
    // At 45 degrees the dry patch under the roof has moved by its height.
    const auto answers = ask({{{-1.0f, 0, 0}}, {{4.0f, 0, 0}}, {{6.0f, 0, 0}}});
    EXPECT_EQ(answers[0].shelter, 0.0f);
    EXPECT_EQ(answers[1].shelter, 1.0f);
    EXPECT_EQ(answers[2].shelter, 0.0f);
  }
  stage->frame.snow->snow_mm_per_hour = 0.0f;
  EXPECT_FALSE(precipitates(stage->frame));
}

// One that draws all its maps at once every 16 m would stutter.
TEST_F(ShelterLadder, AWalkRedrawsMapsOneByOne) {
  use(OcclusionRung::jittered, 8, wind_of(4.0f, true));
  const std::vector<ShelterQuestion> place{{{0, 0, 0}}};
  ask(place);
  EXPECT_EQ(stage->redrawn(), 8);
  int most = 0, all = 0;
  for (int i = 1; i <= 640; ++i) {
    stage->frame.camera.position_m = {0.05 * i, 1.7, 0.01 * i};
    ask(place);
    most = std::max(most, stage->redrawn());
    all += stage->redrawn();
  }
  EXPECT_LE(most, 2);
  // 32 m along x and 6.4 m along z in steps of 16 m: 2.4 a map.
  EXPECT_NEAR(all, 19, 9);
}

// Gusts move single drops; maps stand for all gusts.
TEST_F(ShelterLadder, GustsRedrawNothing) {
  const Wind wind = wind_of(5.0f, true);
  for (const OcclusionRung rung : {OcclusionRung::tilted, OcclusionRung::jittered}) {
    use(rung, 8, wind);
    const std::vector<ShelterQuestion> place{{{0, 0, 0}}};
    ask(place);
    for (int i = 0; i < 60; ++i) {
      stage->frame.rain = rain_at(emitter, wind, 3.0 + 0.1 * i);
      ask(place);
      EXPECT_EQ(stage->redrawn(), 0) << i;
    }
  }
}

TEST_F(ShelterLadder, AnswersDoNotDependOnTheFramesBefore) {
  const auto places = shelter_places("awning", 0.5f);
  const auto at_last = [&](const std::vector<float>& winds) {
    use(OcclusionRung::jittered, 8, wind_of(winds.front(), true));
    std::vector<ShelterAnswer> answers;
    for (const float speed : winds) {
      stage->frame.wind = wind_of(speed, true);
      stage->frame.rain = rain_at(emitter, *stage->frame.wind, 3.0);
      stage->frame.camera.position_m.x = 2.0 * static_cast<double>(speed);
      answers = ask(places);
    }
    return answers;
  };
  const auto a = at_last({5.0f}), b = at_last({0.0f, 2.0f, 7.0f, 5.0f});
  for (std::size_t i = 0; i < places.size(); ++i) {
    ASSERT_EQ(a[i].shelter, b[i].shelter) << i;
    ASSERT_EQ(a[i].first_hit_m, b[i].first_hit_m) << i;
  }
}

TEST(ChosenFalls, StandForAllTheWaterAndItsMeanTilt) {
  Emitter emitter;
  emitter.rain_mm_per_hour = 20.0f;
  for (const bool gusts : {false, true}) {
    Frame frame;
    frame.wind = wind_of(5.0f, gusts);
    frame.rain = rain_at(emitter, *frame.wind, 1.0);
    double water = 0.0, truth = 0.0;
    for (const RainClass& c : frame.rain->classes) {
      const double here = static_cast<double>(c.drops_per_m3) * std::pow(c.diameter_mm, 3) * c.fall_speed_mps;
      water += here, truth += here * 5.0 / c.fall_speed_mps;
    }
    truth /= water;
    for (const int count : {1, 2, 4, 8, 16}) {
      const auto falls = chosen_falls(frame, count);
      ASSERT_LE(static_cast<int>(falls.size()), count);
      if (gusts || count <= 8) {  // without gusts there are no more directions than classes
        ASSERT_EQ(static_cast<int>(falls.size()), count);
      }
      double share = 0.0, tilt = 0.0;
      float before = -1e9f;
      for (const FallShare& f : falls) {
        const float here = f.velocity_mps.x / -f.velocity_mps.y;
        EXPECT_GE(here, before);
        EXPECT_GT(f.share, 0.0f);
        before = here;
        share += static_cast<double>(f.share), tilt += static_cast<double>(f.share * here);
      }
      EXPECT_NEAR(share, 1.0, 1e-5);
      if (count >= 8) {
        EXPECT_NEAR(tilt, truth, 0.05 * truth) << count << gusts;
      }
    }
  }
}

TEST(ChosenFalls, StandOnEitherSideOfASwirlingWind) {
  Emitter emitter;
  emitter.rain_mm_per_hour = 10.0f;
  Frame frame;
  frame.wind = wind_of(4.0f, true);
  frame.wind->swirl_mps = 2.0f;
  frame.rain = rain_at(emitter, *frame.wind, 1.0);
  float left = 0.0f, right = 0.0f;
  for (const FallShare& f : chosen_falls(frame, 8)) (f.velocity_mps.z < 0.0f ? left : right) += f.share;
  EXPECT_NEAR(left, right, 0.3f);
  EXPECT_GT(std::min(left, right), 0.25f);
}

}  // namespace
}  // namespace petrichor::test
