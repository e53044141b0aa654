#include "systems/walker/walk.hpp"

#include <gtest/gtest.h>

#include "systems/walker/collision.hpp"

namespace petrichor {
namespace {

constexpr double step_s = 1.0 / 120.0;

// Axis-aligned boxes as one model.
struct Course {
  std::shared_ptr<Model> model = std::make_shared<Model>();
  Registry registry;

  Course() { model->meshes.emplace_back().primitives.emplace_back(); }

  void box(glm::vec3 low, glm::vec3 high) {
    Primitive& p = model->meshes[0].primitives[0];
    const auto base = static_cast<std::uint32_t>(p.vertices.size());
    for (int i = 0; i < 8; ++i)
      p.vertices.push_back({{i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z}});
    for (const std::uint32_t i :
         {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5})
      p.indices.push_back(base + i);
  }

  std::unique_ptr<CollisionScene> build() {
    const Entity e = registry.create();
    registry.emplace<MeshInstance>(e, MeshInstance{0, 0});
    registry.emplace<WorldTransform>(e);
    return std::make_unique<CollisionScene>(registry, std::vector<std::shared_ptr<const Model>>{model});
  }
};

Transform at(float x, float feet_y, float z) {
  return Transform{{x, feet_y + Walker{}.eye_height_m, z}};
}
float feet(const Transform& eye) {
  return eye.position_m.y - Walker{}.eye_height_m;
}

TEST(Walk, GravityLandsOnTheFloor) {
  Course course;
  course.box({-50, -1, -50}, {50, 0, 50});
  const auto scene = course.build();
  Walker walker;
  Transform eye = at(0, 20, 0);
  float lowest = 1e9f;
  for (int i = 0; i < 600; ++i) {
    step_walker(walker, eye, {}, scene.get(), step_s);
    lowest = std::min(lowest, feet(eye));
  }
  EXPECT_NEAR(feet(eye), 0.0f, 1e-3f);
  EXPECT_GT(lowest, -1e-3f) << "never under the floor, not even for a tick";
  EXPECT_TRUE(walker.on_ground);
}

TEST(Walk, NoWayThroughWallsAtAnyAngleOrSpeed) {
  Course course;
  course.box({-50, -1, -50}, {50, 0, 50});
  course.box({-5.1f, 0, -5}, {-5, 3, 5});  // a room of thin walls
  course.box({5, 0, -5}, {5.1f, 3, 5});
  course.box({-5, 0, -5.1f}, {5, 3, -5});
  course.box({-5, 0, 5}, {5, 3, 5.1f});
  const auto scene = course.build();
  for (int direction = 0; direction < 24; ++direction)
    for (const bool run : {false, true}) {
      Walker walker;
      walker.run_mps = 30.0f;
      walker.yaw_deg = 15.0f * static_cast<float>(direction) + 1.0f;
      Transform eye = at(0.3f, 0, -0.2f);
      PlayerInput input;
      input.forward = true;
      input.run = run;
      input.up = direction % 3 == 0;  // jumping all the way
      for (int i = 0; i < 1200; ++i) {
        step_walker(walker, eye, input, scene.get(), step_s);
        ASSERT_LT(std::max(std::abs(eye.position_m.x), std::abs(eye.position_m.z)), 5.0f - 0.1f)
            << "heading " << walker.yaw_deg;
      }
    }
}

TEST(Walk, SlidesAlongAWall) {
  Course course;
  course.box({-50, -1, -50}, {50, 0, 50});
  course.box({2, 0, -50}, {2.2f, 3, 50});
  const auto scene = course.build();
  Walker walker;
  walker.yaw_deg = 45.0f;  // forward is -z, right is +x
  Transform eye = at(1, 0, 0);
  PlayerInput input;
  input.forward = true;
  for (int i = 0; i < 480; ++i) step_walker(walker, eye, input, scene.get(), step_s);
  EXPECT_LT(eye.position_m.x, 2.0f);
  EXPECT_LT(eye.position_m.z, -3.0f) << "4 s at 1.5 m/s, 45 degrees to the wall: 4.2 m along it";
}

TEST(Walk, StepsUpAKerbButNotAWall) {
  Course course;
  course.box({-50, -1, -50}, {50, 0, 50});
  course.box({-5, 0, -10}, {5, 0.15f, -2});
  course.box({-5, 0, -20}, {5, 0.8f, -8});
  const auto scene = course.build();
  Walker walker;
  Transform eye = at(0, 0, 0);
  PlayerInput input;
  input.forward = true;
  for (int i = 0; i < 1200; ++i) step_walker(walker, eye, input, scene.get(), step_s);
  EXPECT_NEAR(feet(eye), 0.15f, 1e-3f);
  EXPECT_GT(eye.position_m.z, -8.0f);
}

TEST(Walk, FallsOffAnEdge) {
  Course course;
  course.box({-50, -1, -50}, {50, 0, 50});
  course.box({-2, 0, -2}, {2, 6, 2});
  const auto scene = course.build();
  Walker walker;
  Transform eye = at(0, 6, 0);
  PlayerInput input;
  input.forward = true;
  for (int i = 0; i < 600; ++i) step_walker(walker, eye, input, scene.get(), step_s);
  EXPECT_NEAR(feet(eye), 0.0f, 1e-3f);
}

TEST(Walk, FlyingNeedsNoFloorAndKnowsNoWalls) {
  Course course;
  course.box({-5, -1, -3}, {5, 9, -2});
  const auto scene = course.build();
  Walker walker;
  Transform eye = at(0, 0, 0);
  PlayerInput input;
  input.toggle_flying = true;
  step_walker(walker, eye, input, scene.get(), step_s);
  input = {};
  input.forward = true;
  for (int i = 0; i < 120; ++i) step_walker(walker, eye, input, scene.get(), step_s);
  EXPECT_NEAR(eye.position_m.z, -10.0f, 0.1f);
}

TEST(Walk, AnEmptySceneIsSafe) {
  Course course;
  const auto scene = course.build();
  Walker walker;
  Transform eye = at(0, 0, 0);
  for (int i = 0; i < 12000; ++i) step_walker(walker, eye, {}, scene.get(), step_s);
  EXPECT_TRUE(walker.flying);
  EXPECT_TRUE(std::isfinite(eye.position_m.y));
}

}  // namespace
}  // namespace petrichor
