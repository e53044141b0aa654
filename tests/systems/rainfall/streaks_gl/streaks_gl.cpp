// The streak table on the GPU, and the bands that the drop field draws with it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "engine/core/random.hpp"
#include "systems/rainfall/extract.hpp"
#include "systems/rainfall/stage.hpp"
#include "systems/rainfall/streaks/bake.hpp"
#include "systems/rainfall/streaks/gpu.hpp"
#include "tests/engine/platform/gl_test.hpp"

namespace petrichor {
namespace {

class Streaks : public test::GlTest {
 protected:
  static void SetUpTestSuite() {
    StreakBake bake;
    bake.grid = {5, 5, 5};
    bake.along = 16;
    bake.oscillations = 4;
    bake.rays = 1500;
    table = std::make_shared<const StreakTable>(bake_streaks(bake));
  }
  static void TearDownTestSuite() { use_streak_table(nullptr); }

  inline static std::shared_ptr<const StreakTable> table;
};

TEST_F(Streaks, ReadTheSameOnGpuAndCpu) {
  constexpr unsigned count = 512;
  struct Ask {
    glm::vec4 angles_across, along_oscillation;
  };
  std::vector<Ask> asks;
  for (unsigned i = 0; i < count; ++i) {
    const glm::vec4 a = random_float4(glm::uvec4(i, 1u, 1u, 1u)), b = random_float4(glm::uvec4(i, 2u, 1u, 1u));
    constexpr float pi = std::numbers::pi_v<float>;
    asks.push_back({{pi * (a.x - 0.5f), pi * (a.y - 0.5f), pi * a.z, 2.0f * a.w - 1.0f},
                    {8.0f * b.x - 4.0f, 3.0f * b.y - 1.0f, 0.0f, 0.0f}});
  }
  const Buffer in = make_buffer(asks.size() * sizeof(Ask), asks.data()), out = make_buffer(count * 16);
  ShaderLibrary library;
  const auto program = library.load({{PETRICHOR_SOURCE_DIR "/tests/systems/rainfall/streaks_gl/ask.comp.glsl"}, {}});
  ASSERT_TRUE(program) << program.error().message;
  for (const StreakRung rung : {StreakRung::even, StreakRung::nearest, StreakRung::table}) {
    Frame frame;
    frame.techniques.set(Effect::streaks, rung);
    use_streak_table(table);
    RainOptics optics;
    (*program)->use();
    EXPECT_EQ(bind_streak_table(optics, frame, **program), rung != StreakRung::even);
    (*program)->set("count", count);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, in.id);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, out.id);
    (*program)->dispatch(count);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    std::vector<glm::vec4> answers(count);
    read_buffer(out, answers.data(), count * 16);
    const bool four = rung == StreakRung::nearest;
    int outliers = 0;
    for (unsigned i = 0; i < count; ++i) {
      const glm::vec4& a = asks[i].angles_across;
      const StreakAngles angles{a.x, a.y, a.z};
      const glm::vec4& at = asks[i].along_oscillation;
      glm::dvec3 expected(1.0, 1.0, 0.5);
      if (rung != StreakRung::even)
        expected = {streak_modulation(*table, angles, at.x, at.y, four), streak_profile(*table, angles, a.w, four),
                    streak_phase(*table, angles, four)};
      // Filters of GPUs go by 256ths of the way between two texels.
      EXPECT_NEAR(answers[i].x, expected.x, 0.02 + 0.01 * expected.x) << i;
      EXPECT_NEAR(answers[i].y, expected.y, 0.02 + 0.01 * expected.y) << i;
      // A bin of the phase function more or less, where single precision meets its edge: few.
      outliers += std::abs(answers[i].z - expected.z) > 1e-4 + 1e-3 * expected.z;
    }
    EXPECT_LE(outliers, 3);
  }
  use_streak_table(nullptr);
}

struct Seen {
  double mean = 0.0, deviation = 0.0;
};

// Near rain before one lamp at the eye's side, which makes the strongest bands, in the dark.
Seen look(RainStage& stage, StreakRung rung, int frames) {
  Emitter emitter;
  emitter.rain_mm_per_hour = 60.0f;
  emitter.maximum_drops = 20000;
  emitter.drawn_distance_m = 5.0f;
  const WindMotion motion = start_rain_motion(emitter, {});
  Seen seen;
  double count = 0.0, squares = 0.0;
  for (int i = 0; i < frames; ++i) {
    Frame frame = stage_frame(320, 180, glm::dvec3(0.0, 1.7, 0.0));
    frame.camera.vertical_fov_rad = glm::radians(25.0f);
    frame.camera.exposure_ev100 = 0.0f;
    frame.sky.zenith_cd_m2 = frame.sky.horizon_cd_m2 = glm::vec3(0.0f);
    frame.techniques.set(Effect::streaks, rung);
    FrameLight light{};
    light.position_m = {1.0f, 2.5f, 1.0f};
    light.direction = {0.0f, -1.0f, 0.0f};
    light.intensity = glm::vec3(60000.0f);
    light.kind = LIGHT_POINT;
    light.lights_rain = true;
    frame.lights.push_back(light);
    frame.time_s = 5.0 + 0.7 * i;
    frame.number = std::uint64_t(i) + 1;
    frame.rain = make_frame_rain(emitter, motion, frame.camera, frame.width, frame.height, frame.time_s);
    const auto drawn = stage.draw(frame);
    EXPECT_TRUE(drawn) << (drawn ? "" : drawn.error().message);
    const std::vector<float> picture = stage.read_light();
    for (std::size_t p = 0; p < picture.size(); p += 4) {
      EXPECT_TRUE(std::isfinite(picture[p]) && picture[p] >= 0.0f);
      seen.mean += picture[p];
      squares += double(picture[p]) * picture[p];
      count += 1.0;
    }
  }
  seen.mean /= count;
  seen.deviation = std::sqrt(squares / count - seen.mean * seen.mean);
  return seen;
}

TEST_F(Streaks, BandsChangeTheDeviationAndNotTheMean) {
  use_streak_table(table);
  for (const int path : {1, 2}) {
    StageSet set;
    set.present = false;
    set.path = path;
    auto stage = RainStage::make(context->device().software, set);
    ASSERT_TRUE(stage) << stage.error().message;
    const Seen even = look(**stage, StreakRung::even, 12), banded = look(**stage, StreakRung::table, 12),
               four = look(**stage, StreakRung::nearest, 12);
    EXPECT_GT(even.mean, 0.0);
    // Forty pictures agree to 0.2%; the bands of the near streaks of a dozen leave a little more to chance.
    EXPECT_NEAR(banded.mean, even.mean, 0.02 * even.mean) << "path " << path;
    EXPECT_NEAR(four.mean, even.mean, 0.02 * even.mean) << "path " << path;
    EXPECT_GT(std::abs(banded.deviation / even.deviation - 1.0), 0.005) << "no bands are drawn, path " << path;
  }
  use_streak_table(nullptr);
}

TEST_F(Streaks, WithoutATableAreEven) {
  use_streak_table(nullptr);
  StageSet set;
  set.present = false;
  auto stage = RainStage::make(context->device().software, set);
  ASSERT_TRUE(stage) << stage.error().message;
  const Seen even = look(**stage, StreakRung::even, 1), none = look(**stage, StreakRung::table, 1);
  EXPECT_EQ(even.mean, none.mean);
  EXPECT_EQ(even.deviation, none.deviation);
}

}  // namespace
}  // namespace petrichor
