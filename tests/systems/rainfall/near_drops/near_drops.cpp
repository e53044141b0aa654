// Near drops (Rana): the optics against tracing, the picture against the field's invariants (shared physics, 2 and 3).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "systems/gpu_scene.hpp"
#include "systems/drops/drop_optics.hpp"
#include "systems/rainfall/extract.hpp"
#include "systems/rainfall/near_drops/near_street.hpp"
#include "systems/rainfall/near_drops/near_truth.hpp"
#include "systems/rainfall/near_drops/passes.hpp"
#include "systems/rainfall/stage.hpp"
#include "tests/engine/platform/gl_test.hpp"

namespace petrichor {
namespace {

constexpr int width = 240, height = 136;

// Mean over the disc of a drop 2 m ahead.
glm::dvec3 disc_mean(const World& world, int interactions) {
  glm::dvec3 sum(0.0);
  constexpr int rings = 40, spokes = 24;
  for (int i = 0; i < rings; ++i)
    for (int j = 0; j < spokes; ++j) {
      const double b = std::sqrt((i + 0.5) / rings),
                   turn = 2.0 * std::numbers::pi * (j + 0.25 + 0.5 * (i & 1)) / spokes;
      sum += traced_drop(world, {0, 0, 0}, {0, 0, -200}, 1e-3, {1, 0, 0}, {0, 1, 0},
                         {b * std::cos(turn), b * std::sin(turn)}, interactions);
    }
  return sum / double(rings * spokes);
}

TEST(NearOptics, FourInteractionsLeaveLessThanAHalfPercent) {
  const World white = [](const glm::dvec3&, const glm::dvec3&) { return glm::dvec3(1.0); };
  // Shared physics, section 3: 0.0664 by the outer reflection, 0.8837 straight through, 0.0406, 0.0061; 0.32% are left.
  EXPECT_NEAR(disc_mean(white, 1).x, 0.0664, 0.002);
  EXPECT_NEAR(disc_mean(white, 2).x, 0.0664 + 0.8837, 0.002);
  EXPECT_NEAR(disc_mean(white, 3).x, 0.0664 + 0.8837 + 0.0406, 0.002);
  EXPECT_NEAR(1.0 - disc_mean(white, 4).x, 0.0032, 0.0005);
  EXPECT_NEAR(disc_mean(white, 10).x, 1.0, 0.0015);
}

TEST(NearOptics, FourInteractionsLookLikeTenOnAStreet) {  // Rana, section V
  const World street = street_world(make_near_street());
  double different = 0.0, light = 0.0;  // sums of squares
  for (int y = -8; y <= 8; ++y)
    for (int x = -8; x <= 8; ++x) {
      const glm::dvec2 at(x / 8.5, y / 8.5);
      if (glm::length(at) >= 1.0) continue;
      const auto seen = [&](int n) {
        return traced_drop(street, {0, 1.6, 0}, {0, 1.6, -2}, 1e-3, {1, 0, 0}, {0, 1, 0}, at, n).y;
      };
      const double four = seen(4), ten = seen(10);
      different += (four - ten) * (four - ten);
      light += ten * ten;
    }
  EXPECT_GT(light, 0.0);
  // 0.32% of the power is missing, most of it near the rim.
  EXPECT_LT(std::sqrt(different / light), 0.03);
}

TEST(NearOptics, BrightBottomDarkTop) {  // shared physics, section 3: sky 1, ground 0; two interactions
  const World sky = [](const glm::dvec3&, const glm::dvec3& w) { return glm::dvec3(w.y > 0.0 ? 1.0 : 0.0); };
  EXPECT_NEAR(disc_mean(sky, 2).x, 0.474, 0.01);
  double lower = 0.0, upper = 0.0;
  int count = 0;
  for (int y = 0; y < 40; ++y)
    for (int x = -40; x < 40; ++x) {
      const glm::dvec2 at((x + 0.5) / 40, (y + 0.5) / 40);
      if (glm::length(at) >= 1.0) continue;
      upper += traced_drop(sky, {0, 0, 0}, {0, 0, -200}, 1e-3, {1, 0, 0}, {0, 1, 0}, at, 2).x;
      lower += traced_drop(sky, {0, 0, 0}, {0, 0, -200}, 1e-3, {1, 0, 0}, {0, 1, 0}, {at.x, -at.y}, 2).x;
      ++count;
    }
  EXPECT_NEAR(lower / count, 0.884, 0.02);
  EXPECT_NEAR(upper / count, 0.066, 0.02);
}

class NearPicture : public test::GlTest {
 protected:
  static std::unique_ptr<RainStage> stage(const StageSet& set) {
    auto made = RainStage::make(context->device().software, set);
    EXPECT_TRUE(made) << (made ? "" : made.error().message);
    return made ? std::move(*made) : nullptr;
  }

  // Rain of 100 mm/h, so that some hundred drops are at least 0.3 px wide.
  static Frame frame(NearDropRung rung, float exposure_s = 1.0f / 60.0f, int moment = 0) {
    Frame f = stage_frame(width, height, glm::dvec3(0.0, 1.6, 0.0));
    f.camera.exposure_s = exposure_s;
    f.number = static_cast<std::uint64_t>(moment);
    f.time_s = 11.0 + 0.7 * moment;
    Emitter emitter;
    emitter.rain_mm_per_hour = 100.0f;
    emitter.maximum_drops = 400000000;
    emitter.drawn_distance_m = 6.0f;
    f.rain = make_frame_rain(emitter, start_rain_motion(emitter, {}), f.camera, width, height, f.time_s);
    f.rain->near_drops.least_width_px = 0.3f;
    f.rain->techniques.set(Effect::rainfall, RainRung::near_drops);
    f.rain->techniques.set(Effect::near_drops, rung);
    return f;
  }
};

StageSet plain(glm::vec3 wall, float distance_m = 12.0f) {
  StageSet set;
  set.present = false;
  set.wall_cd_m2 = wall;
  set.wall_distance_m = distance_m;
  set.wall_hides = true;
  set.fog = false;
  return set;
}

double mean_red(const std::vector<float>& light) {
  double sum = 0.0;
  for (std::size_t i = 0; i < light.size(); i += 4) sum += light[i];
  return sum / (static_cast<double>(light.size()) / 4.0);
}

TEST_F(NearPicture, WhiteFurnace) {
  for (const NearDropRung rung : {NearDropRung::closed_form, NearDropRung::maps})
    for (const float exposure : {1.0f / 60.0f, 1e-4f}) {
      auto s = stage(plain(glm::vec3(1.0f)));
      Frame f = frame(rung, exposure);
      f.sky.zenith_cd_m2 = f.sky.horizon_cd_m2 = glm::vec3(1.0f);
      ASSERT_TRUE(s->draw(f));
      const NearStats stats = near_stats();
      EXPECT_GT(stats.drops, 100u);
      double least = 1.0, most = 1.0;
      for (const float v : s->read_light()) least = std::min<double>(least, v), most = std::max<double>(most, v);
      // Half floats hold 1 to 0.05%. Four interactions lose 0.32% of a drop, and up to 6% of it near the rim.
      const bool rims = rung == NearDropRung::maps && exposure < 1e-3f;
      EXPECT_GE(least, 1.0 - (rims ? 0.065 : 0.008)) << static_cast<int>(rung) << " " << exposure;
      EXPECT_LE(most, 1.0 + 0.004) << static_cast<int>(rung) << " " << exposure;
      if (exposure < 1e-3f) continue;
      const NearListed listed = read_near_list();
      double sum = 0.0, count = 0.0;
      for (std::size_t i = 0; i < listed.drops.size(); ++i)
        for (int c = 0, n = static_cast<int>(listed.drops[i].place.w); c < n; ++c) {
          const double x = (2.0 * c + 1.0) / n - 1.0, chord = std::sqrt(1.0 - x * x);
          sum += chord * listed.columns[i * NEAR_COLUMNS + c].x;
          count += chord;
        }
      EXPECT_NEAR(sum / count, rung == NearDropRung::maps ? 0.9968 : 1.0, 0.0015);
    }
}

TEST_F(NearPicture, TransmittanceIsTheFields) {
  for (const float exposure : {0.25f, 1.0f / 60.0f, 1.0f / 1000.0f, 0.0f}) {
    double lost[2] = {0.0, 0.0};
    auto s = stage(plain(glm::vec3(1.0f)));
    for (int i = 0; i < 6; ++i)
      for (int which = 0; which < 2; ++which) {
        Frame f = frame(which ? NearDropRung::closed_form : NearDropRung::off, exposure, i / 2);
        f.sky.zenith_cd_m2 = f.sky.horizon_cd_m2 = glm::vec3(0.0f);
        ASSERT_TRUE(s->draw(f));
        lost[which] += 1.0 - mean_red(s->read_light());
      }
    // The same drops by other sums: only rounding differs, and the edge of small discs.
    EXPECT_NEAR(lost[1] / lost[0], 1.0, 0.02) << exposure;
  }
}

TEST_F(NearPicture, GivingWayKeepsTheMean) {
  auto s = stage(plain(glm::vec3(1.0f)));
  double lost[3] = {};
  for (int i = 0; i < 4; ++i)
    for (int k = 0; k < 3; ++k) {
      Frame f = frame(NearDropRung::closed_form, 1.0f / 60.0f, i);
      f.sky.zenith_cd_m2 = f.sky.horizon_cd_m2 = glm::vec3(0.0f);
      f.rain->techniques[Effect::rainfall] = {static_cast<std::uint8_t>(RainRung::near_drops),
                                              static_cast<std::uint8_t>(RainRung::drop_field), 0.5f * k};
      ASSERT_TRUE(s->draw(f));
      lost[k] += 1.0 - mean_red(s->read_light());
    }
  EXPECT_NEAR(lost[1] / lost[0], 1.0, 0.02);
  EXPECT_NEAR(lost[2] / lost[0], 1.0, 0.02);
}

TEST_F(NearPicture, ColumnsAreTheTruthsInAStreet) {
  const NearStreet street = make_near_street();
  const World world = street_world(street);
  GpuScene scene;
  auto s = stage(plain(glm::vec3(0.0f)));
  double errors_of[2] = {};
  for (const NearDropRung rung : {NearDropRung::closed_form, NearDropRung::maps}) {
    Frame f = frame(rung);
    enter_street(street, scene, f);
    f.rain->near_drops.map_cells = 20;
    ASSERT_TRUE(s->draw(f));
    const NearComparison c = compare_columns(world, f, read_near_list(), 30);
    ASSERT_EQ(c.drops, 30);
    errors_of[rung == NearDropRung::maps] = c.error / c.off;
    RecordProperty(rung == NearDropRung::maps ? "maps" : "closed_form", std::to_string(c.error / c.off));
    EXPECT_NEAR(c.mean / c.true_mean, 1.0, rung == NearDropRung::maps ? 0.15 : 0.06) << static_cast<int>(rung);
  }
  // What is left: 128 texels a face (0.7 degrees) and 12 to 24 samples a column; with 256 of them a tenth is left.
  EXPECT_LT(errors_of[0], 0.4);
  EXPECT_LT(errors_of[0], errors_of[1]);
}

TEST_F(NearPicture, ALampGivesDropsWhatThePhaseFunctionSays) {
  auto s = stage(plain(glm::vec3(0.0f)));
  Frame f = frame(NearDropRung::closed_form);
  f.sky.zenith_cd_m2 = f.sky.horizon_cd_m2 = glm::vec3(0.0f);
  f.camera.position_m = {0.0, 0.0, 0.0};
  FrameLight lamp{};
  lamp.position_m = {6.0f, 4.0f, -30.0f};
  lamp.direction = {0, -1, 0};
  lamp.intensity = glm::vec3(900.0f);
  lamp.range_m = 1000.0f;
  lamp.source_radius_m = 0.1f;
  lamp.kind = LIGHT_POINT;
  lamp.lights_rain = true;
  f.lights.push_back(lamp);
  ASSERT_TRUE(s->draw(f));
  const NearListed listed = read_near_list();
  const std::vector<float> phase = make_drop_phase();
  double seen = 0.0, expected = 0.0;
  for (std::size_t i = 0; i < listed.drops.size(); ++i) {
    const NearDropGpu& drop = listed.drops[i];
    const glm::vec3 place(drop.place), from_lamp = place - lamp.position_m;
    const float turn =
        std::sqrt(std::max(0.5f + 0.5f * glm::dot(glm::normalize(from_lamp), glm::normalize(place)), 0.0f));
    expected += 900.0 / glm::dot(from_lamp, from_lamp) * phase[std::min(255, static_cast<int>(turn * 256.0f))];
    double sum = 0.0, chords = 0.0;
    const int n = static_cast<int>(drop.place.w);
    for (int c = 0; c < n; ++c) {
      const double x = (2.0 * c + 1.0) / n - 1.0, chord = std::sqrt(1.0 - x * x);
      sum += chord * listed.columns[i * NEAR_COLUMNS + c].x;
      chords += chord;
    }
    seen += sum / chords;
  }
  EXPECT_GT(listed.drops.size(), 100u);
  EXPECT_NEAR(seen / expected, 1.0, 0.1);
}

TEST_F(NearPicture, TheSameBytesTwice) {
  std::vector<float> first;
  for (int i = 0; i < 2; ++i) {
    auto s = stage(plain(glm::vec3(0.3f)));
    Frame f = frame(NearDropRung::closed_form);
    f.sky.horizon_cd_m2 = glm::vec3(2.0f);
    ASSERT_TRUE(s->draw(f));
    if (i == 0)
      first = s->read_light();
    else
      EXPECT_EQ(first, s->read_light());
  }
}

TEST_F(NearPicture, NotMoreDropsThanAsked) {
  auto s = stage(plain(glm::vec3(0.3f)));
  Frame f = frame(NearDropRung::closed_form);
  f.rain->near_drops.least_width_px = 0.05f;
  f.rain->near_drops.most_drops = 300;
  const NearChoice choice = near_choice(f);
  EXPECT_GT(choice.least_width_px, 0.05f);
  EXPECT_NEAR(choice.expected, 300.0, 3.0);
  ASSERT_TRUE(s->draw(f));
  // 300 on average; those near the edges of the view and the start of their exposure come on top.
  EXPECT_GT(near_stats().drops, 200u);
  EXPECT_LT(near_stats().drops, 600u);
}

struct CameraWay {
  const char* name;
  float exposure_s;
  glm::vec3 velocity_mps, turn_radps;
  float pitch_rad;
  double spare;  // how far above the truth the bound may be: nearly exact for plain ways, a box about bent ones
};

TEST_F(NearPicture, AListHoldsAllDropsWhoseWaysTouchTheView) {
  const CameraWay ways[] = {
      {"at rest", 1.0f / 1000.0f, {}, {}, 0.0f, 1.15},        {"film", 1.0f / 48.0f, {}, {}, 0.0f, 1.15},
      {"a quarter of a second", 0.25f, {}, {}, 0.0f, 1.15},   {"looking up", 0.25f, {}, {}, 0.9f, 2.0},
      {"driving", 0.1f, {3.0f, 0.0f, -15.0f}, {}, 0.0f, 4.0}, {"turning", 0.1f, {}, {0.3f, 5.0f, 0.2f}, 0.2f, 4.0},
      {"rolling", 0.25f, {}, {0.0f, 0.0f, 4.0f}, 0.0f, 10.0}};
  auto s = stage(plain(glm::vec3(0.3f)));
  for (const CameraWay& way : ways) {
    Frame f = frame(NearDropRung::closed_form, way.exposure_s);
    f.camera.velocity_mps = way.velocity_mps;
    f.camera.angular_velocity_radps = way.turn_radps;
    f.camera.orientation = glm::angleAxis(way.pitch_rad, glm::vec3(1, 0, 0));
    f.rain->near_drops.least_width_px = 0.13f;  // as a picture of 1080 lines has a pixel wide
    f.rain->near_drops.most_drops = 1000000;
    const double expected = near_choice(f).expected;
    ASSERT_TRUE(s->draw(f));
    const NearStats stats = near_stats();
    RecordProperty(way.name, std::to_string(stats.found / expected));
    EXPECT_GT(stats.found, 1000u) << way.name;
    EXPECT_EQ(stats.found, stats.drops) << way.name;
    // Poisson's four deviations.
    EXPECT_LT(stats.found, expected + 4.0 * std::sqrt(expected)) << way.name;
    EXPECT_GT(stats.found, expected / way.spare) << way.name;
    // What the most drops stand for, too.
    f.rain->near_drops.most_drops = 800;
    EXPECT_LE(near_choice(f).expected, 801.0) << way.name;
    EXPECT_GE(near_choice(f).expected, 650.0) << way.name;
    ASSERT_TRUE(s->draw(f));
    EXPECT_LT(near_stats().found, 800 + 4.0 * std::sqrt(800.0)) << way.name;
  }
}

TEST_F(NearPicture, LongExposuresTakeAsMuchLightAsTheField) {
  // Where the list ran over, drops that the field left to it were drawn by nobody.
  auto s = stage(plain(glm::vec3(1.0f)));
  double lost[2] = {};
  for (int which = 0; which < 2; ++which) {
    Frame f = frame(which ? NearDropRung::closed_form : NearDropRung::off, 0.25f);
    f.sky.zenith_cd_m2 = f.sky.horizon_cd_m2 = glm::vec3(0.0f);
    f.camera.orientation = glm::angleAxis(0.9f, glm::vec3(1, 0, 0));
    f.rain->near_drops.least_width_px = 0.1f;
    f.rain->near_drops.most_drops = 1000000;
    ASSERT_TRUE(s->draw(f));
    lost[which] = 1.0 - mean_red(s->read_light());
  }
  EXPECT_NEAR(lost[1] / lost[0], 1.0, 0.02);
}

}  // namespace
}  // namespace petrichor
