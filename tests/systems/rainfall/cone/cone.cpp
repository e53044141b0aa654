// The cone's textures and its geometry, without a picture.
#include "systems/rainfall/cone/cone.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "systems/rainfall/extract.hpp"
#include "systems/rainfall/snow/extract.hpp"

namespace petrichor {
namespace {

constexpr int size = cone_texture_size;

class ConeTextures : public testing::TestWithParam<ConeTexture> {
 protected:
  // Mean difference of a channel's texels between two rows, or two columns.
  static double between(const ConeTile& tile, int channel, int a, int b, bool rows) {
    double sum = 0.0;
    for (int i = 0; i < size; ++i) {
      const auto at = [&](int k) {
        const std::size_t texel = rows ? std::size_t(k) * size + i : std::size_t(i) * size + k;
        return double(tile.levels[0][texel * cone_channels + channel]);
      };
      sum += std::abs(at(a) - at(b)) / size;
    }
    return sum;
  }
};

TEST_P(ConeTextures, Tile) {
  // The last row goes on into the first as any row into the next; at the sides nothing is cut.
  const ConeTextureSet set = make_cone_textures(GetParam());
  for (const ConeTile& tile : set.tiles)
    for (const bool rows : {true, false}) {
      double mean = 0.0, most = 0.0;
      for (int k = 0; k + 1 < size; k += 7) {
        const double d = between(tile, cone_channels - 1, k, k + 1, rows);
        mean += d / ((size - 1 + 6) / 7);
        most = std::max(most, d);
      }
      const double seam = between(tile, cone_channels - 1, size - 1, 0, rows);
      EXPECT_LE(seam, 1.25 * most) << rows;
      if (rows) EXPECT_GE(seam, 0.4 * mean);
    }
}

TEST_P(ConeTextures, KeepTheirMeanAtEveryLevelOfDetail) {
  const ConeTextureSet set = make_cone_textures(GetParam());
  for (const ConeTile& tile : set.tiles) {
    ASSERT_EQ(tile.levels.size(), std::size_t(cone_texture_levels));
    for (int c = 0; c < cone_channels; ++c) {
      EXPECT_GT(tile.mean[0][c], 0.3f);  // of 255: else 8 bits hold nothing
      // Rounding by chance: its deviation is under half a step over the root of the texels.
      for (int level = 1; level < cone_texture_levels; ++level)
        EXPECT_NEAR(tile.mean[level][c], tile.mean[0][c], 4.0 * 0.5 / double(size >> level)) << level << " " << c;
    }
  }
}

TEST_P(ConeTextures, ShowMoreStreaksChannelByChannel) {
  // Every streak of a channel is in the next, which has four times as many.
  const ConeTextureSet set = make_cone_textures(GetParam());
  const ConeTile& tile = set.tiles[0];
  std::array<double, cone_channels> lit{};
  int lost = 0;
  for (std::size_t i = 0; i < tile.levels[0].size(); i += cone_channels)
    for (int c = 0; c < cone_channels; ++c) {
      lit[c] += tile.levels[0][i + c] > 0;
      // What saturates nearly in one may be faint in the next, but it is there.
      if (c > 0 && tile.levels[0][i + c - 1] > 200 && tile.levels[0][i + c] == 0) ++lost;
    }
  EXPECT_LT(lost, 20);
  for (int c = 1; c < cone_channels; ++c) EXPECT_GT(lit[c], 1.3 * lit[c - 1]) << c;
}

TEST_P(ConeTextures, RepeatNothingWithinATile) {
  // A tile moved along itself looks like itself again only after its whole length: what the eye follows is one motion
  // (else wagon wheels turn back). Correlation of rows summed over 16 columns, at shifts beyond a streak's own length.
  const ConeTextureSet set = make_cone_textures(GetParam());
  const ConeTile& tile = set.tiles[1];
  std::vector<double> value(std::size_t(size) * size);
  double mean = 0.0, square = 0.0;
  for (std::size_t i = 0; i < value.size(); ++i)
    mean += (value[i] = tile.levels[0][i * cone_channels + 2]) / double(value.size());
  for (double& v : value) v -= mean, square += v * v;
  for (int shift = 96; shift <= size / 2; shift += 16) {
    double sum = 0.0;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        sum += value[std::size_t(y) * size + x] * value[std::size_t((y + shift) % size) * size + x];
    EXPECT_LT(sum / square, 0.25) << shift;
  }
}

TEST_P(ConeTextures, AreTheSameEveryTime) {
  const ConeTextureSet a = make_cone_textures(GetParam()), b = make_cone_textures(GetParam()),
                       c = make_cone_textures(GetParam(), 2);
  for (int i = 0; i < cone_layers; ++i) {
    EXPECT_EQ(a.tiles[i].levels, b.tiles[i].levels);
    EXPECT_NE(a.tiles[i].levels[0], c.tiles[i].levels[0]);
  }
}

INSTANTIATE_TEST_SUITE_P(All, ConeTextures,
                         testing::Values(ConeTexture::drizzle, ConeTexture::rain, ConeTexture::snow_fine,
                                         ConeTexture::snow_coarse));

TEST(DoubleCone, MovesItsTextureAsTheFormulasSay) {
  // By differences of where the ray at angle psi meets the cone, g = cos psi / (sin psi + slope cos psi) radii along.
  const auto g = [](double psi) { return std::cos(psi) / (std::sin(psi) + cone_slope * std::cos(psi)); };
  for (double deg = 20.0; deg <= 90.0; deg += 5.0) {
    const double psi = deg * M_PI / 180.0, h = 1e-5;
    const double radians_per_radius = 2.0 * h / (g(psi - h) - g(psi + h));  // of what moves with the texture
    // A drop at distance r: sin psi radians a radius.
    EXPECT_NEAR(radians_per_radius / std::sin(psi), cone_speed_ratio(psi), 1e-3 * cone_speed_ratio(psi)) << deg;
    EXPECT_NEAR(cone_speed_ratio(psi), 1.0, 0.125) << deg;
    // A drop at the cone's surface, 1 / (sin psi + slope cos psi) radii away.
    const double at_surface = std::sin(psi) * (std::sin(psi) + cone_slope * std::cos(psi));
    EXPECT_NEAR(radians_per_radius / at_surface, cone_surface_speed_ratio(psi), 1e-3 * cone_surface_speed_ratio(psi))
        << deg;
  }
}

TEST(DoubleCone, PublishedElongationIsEquation2) {
  // Shared physics 13 (d)(i): S = S_f = C = 1, 8 m/s, at 60 and 15 frames a second.
  EXPECT_NEAR(published_elongation(1.0, 1.0, 1.0, 8.0 / 60.0), 0.88, 0.005);
  EXPECT_NEAR(published_elongation(1.0, 1.0, 1.0, 8.0 / 15.0), 0.65, 0.005);
  EXPECT_NEAR(published_elongation(3.0, 0.5, 2.0, 4.0), 3.0 / (0.5 * (2.0 * 0.5 * 4.0 + 3.0)), 1e-12);
}

// A second of ticks with some settings.
FrameCone cone_after(const DoubleCone& set, const glm::vec3& camera_mps, double time_s = 1.0) {
  ConeFlow flow;
  flow.camera_mps = camera_mps;
  ConeTrack track;
  for (int tick = 0; tick <= std::lround(time_s * 120.0); ++tick) advance_cone(track, set, flow, tick / 120.0);
  return frame_cone(track, set, flow, glm::vec3(0.0f), 1.0f / 60.0f, time_s);
}

TEST(DoubleCone, CameraDampingTiltsTheAxisByItsShare) {  // C_f of eq. 1
  for (const float damping : {0.0f, 0.4f, 1.0f, 1.5f}) {
    DoubleCone set;
    set.camera_damping = damping;
    const FrameCone cone = cone_after(set, {8.0f, 0.0f, 0.0f});
    const glm::vec3 expected = glm::normalize(glm::vec3(-8.0f * damping, -6.5f, 0.0f));
    EXPECT_LT(glm::length(cone.axis - expected), 1e-4f) << damping;
    EXPECT_NEAR(glm::dot(cone.axis, cone.side), 0.0f, 1e-5f);
  }
}

TEST(DoubleCone, ScrollSpeedAndStreakLengthDoWhatTheySay) {  // D_precip of eq. 3, and S_streak
  const FrameCone plain = cone_after({}, {}, 0.05);
  DoubleCone fast, longer;
  fast.scroll_speed = 2.0f;
  longer.streak_length = 2.0f;
  const FrameCone twice = cone_after(fast, {}, 0.05), drawn_out = cone_after(longer, {}, 0.05);
  for (int i = 0; i < cone_layers; ++i) {
    const ConeLayer& l = cone_layout(false)[i];
    // 0.05 s of rain at 6.5 m/s, in tiles.
    EXPECT_NEAR(plain.phase[i] * plain.elongation[i] * l.tile_m, 0.325, 1e-4) << i;
    EXPECT_NEAR(twice.phase[i], 2.0f * plain.phase[i], 1e-5) << i;
    EXPECT_EQ(twice.elongation[i], plain.elongation[i]);
    EXPECT_NEAR(drawn_out.elongation[i] / plain.elongation[i], 2.0, 0.05) << i;  // less by the drops' own width
    // Drawn out, it falls no faster.
    EXPECT_NEAR(drawn_out.phase[i] * drawn_out.elongation[i], plain.phase[i] * plain.elongation[i], 1e-5) << i;
  }
}

TEST(DoubleCone, ParallaxSetsTheLayersApart) {  // S_f
  const auto& layout = cone_layout(false);
  const FrameCone plain = cone_after({}, {}, 0.05);
  for (const float parallax : {0.0f, 0.5f, 1.0f, 2.0f}) {
    DoubleCone set;
    set.parallax = parallax;
    const FrameCone cone = cone_after(set, {}, 0.05);
    set.published = true;
    const FrameCone printed = cone_after(set, {}, 0.05);
    for (int i = 0; i < cone_layers; ++i) {
      const double seen_m = layout[0].radius_m + parallax * (layout[i].radius_m - layout[0].radius_m);
      EXPECT_NEAR(cone.farther[i], seen_m / layout[i].radius_m, 1e-6) << i;
      // 0.05 s of rain at 6.5 m/s moves as many radians as at that distance.
      const double moved_rad =
          cone.phase[i] * cone.elongation[i] * layout[i].tile_m / (layout[i].radius_m * cone.farther[i]);
      EXPECT_NEAR(moved_rad, 0.325 / seen_m, 1e-3 / seen_m) << i;
      EXPECT_EQ(cone.elongation[i], plain.elongation[i]);
      // Eq. 2: 1 / (S_f E) = 1 + C_pixel S_f Vec_precip / S_streak, S_f 1 for the first layer.
      EXPECT_EQ(printed.farther[i], cone.farther[i]);
      EXPECT_NEAR((printed.elongation[i] - 1.0f) / (printed.elongation[0] - 1.0f), layout[0].radius_m / seen_m, 1e-5)
          << i;
    }
  }
}

TEST(DoubleCone, FollowsTheSnowOfWhoSnows) {
  // An emitter that does not snow is no answer while another entity does.
  Registry registry;
  const Entity rain = registry.create(), snow = registry.create();
  registry.emplace<Emitter>(rain);
  registry.emplace<Snowfall>(rain);
  Snowfall falling;
  falling.snow_mm_per_hour = 2.0f;
  registry.emplace<Snowfall>(snow, falling);
  for (int tick = 0; tick <= 12; ++tick) {
    simulate_rainfall(registry, tick / 120.0);
    simulate_snowfall(registry, tick / 120.0);
    simulate_cone(registry, tick / 120.0, 1.0 / 120.0);
  }
  const ConeMotion* motion = registry.find<ConeMotion>(rain);
  ASSERT_TRUE(motion);
  EXPECT_DOUBLE_EQ(motion->snow.time_s, 0.1);
  Frame frame;
  extract_snowfall(registry, frame, 0.1);
  ASSERT_TRUE(frame.snow);
  extract_cone(registry, frame, 0.1);
  for (int i = 0; i < cone_layers; ++i) EXPECT_NEAR(frame.snow->cone.phase[i], motion->snow.phase[i], 1e-6) << i;
}

TEST(DoubleCone, TexturesFollowTheRate) {
  EXPECT_EQ(cone_kinds(ConeTexture::automatic, 0.5f, false).first, ConeTexture::drizzle);
  EXPECT_EQ(cone_kinds(ConeTexture::automatic, 30.0f, false).first, ConeTexture::rain);
  const ConeKinds between = cone_kinds(ConeTexture::automatic, 3.873f, false);
  EXPECT_EQ(between.first, ConeTexture::drizzle);
  EXPECT_EQ(between.second, ConeTexture::rain);
  EXPECT_NEAR(between.second_share, 0.5f, 1e-3f);
  EXPECT_EQ(cone_kinds(ConeTexture::snow_fine, 30.0f, false).first, ConeTexture::snow_fine);
  EXPECT_EQ(cone_kinds(ConeTexture::automatic, 9.0f, true).first, ConeTexture::snow_coarse);
}

}  // namespace
}  // namespace petrichor
