#include "engine/ecs/registry.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

namespace petrichor {
namespace {

struct Position {
  int x = 7;
  int y = 8;
};
struct Velocity {
  float speed_mps = 0.0f;
};
struct Tag {};

TEST(Registry, Identifiers) {
  EXPECT_EQ(entity_index(null_entity), entity_index_mask);
  EXPECT_EQ(entity_version(null_entity), entity_version_mask);
  EXPECT_EQ(entity_index(make_entity(12345, 67)), 12345u);
  EXPECT_EQ(entity_version(make_entity(12345, 67)), 67u);

  Registry r;
  const Entity a = r.create(), b = r.create();
  EXPECT_NE(a, b);
  EXPECT_TRUE(r.alive(a));
  EXPECT_TRUE(r.alive(b));
  EXPECT_FALSE(r.alive(null_entity));
  EXPECT_FALSE(r.alive(make_entity(2, 0)));
  EXPECT_EQ(r.size(), 2u);
}

TEST(Registry, DestroyVersion) {
  Registry r;
  const Entity a = r.create(), b = r.create();
  r.emplace<Position>(a, 1, 2);
  r.destroy(a);
  EXPECT_FALSE(r.alive(a));
  EXPECT_TRUE(r.alive(b));
  EXPECT_EQ(r.find<Position>(a), nullptr);
  const Entity again = r.create();
  EXPECT_EQ(entity_index(again), entity_index(a));
  EXPECT_EQ(entity_version(again), entity_version(a) + 1);
  EXPECT_FALSE(r.alive(a));
  EXPECT_EQ(r.find<Position>(again), nullptr) << "a component outlived its entity";
  r.emplace<Position>(again, 3, 4);
  EXPECT_EQ(r.find<Position>(a), nullptr) << "a stale handle reached its successor's component";
  EXPECT_FALSE(r.remove<Position>(a));
  EXPECT_TRUE(r.has<Position>(again));
}

TEST(Registry, CreateDestroyReleaseCornerCase) {
  Registry r;
  const Entity first = r.create(), second = r.create();
  r.destroy(first);
  r.destroy(second);
  const Entity third = r.create();
  EXPECT_EQ(entity_index(third), entity_index(second));
  EXPECT_EQ(entity_version(third), 1u);
  const Entity fourth = r.create();
  EXPECT_EQ(entity_index(fourth), entity_index(first));
  EXPECT_EQ(entity_version(fourth), 1u);
  EXPECT_EQ(entity_index(r.create()), 2u);
}

TEST(Registry, CreateClearCycle) {
  Registry r;
  Entity before = r.create();
  for (int i = 0; i < 10; ++i) r.create();
  r.clear();
  EXPECT_EQ(r.size(), 0u);
  for (int i = 0; i < 7; ++i) {
    r.create();
    const Entity e = r.create();
    r.emplace<Position>(e);
    before = e;
    r.clear();
    EXPECT_FALSE(r.alive(before));
    EXPECT_EQ(r.size<Position>(), 0u);
  }
  EXPECT_EQ(r.size(), 0u);
}

TEST(Registry, VersionOverflow) {
  Registry r;
  const Entity neighbour = r.create();
  std::set<std::uint32_t> seen{neighbour.bits};
  Entity last = null_entity;
  for (std::uint32_t i = 0; i <= entity_version_mask + 5; ++i) {
    last = r.create();
    EXPECT_TRUE(seen.insert(last.bits).second) << "a handle was issued twice";
    r.destroy(last);
  }
  EXPECT_NE(entity_index(last), 1u) << "the index whose versions ran out must be retired";
  EXPECT_FALSE(r.alive(make_entity(1, 0)));
  EXPECT_FALSE(r.alive(make_entity(1, entity_version_mask)));
  EXPECT_TRUE(r.alive(neighbour));
  EXPECT_EQ(r.size(), 1u);
  r.clear();
  EXPECT_EQ(r.size(), 0u);
  EXPECT_EQ(entity_index(r.create()), 0u);
}

TEST(Registry, EmplaceOrReplace) {
  Registry r;
  const Entity e = r.create();
  EXPECT_EQ(r.emplace_or_replace<Position>(e, 1, 2).x, 1);
  EXPECT_EQ(r.emplace_or_replace<Position>(e, 3, 4).y, 4);
  EXPECT_EQ(r.size<Position>(), 1u);
  EXPECT_EQ(r.emplace_or_replace<Position>(e).x, 7) << "no arguments: the defaults";
}

TEST(Registry, EmplaceEmpty) {
  Registry r;
  const Entity e = r.create(), f = r.create();
  r.emplace<Tag>(e);
  EXPECT_TRUE(r.has<Tag>(e));
  EXPECT_FALSE(r.has<Tag>(f));
  EXPECT_NE(r.find<Tag>(e), nullptr);
  EXPECT_TRUE(r.remove<Tag>(e));
  EXPECT_FALSE(r.remove<Tag>(e));
  EXPECT_EQ(r.size<Tag>(), 0u);
}

TEST(Registry, EmplaceMoveOnlyComponent) {
  struct Owner {
    std::unique_ptr<int> value;
  };
  Registry r;
  std::vector<Entity> entities;
  for (int i = 0; i < 100; ++i) {
    entities.push_back(r.create());
    r.emplace<Owner>(entities.back(), std::make_unique<int>(i));
  }
  r.destroy(entities[0]);
  r.remove<Owner>(entities[50]);
  EXPECT_EQ(*r.get<Owner>(entities[99]).value, 99);
  EXPECT_EQ(*r.get<Owner>(entities[1]).value, 1);
  EXPECT_EQ(r.find<Owner>(entities[50]), nullptr);
}

TEST(Registry, CleanViewAfterRemoveAndClear) {
  Registry r;
  const auto view = [&] { return r.view<Position, Velocity>(); };
  EXPECT_TRUE(view().empty());
  const Entity e = r.create();
  r.emplace<Position>(e);
  r.emplace<Velocity>(e, 1.0f);
  EXPECT_EQ(view().size(), 1u);
  r.remove<Position>(e);
  EXPECT_EQ(view().size(), 0u);
  r.emplace<Position>(e);
  EXPECT_EQ(view().size(), 1u);
  r.clear<Position>();
  EXPECT_EQ(view().size(), 0u);
  EXPECT_TRUE(r.alive(e));
  r.emplace<Position>(e);
  r.clear();
  EXPECT_EQ(view().size(), 0u);
}

TEST(Registry, Constness) {
  Registry r;
  const Entity e = r.create();
  r.emplace<Position>(e, 1, 2);
  const Registry& fixed = r;
  static_assert(std::is_same_v<decltype(r.find<Position>(e)), Position*>);
  static_assert(std::is_same_v<decltype(fixed.find<Position>(e)), const Position*>);
  static_assert(std::is_same_v<decltype(fixed.get<Position>(e)), const Position&>);
  EXPECT_EQ(fixed.get<Position>(e).x, 1);
  EXPECT_EQ(fixed.find<Velocity>(e), nullptr);
  EXPECT_TRUE(fixed.has<Position>(e));
  fixed.view<Position>().each([](Entity, auto& p) {
    static_assert(std::is_same_v<decltype(p), const Position&>);
    EXPECT_EQ(p.y, 2);
  });
  r.view<const Position>().each([](Entity, auto& p) { static_assert(std::is_same_v<decltype(p), const Position&>); });
  r.view<Position>().each([](Entity, auto& p) { static_assert(std::is_same_v<decltype(p), Position&>); });
}

TEST(Registry, EachMeetsTheLivingByIndex) {
  Registry r;
  std::vector<Entity> made;
  for (int i = 0; i < 6; ++i) made.push_back(r.create());
  r.destroy(made[0]);
  r.destroy(made[3]);
  std::vector<Entity> met;
  r.each([&](Entity e) { met.push_back(e); });
  EXPECT_EQ(met, (std::vector<Entity>{made[1], made[2], made[4], made[5]}));
}

TEST(Registry, MovesAsAWhole) {
  Registry from;
  const Entity e = from.create();
  from.emplace<std::string>(e, "rain");
  Registry to = std::move(from);
  EXPECT_EQ(to.get<std::string>(e), "rain");
  EXPECT_TRUE(to.alive(e));
}

// Against a plain model, over a long random history: the registry never disagrees with it.
TEST(Registry, AgreesWithAPlainModel) {
  struct Known {
    Entity entity;
    int position = -1;
    bool tag = false;
  };
  Registry r;
  std::vector<Known> model;
  std::uint32_t state = 1;
  const auto below = [&](std::uint32_t n) {
    state = state * 1664525u + 1013904223u;
    return (state >> 8) % n;
  };
  for (int step = 0; step < 20000; ++step) {
    const std::uint32_t what = below(6);
    if (what == 0 || model.empty()) {
      model.push_back({r.create()});
    } else {
      const std::uint32_t i = below(static_cast<std::uint32_t>(model.size()));
      Known& k = model[i];
      if (what == 1) {
        r.destroy(k.entity);
        model.erase(model.begin() + i);
      } else if (what == 2) {
        r.emplace_or_replace<Position>(k.entity, step, 0);
        k.position = step;
      } else if (what == 3) {
        EXPECT_EQ(r.remove<Position>(k.entity), k.position >= 0);
        k.position = -1;
      } else if (what == 4) {
        if (!k.tag) r.emplace<Tag>(k.entity);
        k.tag = true;
      } else {
        EXPECT_EQ(r.remove<Tag>(k.entity), k.tag);
        k.tag = false;
      }
    }
    if (step % 500 == 0) r.sort<Position>([](const Position& a, const Position& b) { return a.x < b.x; });
    if (step % 700 == 0) r.sort_as<Tag, Position>();
  }
  ASSERT_EQ(r.size(), model.size());
  std::size_t both = 0, without_tag = 0;
  for (const Known& k : model) {
    ASSERT_TRUE(r.alive(k.entity));
    ASSERT_EQ(r.has<Position>(k.entity), k.position >= 0);
    if (k.position >= 0) {
      ASSERT_EQ(r.get<Position>(k.entity).x, k.position);
    }
    ASSERT_EQ(r.has<Tag>(k.entity), k.tag);
    both += k.position >= 0 && k.tag;
    without_tag += k.position >= 0 && !k.tag;
  }
  EXPECT_EQ((r.view<Position, Tag>().size()), both);
  EXPECT_EQ((r.view<Tag, const Position>().size()), both);
  EXPECT_EQ(r.view<Position>().without<Tag>().size(), without_tag);
}

#ifndef NDEBUG
TEST(RegistryDeathTest, StructuralChangeInAViewAsserts) {
  Registry r;
  const Entity e = r.create();
  r.emplace<Position>(e);
  r.emplace<Tag>(r.create());
  EXPECT_DEATH(r.view<Position>().each([&](Entity, Position&) { r.emplace<Position>(r.create()); }), "Commands");
  EXPECT_DEATH(r.view<Position>().each([&](Entity x, Position&) { r.destroy(x); }), "Commands");
  EXPECT_DEATH(r.view<Position>().without<Tag>().each([&](Entity x, Position&) { r.emplace<Tag>(x); }), "Commands");
}
#endif

}  // namespace
}  // namespace petrichor
