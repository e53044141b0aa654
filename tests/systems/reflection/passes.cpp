// Passes of reflections run where something mirrors, and only there.
#include <gtest/gtest.h>

#include <cstring>

#include "systems/reflection/reflection.hpp"
#include "systems/reflection/stage.hpp"
#include "systems/systems.hpp"
#include "tests/engine/platform/gl_test.hpp"

namespace petrichor {
namespace {

using ReflectionPasses = test::GlTest;

bool ran(const ReflectionStage& stage, const std::string& pass) {
  for (const PassReport& r : stage.report())
    if (r.name == pass) return !r.culled;
  return false;
}

std::unique_ptr<ReflectionStage> street(float roughness, ReflectionRung rung) {
  auto stage = ReflectionStage::make(all_passes, night_street(roughness), 96, 54);
  EXPECT_TRUE(stage) << (stage ? "" : stage.error().message);
  if (!stage) return nullptr;
  (*stage)->use(rung);
  return *std::move(stage);
}

TEST_F(ReflectionPasses, DoNotRunInADryMattScene) {
  for (const ReflectionRung rung : {ReflectionRung::toyshop, ReflectionRung::impostors, ReflectionRung::screen_space}) {
    const auto stage = street(0.9f, rung);
    ASSERT_TRUE(stage);
    const auto picture = stage->draw();
    ASSERT_TRUE(picture) << picture.error().message;
    EXPECT_FALSE(ran(*stage, "reflections"));
    EXPECT_FALSE(ran(*stage, "reflections_over"));
    EXPECT_EQ(reflections_ladder().coverage(stage->frame), 0.0);
  }
}

TEST_F(ReflectionPasses, DoNotRunWhereNoSurfaceIsInView) {
  const auto stage = street(0.2f, ReflectionRung::impostors);
  ASSERT_TRUE(stage);
  stage->frame.camera.position_m.y += 100.0;  // over the roofs, straight up
  stage->frame.camera.orientation = glm::angleAxis(1.5707963f, glm::vec3(1.0f, 0.0f, 0.0f));
  ASSERT_TRUE(stage->draw());
  EXPECT_FALSE(ran(*stage, "reflections"));
  EXPECT_FALSE(ran(*stage, "reflections_over"));
}

TEST_F(ReflectionPasses, RunWhereGroundIsSmoothAndARungAsks) {
  const auto stage = street(0.2f, ReflectionRung::impostors);
  ASSERT_TRUE(stage);
  ASSERT_TRUE(stage->draw());
  EXPECT_TRUE(ran(*stage, "reflections"));
  EXPECT_TRUE(ran(*stage, "reflections_over"));
  EXPECT_GT(reflections_ladder().coverage(stage->frame), 0.0);
  stage->use(ReflectionRung::environment);
  ASSERT_TRUE(stage->draw());
  EXPECT_FALSE(ran(*stage, "reflections"));
  EXPECT_FALSE(ran(*stage, "reflections_over"));
}

// Windows leave the captured surroundings where they are drawn as themselves: matt ground looks the same in all rungs.
TEST_F(ReflectionPasses, LeaveMattGroundAlone) {
  const auto plain = street(0.9f, ReflectionRung::environment), drawn = street(0.9f, ReflectionRung::impostors);
  ASSERT_TRUE(plain && drawn);
  const auto a = plain->draw(), b = drawn->draw();
  ASSERT_TRUE(a && b);
  EXPECT_EQ(std::memcmp(a->data(), b->data(), a->size() * sizeof a->front()), 0);
}

// Lists of tiles are filled in any order; no picture may depend on it.
TEST_F(ReflectionPasses, SameFrameSameBytes) {
  for (const ReflectionRung rung : {ReflectionRung::impostors, ReflectionRung::screen_space}) {
    const auto stage = street(0.2f, rung);
    ASSERT_TRUE(stage);
    const auto first = stage->draw();
    ASSERT_TRUE(first);
    for (int i = 0; i < 3; ++i) {
      const auto again = stage->draw();
      ASSERT_TRUE(again);
      EXPECT_EQ(std::memcmp(first->data(), again->data(), first->size() * sizeof first->front()), 0) << i;
    }
  }
}

}  // namespace
}  // namespace petrichor
