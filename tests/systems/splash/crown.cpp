// The baked crowns.
#include "systems/splash/crown.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace petrichor {
namespace {

double cover(const std::vector<float>& picture) {
  double sum = 0.0;
  for (std::size_t i = 0; i < picture.size(); i += 4) sum += picture[i];
  return sum / (CROWN_SIDE * CROWN_SIDE);
}

TEST(Crown, RisesAndCollapses) {
  EXPECT_EQ(crown_shape(true, 0.0f).radius, 0.0f);
  EXPECT_NEAR(crown_shape(true, 0.0875f).radius / crown_shape(true, 0.35f).radius, 0.5f, 0.01f);
  EXPECT_GT(crown_shape(true, 0.4f).height, 0.5f);
  EXPECT_LT(crown_shape(true, 1.0f).height, 0.01f);
  EXPECT_LE(crown_shape(true, 1.0f).radius, 1.001f);
  EXPECT_LT(crown_shape(false, 0.4f).height, 0.2f);  // a low corona
}

TEST(Crown, PicturesStayWithinTheirFrame) {
  for (const bool film : {true, false})
    for (const float view : crown_views_deg)
      for (float phase = 0.03f; phase < 1.0f; phase += 0.12f) {
        const std::vector<float> p = crown_picture(film, view, phase);
        for (int i = 0; i < CROWN_SIDE; ++i)
          for (const int at : {i, (CROWN_SIDE - 1) * CROWN_SIDE + i, i * CROWN_SIDE, i * CROWN_SIDE + CROWN_SIDE - 1})
            ASSERT_LT(p[std::size_t(at) * 4], 0.02f) << film << " " << view << " " << phase;
        for (std::size_t i = 0; i < p.size(); ++i) ASSERT_TRUE(p[i] >= 0.0f && p[i] <= 1.0f);
        EXPECT_GT(cover(p), 0.0005) << film << " " << view << " " << phase;
        EXPECT_LT(cover(p), 0.35);
      }
}

// It is mostly clear: what is seen is its rim, its jets and its sides, not a disc.
TEST(Crown, IsARingAndNoDisc) {
  const std::vector<float> p = crown_picture(true, 80.0f, 0.35f);
  const auto at = [&](float x, float y) {
    const auto t = [](float v) { return int((v / CROWN_REACH * 0.5f + 0.5f) * CROWN_SIDE); };
    return p[(std::size_t(t(y)) * CROWN_SIDE + t(x)) * 4];
  };
  EXPECT_LT(at(0, 0), 0.05f);
  EXPECT_GT(at(0.97f, 0.1f) + at(1.02f, 0.1f) + at(1.07f, 0.1f), 0.5f);
}

TEST(Crown, LayersAreSumsFromTheStart) {
  const std::vector<std::uint16_t> all = bake_crowns();
  const std::size_t texels = std::size_t(CROWN_SIDE) * CROWN_SIDE * 4;
  ASSERT_EQ(all.size(), texels * CROWN_PHASES * CROWN_VIEWS * CROWN_KINDS);
  for (std::size_t sequence = 0; sequence < CROWN_VIEWS * CROWN_KINDS; ++sequence)
    for (std::size_t p = 1; p < CROWN_PHASES; ++p)
      for (std::size_t i = 0; i < texels; i += 37)
        ASSERT_GE(all[(sequence * CROWN_PHASES + p) * texels + i], all[(sequence * CROWN_PHASES + p - 1) * texels + i]);
}

}  // namespace
}  // namespace petrichor
