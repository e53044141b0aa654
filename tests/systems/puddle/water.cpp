// What places are told of the water that stands there, and the system about it.
#include "systems/puddle/water.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include "components/transform.hpp"
#include "components/weather.hpp"
#include "systems/puddle/list.hpp"
#include "systems/puddle/puddle.hpp"
#include "systems/puddle/stage.hpp"
#include "tests/engine/platform/gl_test.hpp"

namespace petrichor::test {
namespace {

constexpr float mask_m = 0.04f;
constexpr float kind = 1.0f / 255.0f;

FramePuddles::Puddle puddle_of(glm::vec3 brim, glm::vec2 half, float depth, float level, float turn = 0.0f) {
  FramePuddles::Puddle p;
  p.world_from_puddle = glm::rotate(glm::translate(glm::mat4(1.0f), brim), turn, glm::vec3(0, 1, 0));
  p.half_size_m = half;
  p.depth_m = depth;
  p.level_m = level;
  return p;
}

class StandingWaterTest : public GlTest {
 protected:
  void SetUp() override {
    GlTest::SetUp();
    if (IsSkipped()) return;
    stage = std::make_unique<PuddleStage>();
    stage->frame.camera.position_m = {100.0, 2.0, -50.0};
    stage->kinds = {WetMaterialGpu{}, WetMaterialGpu{{1, 2, 3, mask_m}, {0.5f, 2.0f, 0.25f, -1.0f}}};
    ASSERT_TRUE(stage->load());
  }
  void TearDown() override {
    stage.reset();
    GlTest::TearDown();
  }
  void put(std::vector<FramePuddles::Puddle> puddles, float published = 0.0f) {
    auto frame = std::make_shared<FramePuddles>();
    for (const auto& p : puddles) frame->any_water |= p.level_m > 0.0f;
    frame->puddles = std::move(puddles);
    frame->published = published;
    stage->frame.puddles = frame;
  }
  PuddleAnswer at(glm::vec3 place, float below_brim_m, float of_kind = kind) {
    const auto got = stage->ask({{place, {below_brim_m / mask_m, of_kind}}});
    EXPECT_TRUE(got) << (got ? "" : got.error().message);
    return got && !got->empty() ? got->front() : PuddleAnswer{};
  }
  std::unique_ptr<PuddleStage> stage;
};

TEST_F(StandingWaterTest, LiesLevelAboveTheMask) {
  put({puddle_of({100, 0.2f, -60}, {2, 1}, 0.02f, 0.012f)});  // 8 mm below its brim
  EXPECT_NEAR(at({100, 0.18f, -60}, 0.020f).depth_m, 0.012f, 1e-5f);
  EXPECT_NEAR(at({101, 0.19f, -60}, 0.010f).depth_m, 0.002f, 1e-5f);
  EXPECT_EQ(at({101, 0.195f, -60}, 0.005f).depth_m, 0.0f) << "the shore has drawn back";
  EXPECT_EQ(at({102.1f, 0.18f, -60}, 0.02f).depth_m, 0.0f) << "beyond its rectangle";
  EXPECT_EQ(at({100, 0.18f, -60}, 0.02f, 0.0f).depth_m, 0.0f) << "what never gets wet";
  EXPECT_EQ(at({100, 3.18f, -60}, 0.02f).depth_m, 0.0f) << "on the bridge above it";
}

TEST_F(StandingWaterTest, TurnsAndMovesWithItsPuddle) {
  put({puddle_of({100, 0.2f, -60}, {3, 0.5f}, 0.02f, 0.02f, glm::radians(90.0f))});
  EXPECT_GT(at({100, 0.19f, -57.5f}, 0.01f).depth_m, 0.0f) << "its length lies along z now";
  EXPECT_EQ(at({102.5f, 0.19f, -60}, 0.01f).depth_m, 0.0f);
  put({puddle_of({110, 0.2f, -60}, {3, 0.5f}, 0.02f, 0.02f)});
  EXPECT_GT(at({112.5f, 0.19f, -60}, 0.01f).depth_m, 0.0f);
  EXPECT_EQ(at({100, 0.19f, -57.5f}, 0.01f).depth_m, 0.0f);
}

TEST_F(StandingWaterTest, TakesTheHollowWhoseBrimTheMaskMeans) {
  // Rectangles of neighbours overlap; one is full and one nearly dry.
  put({puddle_of({100, 0.20f, -60}, {4, 4}, 0.02f, 0.02f), puddle_of({101, 0.26f, -60}, {4, 4}, 0.02f, 0.001f)});
  EXPECT_NEAR(at({100, 0.19f, -60}, 0.010f).depth_m, 0.010f, 1e-5f);
  EXPECT_EQ(at({100, 0.25f, -60}, 0.010f).depth_m, 0.0f);
}

TEST_F(StandingWaterTest, GoesByHeightWhereNoMaskIs) {
  FramePuddles::Puddle p = puddle_of({100, 0.2f, -60}, {2, 1}, 0.05f, 0.03f);  // level at 0.18
  p.by_height = true;
  put({p});
  EXPECT_NEAR(at({100, 0.16f, -60}, 0.0f).depth_m, 0.02f, 1e-5f);
  EXPECT_EQ(at({100, 0.19f, -60}, 0.0f).depth_m, 0.0f);
  EXPECT_EQ(at({100, -0.2f, -60}, 0.0f).depth_m, 0.0f) << "a cellar under the street stays dry";
}

TEST_F(StandingWaterTest, BlendsNormalsByDepthAndInfluence) {
  FramePuddles::Puddle p = puddle_of({100, 0.2f, -60}, {2, 1}, 0.03f, 0.03f);
  p.ripple_influence = 0.8f;
  p.ripple_scale = 3.0f;
  p.ripple_turn_rad = 1.0f;
  put({p});
  const PuddleAnswer deep = at({100, 0.18f, -60}, 0.02f);
  EXPECT_NEAR(deep.influence, 0.8f * 0.5f, 1e-4f) << "p_i of the puddle and of the material";
  EXPECT_FLOAT_EQ(deep.ripple_scale, 6.0f);
  EXPECT_FLOAT_EQ(deep.ripple_turn_rad, 1.25f);
  EXPECT_NEAR(deep.tint.y, std::exp(-2.0f), 1e-4f);
  const float shallow = at({100, 0.199f, -60}, 0.001f).influence;
  EXPECT_GT(shallow, 0.0f);
  EXPECT_LT(shallow, 0.5f * deep.influence) << "the relief is seen through the edge";
  put({p}, 1.0f);  // as printed: by d_i, the mask's own value
  EXPECT_NEAR(at({100, 0.18f, -60}, 0.02f).influence, 0.8f * 0.5f * (0.02f / mask_m), 1e-4f);
}

TEST_F(StandingWaterTest, FindsEachOfManyPuddles) {
  std::vector<FramePuddles::Puddle> all;
  for (int i = 0; i < 200; ++i)
    all.push_back(puddle_of({100 + 3.0f * static_cast<float>(i % 20), 0.2f, -60 + 3.0f * static_cast<float>(i / 20)},
                            {1, 1}, 0.02f, 0.001f * static_cast<float>(1 + i % 19)));
  put(all);
  std::vector<PuddleQuestion> questions;
  for (const auto& p : all)
    questions.push_back({glm::vec3(p.world_from_puddle[3]) + glm::vec3(0.9f, -0.02f, 0.9f), {0.02f / mask_m, kind}});
  const auto got = stage->ask(questions);
  ASSERT_TRUE(got);
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_NEAR((*got)[i].depth_m, all[i].level_m, 1e-4f) << i;
}

TEST_F(StandingWaterTest, DoesNotRunWhereNoneStands) {
  put({puddle_of({100, 0.2f, -60}, {2, 1}, 0.02f, 0.0f)});
  at({100, 0.18f, -60}, 0.02f);
  EXPECT_FALSE(stage->ran());
  stage->frame.puddles = nullptr;
  at({100, 0.18f, -60}, 0.02f);
  EXPECT_FALSE(stage->ran());
}

struct Scene {
  Registry registry;
  Entity weather = registry.create(), hollow = registry.create();
  Frame frame;
  double time_s = 0.0;

  explicit Scene(Puddle p = {}) {
    registry.emplace<Emitter>(weather).rain_mm_per_hour = 8.0f;
    registry.emplace<Puddle>(hollow, p);
    registry.emplace<WorldTransform>(hollow, glm::translate(glm::mat4(1.0f), glm::vec3(0, 0, -5)));
    frame.width = 160;
    frame.height = 90;
    frame.camera.position_m = {0, 1.6, 0};
  }
  void run(double seconds, double step_s = 1.0 / 120.0) {
    for (const double end = time_s + seconds; time_s < end - 0.5 * step_s;) {
      time_s += step_s;
      simulate_puddles(registry, time_s, step_s);
    }
  }
  const FramePuddles* seen() {
    frame.puddles = nullptr;
    frame.time_s = time_s;
    extract_puddles(registry, frame);
    return frame.puddles.get();
  }
  double depth_m() { return puddle_at(registry.get<PuddleWater>(hollow), time_s).depth_m; }
};

TEST(Puddles, ARainySceneBeginsWithWaterAndADryOneWithout) {
  Scene rainy;
  rainy.run(0.1);
  EXPECT_GT(rainy.depth_m(), 0.6 * 0.012) << "it has rained for twenty minutes";
  Scene dry;
  dry.registry.get<Emitter>(dry.weather).rain_mm_per_hour = 0.0f;
  dry.run(0.1);
  EXPECT_EQ(dry.depth_m(), 0.0);
  ASSERT_TRUE(dry.seen());
  EXPECT_FALSE(dry.seen()->any_water);
  Puddle half;
  half.initial_fill = 0.5f;
  Scene given(half);
  given.run(0.05);
  EXPECT_NEAR(given.depth_m(), 0.006, 1e-5);
}

TEST(Puddles, TimeScaleFillsFaster) {
  Puddle p;
  p.initial_fill = 0.0f;
  Scene slow(p);
  p.time_scale = 60.0f;
  Scene fast(p);
  slow.run(60.0, 0.5);
  fast.run(1.0, 0.5);
  EXPECT_NEAR(fast.depth_m(), slow.depth_m(), 1e-9);
  EXPECT_GT(fast.depth_m(), 0.0);
}

TEST(Puddles, RungsDecideTheLevel) {
  Puddle p;
  p.initial_fill = 0.25f;
  Scene scene(p);
  scene.run(0.01);
  ASSERT_TRUE(scene.seen());
  EXPECT_NEAR(scene.seen()->puddles.front().level_m, 0.003f, 1e-5f);
  scene.frame.techniques.set(Effect::puddles, PuddleRung::masks);
  EXPECT_NEAR(scene.seen()->puddles.front().level_m, 0.012f, 1e-6f) << "always full";
  EXPECT_EQ(scene.seen()->published, 1.0f);
  scene.frame.techniques[Effect::puddles] = {2, 1, 0.25f};  // a quarter filled, three quarters masks
  EXPECT_NEAR(scene.seen()->puddles.front().level_m, 0.75f * 0.012f + 0.25f * 0.003f, 1e-5f);
  scene.frame.techniques.set(Effect::puddles, PuddleRung::none);
  EXPECT_EQ(scene.seen(), nullptr);
}

TEST(Puddles, OnlyThoseInViewAreListed) {
  Scene scene;
  scene.run(0.1);
  ASSERT_TRUE(scene.seen());
  scene.frame.camera.orientation = glm::angleAxis(3.1415926f, glm::vec3(0, 1, 0));
  EXPECT_EQ(scene.seen(), nullptr) << "behind the camera";
  EXPECT_EQ(puddles_ladder().coverage(scene.frame), 0.0);
  scene.frame.camera.orientation = glm::quat(1, 0, 0, 0);
  scene.seen();
  EXPECT_GT(puddles_ladder().coverage(scene.frame), 0.0);
  scene.registry.get<WorldTransform>(scene.hollow).matrix[3].z = -500.0f;
  EXPECT_EQ(scene.seen(), nullptr) << "too far to be seen";
}

TEST(Puddles, KeepWaterWhileTheRainChanges) {
  Puddle p;
  p.initial_fill = 0.0f;
  p.drain_mm_per_hour = 0.0f;
  p.maximum_depth_mm = 100.0f;
  Scene scene(p);
  double expected_m3 = 0.0;
  for (int second = 0; second < 20; ++second) {
    const float rate = static_cast<float>(second);
    scene.registry.get<Emitter>(scene.weather).rain_mm_per_hour = rate;
    scene.run(1.0);
    expected_m3 += double(rate) * 1e-3 / 3600.0 * 0.7 * 3.0;  // area share, catchment
  }
  EXPECT_NEAR(volume_m3(shape_of(p), scene.depth_m()), expected_m3, 1e-6 * expected_m3);
}

}  // namespace
}  // namespace petrichor::test
