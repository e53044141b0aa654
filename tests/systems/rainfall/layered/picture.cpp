// The layered composite as it is drawn: the mean of the rain that it stands for, and the artist's controls.
#include <numeric>

#include "tests/systems/rainfall/layered/bench_layered.hpp"

namespace petrichor {
namespace {

TEST_F(LayeredTest, MeanTransmittanceIsThatOfFogAtEveryDistanceAndRate) {
  for (const float wall_m : {2.0f, 5.0f, 10.0f, 20.0f, 60.0f}) {
    StageSet set = white_wall(wall_m);
    set.layered_shells = wall_m == 5.0f || wall_m == 20.0f ? 3 : 4;  // as on software OpenGL, and as on GPUs
    const auto s = stage(set);
    for (const float rate : {1.0f, 10.0f, 100.0f}) {
      double sum = 0.0, truth = 0.0;
      constexpr int frames = 6;
      for (int i = 0; i < frames; ++i) {
        Frame frame = layered_camera();
        frame.time_s = 3.0 + 1.37 * i;
        layered_on(frame, layered_rain(rate));
        sum += mean_of(light_of(*s, frame)) / frames;
        truth = wall_transmittance(frame.rain->extinction_per_m, wall_m, frame);
      }
      // The issue asks for 0.5% of the background. Most of what rain takes at a few metres is less than that: so also
      // within 8% of what it takes, which the drops of six frames may stray by, and the picture's half floats, which
      // llvmpipe cuts off: 2^-11 in each of two passes.
      EXPECT_NEAR(sum, truth, 0.005) << wall_m << " m, " << rate << " mm/h";
      EXPECT_NEAR(1.0 - sum, 1.0 - truth, 0.08 * (1.0 - truth) + 1e-3) << wall_m << " m, " << rate << " mm/h";
    }
  }
}

TEST_F(LayeredTest, SameFrameSameBytesWhateverCameBefore) {
  const auto s = stage(white_wall(12.0f)), fresh = stage(white_wall(12.0f));
  const auto draw = [](RainStage& on, double time_s, float exposure_s) {
    Frame frame = layered_camera();
    frame.time_s = time_s;
    frame.camera.exposure_s = exposure_s;
    layered_on(frame, layered_rain(30.0f));
    return light_of(on, frame);
  };
  const auto first = draw(*s, 5.0, 1.0f / 60);
  EXPECT_NE(draw(*s, 5.02, 1.0f / 60), first);
  draw(*s, 5.0, 0.2f);  // taller cells, another placement
  EXPECT_EQ(draw(*s, 5.0, 1.0f / 60), first);
  EXPECT_EQ(draw(*fresh, 5.0, 1.0f / 60), first);
}

// 1 - transmittance before a wall at 15 m, the mean of some frames. `strength` multiplies it out of the half floats.
double dimming(RainStage& s, float rate, const LayeredComposite& settings, const Techniques* techniques = nullptr) {
  double sum = 0.0;
  for (int i = 0; i < 4; ++i) {
    Frame frame = layered_camera();
    frame.time_s = 3.0 + 0.77 * i;
    layered_on(frame, layered_rain(rate), settings);
    if (techniques) frame.rain->techniques = *techniques;
    sum += 0.25 * (1.0 - mean_of(light_of(s, frame)));
  }
  return sum;
}

TEST_F(LayeredTest, SharesWithTheFogAddUp) {
  const auto s = stage(white_wall(15.0f));
  Techniques half;
  half[Effect::rainfall] = {std::uint8_t(RainRung::composite), std::uint8_t(RainRung::fog), 0.5f};
  const double whole = dimming(*s, 80.0f, {});
  EXPECT_NEAR(dimming(*s, 80.0f, {}, &half), whole, 0.05 * whole + 1e-3);
}

TEST_F(LayeredTest, StrengthMultipliesOpacity) {
  StageSet set = white_wall(15.0f);
  set.fog = false;
  const auto s = stage(set);
  LayeredComposite settings;
  const double once = dimming(*s, 30.0f, settings);
  settings.strength = 2.0f;
  EXPECT_NEAR(dimming(*s, 30.0f, settings), 2.0 * once, 0.1 * once + 1e-3);
  settings.strength = 0.0f;
  EXPECT_NEAR(dimming(*s, 30.0f, settings), 0.0, 1e-3);
}

// Mean light of drops before darkness, under an even blueish sky.
glm::dvec3 shine(RainStage& s, const LayeredComposite& settings) {
  Frame frame = layered_camera();
  frame.sky.zenith_cd_m2 = frame.sky.horizon_cd_m2 = {1.0f, 1.5f, 2.0f};
  layered_on(frame, layered_rain(30.0f), settings);
  const auto light = light_of(s, frame);
  return {mean_of(light, 0), mean_of(light, 1), mean_of(light, 2)};
}

TEST_F(LayeredTest, LightningBiasesOpacityAndLight) {
  // l_b = 1 + k_c (L_1 + L_2) multiplies the opacity, and reflection and refraction with it: light goes with its
  // square.
  StageSet set = white_wall(15.0f);
  set.fog = false;
  const auto wall = stage(set);
  set.wall_cd_m2 = glm::vec3(0.0f);
  const auto dark = stage(set);
  for (const bool published : {false, true}) {
    LayeredComposite calm, flash;
    calm.published = flash.published = published;
    calm.lightning_1 = 3.0f;
    calm.rain_contrast = 0.0f;  // k_c: nothing happens
    flash.rain_contrast = 0.5f;
    flash.lightning_1 = 1.5f;
    flash.lightning_2 = 0.5f;  // l_b = 2
    const double before = dimming(*wall, 30.0f, calm);
    EXPECT_NEAR(dimming(*wall, 30.0f, flash), 2.0 * before, 0.12 * before + 1e-3) << published;
    const glm::dvec3 dim = shine(*dark, calm), bright = shine(*dark, flash);
    ASSERT_GT(dim.g, 0.0);
    EXPECT_NEAR(bright.g / dim.g, 4.0, 0.25) << published;
  }
}

TEST_F(LayeredTest, MilkWhitensAndBrightens) {
  StageSet set = white_wall(15.0f);
  set.fog = false;
  set.wall_cd_m2 = glm::vec3(0.0f);
  const auto s = stage(set);
  LayeredComposite none, some;
  some.milk = 0.5f;
  const glm::dvec3 clear = shine(*s, none), milky = shine(*s, some);
  EXPECT_NEAR(clear.b / clear.r, 2.0, 0.05);  // the sky's own colour, as true drops show it
  EXPECT_GT(milky.r, clear.r);
  EXPECT_LT(milky.b / milky.r, 1.6);
  EXPECT_GT(milky.b / milky.r, 1.0);
}

TEST_F(LayeredTest, NothingFallsUnderARoof) {
  StageSet set = white_wall(15.0f);
  set.fog = false;
  set.map = true;
  set.roof_m = 4.0f;  // over all places with x < 0
  const auto s = stage(set);
  Frame frame = layered_camera();
  layered_on(frame, layered_rain(100.0f));
  const auto light = light_of(*s, frame);
  double left = 0.0, right = 0.0;
  for (int y = 0; y < frame.height / 2; ++y)  // below the roof's height
    for (int x = 0; x < frame.width; ++x) {
      const double dim = 1.0 - light[(std::size_t(y) * frame.width + x) * 4];
      if (x < frame.width / 2 - 12) left += dim;
      if (x > frame.width / 2 + 12) right += dim;
    }
  EXPECT_GT(right, 100.0 * 0.01);
  EXPECT_LT(left, 0.02 * right);
}

// Deviation of blocks of 8 x 8 pixels from their mean over time, the same for all blocks.
double block_deviation(RainStage& s, bool field) {
  constexpr int frames = 12, block = 8;
  std::vector<double> sum, squares;
  for (int i = 0; i < frames; ++i) {
    Frame frame = layered_camera(160, 88);
    frame.time_s = 3.0 + 0.77 * i;
    frame.number = std::uint64_t(i);
    Emitter emitter = layered_rain(30.0f);
    emitter.maximum_drops = 100'000'000;
    emitter.drawn_distance_m = 12.0f;
    layered_on(frame, emitter);
    if (field) frame.rain->techniques.set(Effect::rainfall, RainRung::full_field);
    const auto light = light_of(s, frame);
    const int across = frame.width / block, up = frame.height / block;
    sum.resize(std::size_t(across) * up), squares.resize(sum.size());
    for (int b = 0; b < across * up; ++b) {
      double mean = 0.0;
      for (int p = 0; p < block * block; ++p)
        mean += light[(std::size_t(b / across * block + p / block) * frame.width + b % across * block + p % block) * 4];
      mean /= block * block;
      sum[b] += mean, squares[b] += mean * mean;
    }
  }
  double variance = 0.0;
  for (std::size_t b = 0; b < sum.size(); ++b)
    variance += (squares[b] - sum[b] * sum[b] / frames) / (frames - 1) / double(sum.size());
  return std::sqrt(variance);
}

TEST_F(LayeredTest, DeviatesAsTheFieldDoes) {
  // The drop that stands for all has the second and the fourth moment of their sizes, so blocks of pixels deviate as
  // those of real drops: within a third, which the few drops nearest to the eye may make.
  StageSet set = white_wall(11.0f);
  const double truth = block_deviation(*stage(set), true);
  for (const int shells : {3, 4}) {
    set.layered_shells = shells;
    EXPECT_NEAR(block_deviation(*stage(set), false) / truth, 1.0, 0.33) << shells;
  }
}

}  // namespace
}  // namespace petrichor
