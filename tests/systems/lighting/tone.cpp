// The way from light to 8 bits.
#include "systems/image/tone.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace petrichor::tone;

TEST(Tone, CurveRisesFromBlackToWhite) {
  EXPECT_EQ(tone_map(vec3(0.0f)), vec3(0.0f));
  float last = 0.0f;
  for (int i = 1; i < 4000; ++i) {
    const float x = 1e-5f * std::pow(1.01f, static_cast<float>(i));
    const float y = tone_map(vec3(x)).x;
    if (x < 1e4f) {
      ASSERT_GE(y, last) << x;
      ASSERT_LT(y, 1.0f + 1e-6f);
    }
    last = y;
  }
  EXPECT_GT(tone_map(vec3(1000.0f)).x, 0.99f);
  EXPECT_NEAR(tone_map(vec3(0.18f)).x, 0.5f, 0.06f);  // middle grey stays in the middle
}

TEST(Tone, BrighterLightIsNeverDarkerInAnyChannel) {
  for (const vec3& hue : {vec3(1.0f, 0.1f, 0.05f), vec3(0.1f, 0.9f, 0.3f), vec3(0.1f, 0.2f, 1.0f)}) {
    vec3 last(0.0f);
    for (float strength = 0.001f; strength < 500.0f; strength *= 1.1f) {
      const vec3 now = tone_map(hue * strength);
      EXPECT_TRUE(now.x >= last.x && now.y >= last.y && now.z >= last.z) << strength;
      last = now;
    }
  }
}

TEST(Tone, NeonKeepsItsHueAndPalesOnlyWhereBright) {
  const vec3 dim = tone_map(vec3(0.4f, 0.02f, 0.01f)), bright = tone_map(vec3(40.0f, 2.0f, 1.0f));
  EXPECT_GT(dim.x, 3.0f * dim.y);
  EXPECT_GT(bright.x, bright.y);
  EXPECT_GT(bright.y / bright.x, dim.y / dim.x);
}

TEST(Tone, DitherHasNoBias) {
  // The mean over a field of pixels of round(255 (v + noise)) is 255 v: for n samples of a uniform rounding error
  // the standard error is 0.29 / sqrt(n).
  const int side = 300;
  for (const float value : {0.0121f, 0.2503f, 0.5f, 0.7777f}) {
    double sum = 0.0;
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x)
        sum += std::floor(
            255.0f * dithered(vec3(value), vec2(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f)).x + 0.5f);
    EXPECT_NEAR(sum / (side * side), 255.0 * value, 5 * 0.29 / side) << value;
  }
}

}  // namespace
