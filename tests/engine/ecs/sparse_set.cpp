#include "engine/ecs/sparse_set.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace petrichor {
namespace {

Entity at(std::uint32_t index) {
  return make_entity(index, 0);
}

void push_all(SparseSet& set, std::vector<std::uint32_t> indices) {
  for (const std::uint32_t i : indices) set.push(at(i));
}

std::vector<std::uint32_t> indices(const SparseSet& set) {
  std::vector<std::uint32_t> out;
  for (const Entity e : set.entities()) {
    out.push_back(entity_index(e));
    EXPECT_EQ(set.position(e), out.size() - 1) << "dense and sparse disagree";
  }
  return out;
}

using Indices = std::vector<std::uint32_t>;

TEST(SparseSet, PushOutOfBounds) {
  SparseSet set;
  set.push(at(0));
  set.push(at(5000));  // far beyond what index 0 made room for
  EXPECT_TRUE(set.contains(at(0)));
  EXPECT_TRUE(set.contains(at(5000)));
  EXPECT_FALSE(set.contains(at(4999)));
  EXPECT_FALSE(set.contains(at(5001)));
  EXPECT_FALSE(set.contains(at(1u << 20)));
  EXPECT_FALSE(set.contains(null_entity));
}

TEST(SparseSet, ContainsErased) {
  SparseSet set;
  push_all(set, {3, 4});
  EXPECT_TRUE(set.remove(at(3)));
  EXPECT_FALSE(set.contains(at(3)));
  EXPECT_FALSE(set.remove(at(3)));
  EXPECT_TRUE(set.contains(at(4)));
  set.push(make_entity(3, 1));
  EXPECT_FALSE(set.contains(at(3))) << "another version is another entity";
  EXPECT_TRUE(set.contains(make_entity(3, 1)));
}

TEST(SparseSet, CrossErase) {
  SparseSet set;
  push_all(set, {3, 42});
  EXPECT_TRUE(set.remove(at(3)));
  EXPECT_FALSE(set.contains(at(3)));
  EXPECT_EQ(set.position(at(42)), 0u);
  EXPECT_TRUE(set.remove(at(42)));
  EXPECT_TRUE(set.empty());
}

TEST(SparseSet, Clear) {
  SparseSet set;
  push_all(set, {1, 2, 3});
  set.clear();
  EXPECT_TRUE(set.empty());
  EXPECT_FALSE(set.contains(at(2)));
  push_all(set, {2});
  EXPECT_EQ(indices(set), Indices{2});
}

TEST(SparseSet, SortOrdered) {
  SparseSet set;
  push_all(set, {12, 42, 7, 3, 9});
  set.sort_entities([](Entity a, Entity b) { return entity_index(a) < entity_index(b); });
  EXPECT_EQ(indices(set), (Indices{3, 7, 9, 12, 42}));
}

TEST(SparseSet, SortAsDisjoint) {
  SparseSet a, b;
  push_all(a, {3, 12, 42});
  EXPECT_TRUE(b.empty());
  a.sort_as(b);
  EXPECT_EQ(indices(a), (Indices{3, 12, 42}));
  push_all(b, {1, 2});
  a.sort_as(b);
  EXPECT_EQ(indices(a), (Indices{3, 12, 42}));
}

TEST(SparseSet, SortAsOverlap) {
  SparseSet a, b;
  push_all(a, {3, 12, 42});
  push_all(b, {42, 5});
  a.sort_as(b);
  EXPECT_EQ(indices(a), (Indices{42, 3, 12}));
}

TEST(SparseSet, SortAsReverse) {
  SparseSet a, b;
  push_all(a, {1, 2, 3, 4, 5});
  push_all(b, {5, 4, 3, 2, 1});
  a.sort_as(b);
  EXPECT_EQ(indices(a), (Indices{5, 4, 3, 2, 1}));
}

TEST(SparseSet, SortAsUnordered) {
  SparseSet a, b;
  push_all(a, {1, 2, 3, 4, 5});
  push_all(b, {3, 2, 6, 1, 4, 5});
  a.sort_as(b);
  EXPECT_EQ(indices(a), (Indices{3, 2, 1, 4, 5}));
}

TEST(SparseSet, SortAsIgnoresOtherVersions) {
  SparseSet a, b;
  push_all(a, {1, 2});
  b.push(make_entity(2, 9));
  a.sort_as(b);
  EXPECT_EQ(indices(a), (Indices{1, 2}));
}

}  // namespace
}  // namespace petrichor
