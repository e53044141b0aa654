#include "engine/ecs/view.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "engine/ecs/registry.hpp"

namespace petrichor {
namespace {

struct A {
  int value = 0;
};
struct B {
  int value = 0;
};
struct C {
  int value = 0;
};
struct Tag {};

TEST(View, Each) {
  Registry r;
  const Entity e0 = r.create(), e1 = r.create();
  r.emplace<A>(e0, 1);
  r.emplace<B>(e0, 10);
  r.emplace<A>(e1, 2);
  r.emplace<B>(e1, 20);
  std::vector<Entity> met;
  r.view<A, const B>().each([&](Entity e, A& a, const B& b) {
    met.push_back(e);
    a.value += b.value;
  });
  EXPECT_EQ(met, (std::vector<Entity>{e0, e1}));
  EXPECT_EQ(r.get<A>(e0).value, 11);
  EXPECT_EQ(r.get<A>(e1).value, 22);
  int sum = 0;
  r.view<A, const B>().each([&](A& a, const B&) { sum += a.value; });
  EXPECT_EQ(sum, 33);
}

TEST(View, EachWithHoles) {
  Registry r;
  const Entity e0 = r.create(), e1 = r.create(), e2 = r.create();
  r.emplace<A>(e0, 0);
  r.emplace<A>(e1, 1);
  r.emplace<B>(e0, 0);
  r.emplace<B>(e2, 2);
  int met = 0;
  r.view<A, B>().each([&](Entity e, A& a, B& b) {
    EXPECT_EQ(e, e0);
    EXPECT_EQ(a.value, b.value);
    ++met;
  });
  EXPECT_EQ(met, 1);
}

TEST(View, EveryStorageMayLead) {
  // The same answer whichever storage is the smallest.
  for (int smallest = 0; smallest < 3; ++smallest) {
    Registry r;
    std::vector<Entity> expected;
    for (int i = 0; i < 60; ++i) {
      const Entity e = r.create();
      const auto wanted = [&](int which) { return i % (which == smallest ? 6 : 2) == 0; };
      if (wanted(0)) r.emplace<A>(e, i);
      if (wanted(1)) r.emplace<B>(e, i);
      if (wanted(2)) r.emplace<C>(e, i);
      if (i % 6 == 0) expected.push_back(e);
    }
    std::vector<Entity> met;
    r.view<A, B, C>().each([&](Entity e, A& a, B& b, C& c) {
      EXPECT_EQ(a.value, b.value);
      EXPECT_EQ(b.value, c.value);
      met.push_back(e);
    });
    EXPECT_EQ(met, expected) << "smallest storage: " << smallest;
  }
}

TEST(View, Exclude) {
  Registry r;
  const Entity e0 = r.create(), e1 = r.create(), e2 = r.create();
  for (const Entity e : {e0, e1, e2}) r.emplace<A>(e);
  r.emplace<B>(e1);
  r.emplace<Tag>(e2);
  const auto walk = [&](auto view) {
    std::vector<Entity> met;
    view.each([&](Entity e, auto&&...) { met.push_back(e); });
    return met;
  };
  EXPECT_EQ(walk(r.view<A>().without<B>()), (std::vector<Entity>{e0, e2}));
  EXPECT_EQ(walk(r.view<A>().without<B, Tag>()), (std::vector<Entity>{e0}));
  EXPECT_EQ(walk(r.view<A>().without<B>().without<Tag>()), (std::vector<Entity>{e0}));
  EXPECT_EQ(walk(r.view<A>().without<C>()), (std::vector<Entity>{e0, e1, e2})) << "a type never seen excludes nobody";
  r.remove<B>(e1);
  EXPECT_EQ(walk(r.view<A>().without<B>()), (std::vector<Entity>{e0, e1, e2}));
}

TEST(View, EmptyType) {
  Registry r;
  const Entity e0 = r.create(), e1 = r.create();
  r.emplace<A>(e0, 3);
  r.emplace<A>(e1, 4);
  r.emplace<Tag>(e1);
  int met = 0;
  r.view<A, Tag>().each([&](Entity e, A& a, Tag&) {
    EXPECT_EQ(e, e1);
    EXPECT_EQ(a.value, 4);
    ++met;
  });
  r.view<Tag>().each([&](Entity e, Tag&) {
    EXPECT_EQ(e, e1);
    ++met;
  });
  EXPECT_EQ(met, 2);
}

TEST(View, FrontSizeEmpty) {
  Registry r;
  EXPECT_TRUE(r.view<A>().empty()) << "a type never seen";
  EXPECT_EQ(r.view<A>().size(), 0u);
  const Entity e0 = r.create(), e1 = r.create();
  r.emplace<A>(e0);
  r.emplace<A>(e1);
  r.emplace<B>(e1);
  EXPECT_EQ(r.view<A>().front(), e0);
  EXPECT_EQ((r.view<A, B>().front()), e1);
  EXPECT_EQ(r.view<A>().without<B>().size(), 1u);
  EXPECT_EQ(r.view<C>().front(), null_entity);
}

TEST(View, SortDecidesTheOrder) {
  Registry r;
  const int values[] = {5, 1, 4, 2, 3};
  for (const int v : values) {
    const Entity e = r.create();
    r.emplace<A>(e, v);
    r.emplace<B>(e, -v);
  }
  r.sort<A>([](const A& a, const A& b) { return a.value < b.value; });
  r.sort_as<B, A>();
  std::vector<int> met;
  r.view<B>().each([&](const B& b) { met.push_back(-b.value); });
  EXPECT_EQ(met, (std::vector<int>{1, 2, 3, 4, 5}));
}

}  // namespace
}  // namespace petrichor
