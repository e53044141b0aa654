#include "engine/ecs/storage.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "engine/ecs/registry.hpp"

namespace petrichor {
namespace {

Entity at(std::uint32_t index) {
  return make_entity(index, 0);
}

TEST(Storage, EmplaceAggregate) {
  struct Aggregate {
    int x = 5;
    std::string text = "dry";
  };
  Storage<Aggregate> s;
  EXPECT_EQ(s.emplace(at(0)).x, 5);
  EXPECT_EQ(s.emplace(at(1), 42).text, "dry");
  EXPECT_EQ(s.emplace(at(2), 42, "wet").text, "wet");
  EXPECT_EQ(s.size(), 3u);
  struct Nested {
    int values[2];
  };
  Storage<Nested> n;
  EXPECT_EQ(n.emplace(at(0), Nested{{1, 2}}).values[1], 2);
}

TEST(Storage, EmplaceSelfMoveSupport) {
  // Removing the last element must not move it onto itself.
  struct Picky {
    std::unique_ptr<int> value;
    explicit Picky(int v) : value(std::make_unique<int>(v)) {}
    Picky(Picky&&) = default;
    Picky& operator=(Picky&& other) {
      EXPECT_NE(this, &other);
      value = std::move(other.value);
      return *this;
    }
  };
  Storage<Picky> s;
  s.emplace(at(0), 1);
  s.emplace(at(1), 2);
  EXPECT_TRUE(s.remove(at(1)));
  EXPECT_EQ(*s.find(at(0))->value, 1);
  EXPECT_TRUE(s.remove(at(0)));
}

// Removes another entity's component when it dies.
struct UpdateFromDestructor {
  Registry* registry = nullptr;
  Entity target = null_entity;
  UpdateFromDestructor(Registry& r, Entity t) : registry(&r), target(t) {}
  UpdateFromDestructor(UpdateFromDestructor&& o) noexcept
      : registry(std::exchange(o.registry, nullptr)), target(std::exchange(o.target, null_entity)) {}
  UpdateFromDestructor& operator=(UpdateFromDestructor&& o) noexcept {
    std::swap(registry, o.registry);
    std::swap(target, o.target);
    return *this;
  }
  ~UpdateFromDestructor() {
    if (registry && target != null_entity) registry->remove<UpdateFromDestructor>(target);
  }
};

TEST(Storage, UpdateFromDestructor) {
  constexpr int size = 10;
  const auto fill = [](Registry& r, std::vector<Entity>& e, bool backwards) {
    for (int i = 0; i < size; ++i) e.push_back(r.create());
    for (int i = 0; i < size; ++i) {
      const int next = backwards ? i - 1 : i + 1;
      const Entity target = next < 0 || next >= size ? null_entity : e[static_cast<std::size_t>(next)];
      r.emplace<UpdateFromDestructor>(e[static_cast<std::size_t>(i)], r, target);
    }
  };
  {
    Registry r;
    std::vector<Entity> e;
    fill(r, e, false);
    EXPECT_TRUE(r.remove<UpdateFromDestructor>(e[3]));  // 3 takes 4, which takes 5 ...
    EXPECT_EQ(r.size<UpdateFromDestructor>(), 3u);
    EXPECT_TRUE(r.has<UpdateFromDestructor>(e[2]));
    EXPECT_FALSE(r.has<UpdateFromDestructor>(e[9]));
  }
  {
    Registry r;
    std::vector<Entity> e;
    fill(r, e, true);
    r.destroy(e[9]);  // 9 takes all the others
    EXPECT_EQ(r.size<UpdateFromDestructor>(), 0u);
    EXPECT_EQ(r.size(), size - 1u);
  }
  {
    Registry r;
    std::vector<Entity> e;
    fill(r, e, false);
    r.clear<UpdateFromDestructor>();
    EXPECT_EQ(r.size<UpdateFromDestructor>(), 0u);
  }
}

struct CreateFromConstructor {
  Entity child = null_entity;
  CreateFromConstructor() = default;
  CreateFromConstructor(Registry& r, int depth) {
    if (depth == 0) return;
    child = r.create();
    r.emplace<CreateFromConstructor>(child, r, depth - 1);
  }
};

TEST(Storage, CreateFromConstructor) {
  Registry r;
  const Entity e = r.create();
  r.emplace<CreateFromConstructor>(e, r, 40);
  EXPECT_EQ(r.size<CreateFromConstructor>(), 41u);
  int depth = 0;
  for (Entity x = e; r.get<CreateFromConstructor>(x).child != null_entity; x = r.get<CreateFromConstructor>(x).child) {
    ++depth;
  }
  EXPECT_EQ(depth, 40);
}

TEST(Storage, ThrowingComponent) {
  struct Throwing {
    int value;
    explicit Throwing(int v) : value(v) {
      if (v < 0) throw std::runtime_error("refused");
    }
  };
  Storage<Throwing> s;
  s.emplace(at(0), 1);
  EXPECT_THROW(s.emplace(at(1), -1), std::runtime_error);
  EXPECT_EQ(s.size(), 1u);
  EXPECT_FALSE(s.contains(at(1)));
  EXPECT_EQ(s.find(at(0))->value, 1);
  s.emplace(at(1), 2);
  EXPECT_EQ(s.find(at(1))->value, 2);

  Registry r;
  const Entity e = r.create();
  EXPECT_THROW(r.emplace<Throwing>(e, -1), std::runtime_error);
  EXPECT_FALSE(r.has<Throwing>(e));
  EXPECT_TRUE(r.alive(e));
}

TEST(Storage, SortMovesValuesWithTheirEntities) {
  Storage<std::string> s;
  const char* words[] = {"puddle", "awning", "lamp", "drip"};
  for (std::uint32_t i = 0; i < 4; ++i) s.emplace(at(i), words[i]);
  s.sort([](const std::string& a, const std::string& b) { return a < b; });
  EXPECT_EQ(s.at(0), "awning");
  EXPECT_EQ(s.at(3), "puddle");
  for (std::uint32_t i = 0; i < 4; ++i) EXPECT_EQ(*s.find(at(i)), words[i]);
}

TEST(Storage, EmptyTypeKeepsNoArray) {
  struct Tag {};
  static_assert(Storage<Tag>::is_tag);
  Storage<Tag> s;
  for (std::uint32_t i = 0; i < 100; ++i) s.emplace(at(i));
  EXPECT_EQ(s.find(at(3)), s.find(at(77)));
  s.sort([](Entity a, Entity b) { return entity_index(a) > entity_index(b); });
  EXPECT_EQ(s.entities()[0], at(99));
}

}  // namespace
}  // namespace petrichor
