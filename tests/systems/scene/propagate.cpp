#include "systems/scene/propagate.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/quaternion.hpp>

namespace petrichor {
namespace {

Entity place(Registry& registry, glm::vec3 position_m, Entity parent = null_entity) {
  const Entity e = registry.create();
  registry.emplace<Transform>(e, Transform{position_m});
  if (parent != null_entity) registry.emplace<Parent>(e, Parent{parent});
  return e;
}

glm::vec3 world_position(const Registry& registry, Entity e) {
  return registry.get<WorldTransform>(e).matrix[3];
}

TEST(Propagate, ParentsTurnAndScaleTheirChildren) {
  Registry registry;
  // The child is made first: the order of creation must not matter.
  const Entity child = place(registry, {1, 0, 0});
  const Entity parent = place(registry, {10, 0, 0});
  registry.emplace<Parent>(child, Parent{parent});
  Transform& t = registry.get<Transform>(parent);
  t.orientation = glm::angleAxis(glm::radians(90.0f), glm::vec3(0, 1, 0));  // +x to -z
  t.scale = {3, 3, 3};
  propagate_transforms(registry);
  EXPECT_LT(glm::distance(world_position(registry, child), glm::vec3(10, 0, -3)), 1e-5f);
  EXPECT_EQ(world_position(registry, parent), glm::vec3(10, 0, 0));
}

TEST(Propagate, FollowsChanges) {
  Registry registry;
  const Entity a = place(registry, {1, 0, 0});
  const Entity b = place(registry, {0, 1, 0}, a);
  propagate_transforms(registry);
  registry.get<Transform>(a).position_m = {5, 0, 0};
  propagate_transforms(registry);
  EXPECT_EQ(world_position(registry, b), glm::vec3(5, 1, 0));
  registry.remove<Parent>(b);
  propagate_transforms(registry);
  EXPECT_EQ(world_position(registry, b), glm::vec3(0, 1, 0));
  registry.remove<Transform>(b);
  propagate_transforms(registry);
  EXPECT_FALSE(registry.has<WorldTransform>(b));
}

TEST(Propagate, DeadParentsAndParentsWithoutPlace) {
  Registry registry;
  const Entity top = place(registry, {1, 0, 0});
  const Entity group = registry.create();  // no Transform of its own
  registry.emplace<Parent>(group, Parent{top});
  const Entity under_group = place(registry, {0, 1, 0}, group);
  const Entity dead = place(registry, {100, 0, 0});
  const Entity orphan = place(registry, {0, 0, 1}, dead);
  registry.destroy(dead);
  propagate_transforms(registry);
  EXPECT_EQ(world_position(registry, under_group), glm::vec3(1, 1, 0));
  EXPECT_EQ(world_position(registry, orphan), glm::vec3(0, 0, 1));
  EXPECT_FALSE(registry.has<WorldTransform>(group));
}

TEST(Propagate, HundredThousandDeep) {
  constexpr int depth = 100000;
  Registry registry;
  std::vector<Entity> chain;
  for (int i = 0; i < depth; ++i)
    chain.push_back(place(registry, {1, 0, 0}, chain.empty() ? null_entity : chain.back()));
  propagate_transforms(registry);
  EXPECT_EQ(world_position(registry, chain.back()).x, static_cast<float>(depth));
  // Downwards too: children made before their parents.
  Registry reversed;
  std::vector<Entity> up;
  for (int i = 0; i < depth; ++i) {
    up.push_back(place(reversed, {1, 0, 0}));
    if (i > 0) reversed.emplace<Parent>(up[up.size() - 2], Parent{up.back()});
  }
  propagate_transforms(reversed);
  EXPECT_EQ(world_position(reversed, up.front()).x, static_cast<float>(depth));
}

TEST(Propagate, RingsAreCutOnce) {
  Registry registry;
  const Entity a = place(registry, {1, 0, 0});
  const Entity b = place(registry, {1, 0, 0}, a);
  const Entity c = place(registry, {1, 0, 0}, b);
  registry.emplace<Parent>(a, Parent{c});
  const Entity self = place(registry, {2, 0, 0});
  registry.emplace<Parent>(self, Parent{self});
  const Entity leaf = place(registry, {0, 1, 0}, c);
  testing::internal::CaptureStderr();
  propagate_transforms(registry);
  const std::string log = testing::internal::GetCapturedStderr();
  EXPECT_NE(log.find("its own ancestor"), std::string::npos) << log;
  int with_parent = 0;
  for (Entity e : {a, b, c}) with_parent += registry.has<Parent>(e);
  EXPECT_EQ(with_parent, 2);
  EXPECT_FALSE(registry.has<Parent>(self));
  EXPECT_EQ(world_position(registry, self), glm::vec3(2, 0, 0));
  testing::internal::CaptureStderr();
  propagate_transforms(registry);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(world_position(registry, leaf).y, 1.0f);
}

}  // namespace
}  // namespace petrichor
