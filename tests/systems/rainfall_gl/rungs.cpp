// All rungs of the ladder draw the same rain.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "systems/rainfall/ladders.hpp"
#include "systems/rainfall/studio.hpp"
#include "tests/engine/platform/gl_test.hpp"

namespace petrichor {
namespace {

class RainRungs : public test::OnGl<testing::TestWithParam<int>> {};

// A white wall and drops that shine with nothing: the picture is the transmittance.
StudioScene white_wall(float distance_m, float rate) {
  StudioScene scene = day_street();
  scene.rain_mm_per_hour = rate;
  scene.wall_cd_m2 = glm::vec3(1000.0f);
  scene.wall_distance_m = distance_m;
  scene.sky_cd_m2 = 0.0f;
  scene.camera_velocity_mps = {0.4f, 0.0f, -1.0f};
  return scene;
}

double mean_of(Studio& studio, const Studio::Cast& cast, int frames) {
  studio.begin(cast);
  double sum = 0.0;
  for (int i = 0; i < frames; ++i) {
    Frame frame = studio.frame(2.0 + 0.41 * i);
    const auto picture = studio.draw(frame);
    EXPECT_TRUE(picture) << (picture ? "" : picture.error().message);
    if (!picture) return 0.0;
    for (const float v : *picture) sum += v;
  }
  return sum / (double(frames) * studio.width() * studio.height());
}

TEST_P(RainRungs, SameMeanAsFogAloneAtAnyDistance) {
  const auto rung = static_cast<RainRung>(GetParam());
  for (const auto& [wall_m, rate] : {std::pair{3.0f, 100.0f}, std::pair{12.0f, 10.0f}, std::pair{40.0f, 50.0f}}) {
    auto studio = Studio::make(true, white_wall(wall_m, rate), 160, 90);
    ASSERT_TRUE(studio) << studio.error().message;
    Studio::Cast cast = (*studio)->cast();
    cast.emitter.maximum_drops = 30'000;
    cast.techniques.set(Effect::rainfall, RainRung::fog);
    const double fog = mean_of(**studio, cast, 1);
    cast.techniques.set(Effect::rainfall, RainRung::fog);
    cast.emitter.rain_mm_per_hour = 0.0f;
    const double dry = mean_of(**studio, cast, 1);
    ASSERT_LT(fog, 0.999 * dry) << "no rain, no test";
    cast = (*studio)->cast();
    cast.emitter.maximum_drops = 30'000;
    cast.techniques.set(Effect::rainfall, rung);
    // 0.5% of the background (issue 3), and a quarter of what the rain takes: near a wall that is a few large drops.
    const double bound = std::min(0.005, 0.25 * (1.0 - fog / dry) + 0.0005);
    EXPECT_NEAR(mean_of(**studio, cast, 8) / dry, fog / dry, bound) << wall_m << " m, " << rate << " mm/h";
    // And while it takes over from the drop field.
    cast.techniques[Effect::rainfall] = {static_cast<std::uint8_t>(rung),
                                         static_cast<std::uint8_t>(RainRung::drop_field), 0.4f};
    EXPECT_NEAR(mean_of(**studio, cast, 8) / dry, fog / dry, bound) << "half, " << wall_m << " m, " << rate << " mm/h";
  }
}

TEST_P(RainRungs, DrawsSomethingThatMoves) {
  auto studio = Studio::make(true, night_lamps(), 160, 90);
  ASSERT_TRUE(studio) << studio.error().message;
  Studio::Cast cast = (*studio)->cast();
  cast.emitter.maximum_drops = 30'000;
  cast.techniques.set(Effect::rainfall, static_cast<RainRung>(GetParam()));
  (*studio)->begin(cast);
  Frame first = (*studio)->frame(1.0);
  const auto a = (*studio)->draw(first);
  Frame second = (*studio)->frame(1.0 + 1.0 / 60.0);
  const auto b = (*studio)->draw(second);
  ASSERT_TRUE(a && b);
  int changed = 0;
  for (std::size_t i = 0; i < a->size(); ++i) {
    ASSERT_TRUE(std::isfinite((*a)[i]) && (*a)[i] >= 0.0f);
    changed += std::abs((*a)[i] - (*b)[i]) > 1e-3f * (*a)[i];
  }
  const bool fog = GetParam() == static_cast<int>(RainRung::fog);
  EXPECT_TRUE(fog ? changed == 0 : changed > 200) << changed;
}

std::string rung_name(const testing::TestParamInfo<int>& info) {
  return std::string(rainfall_ladder().rungs[std::size_t(info.param)].name);
}
INSTANTIATE_TEST_SUITE_P(Ladder, RainRungs, testing::Range(0, static_cast<int>(RainRung::count)), rung_name);

TEST(Ladders, NameEveryRungInTheOrderOfItsEnum) {
  const auto expect = [](const Ladder& ladder, std::vector<std::string_view> names) {
    ASSERT_EQ(ladder.rungs.size(), names.size()) << ladder.name;
    for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(ladder.rungs[i].name, names[i]);
    EXPECT_FALSE(ladder.truth.empty() || ladder.error_measure.empty() || !ladder.coverage);
  };
  expect(rainfall_ladder(), {"fog", "double_cone", "composite", "sprites", "drop_field", "full_field", "near_drops"});
  expect(snow_ladder(), {"fog", "double_cone", "field"});
  expect(streaks_ladder(), {"even", "nearest", "table"});
  expect(near_drops_ladder(), {"off", "maps", "closed_form"});
}

}  // namespace
}  // namespace petrichor
