#include "engine/ecs/commands.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <string>

namespace petrichor {
namespace {

struct Drop {
  int generation = 0;
};
struct Wet {};

TEST(Commands, ChangeDuringAViewWaitsForApply) {
  Registry r;
  for (int i = 0; i < 100; ++i) r.emplace<Drop>(r.create(), 0);
  Commands commands(r);
  int met = 0;
  r.view<Drop>().each([&](Entity e, Drop& d) {
    ++met;
    commands.emplace<Drop>(commands.create(), d.generation + 1);
    if (met % 2)
      commands.destroy(e);
    else
      commands.emplace<Wet>(e);
  });
  EXPECT_EQ(met, 100);
  EXPECT_EQ(r.size<Drop>(), 100u);
  EXPECT_EQ(r.size<Wet>(), 0u);
  commands.apply();
  EXPECT_TRUE(commands.empty());
  EXPECT_EQ(r.size<Drop>(), 150u);
  EXPECT_EQ(r.size<Wet>(), 50u);
  commands.apply();
  EXPECT_EQ(r.size<Drop>(), 150u) << "a second apply() must do nothing";
}

TEST(Commands, AppliesInTheOrderRecorded) {
  Registry r;
  Commands commands(r);
  const Entity e = commands.create();
  commands.emplace<Drop>(e, 1);
  commands.remove<Drop>(e);
  commands.emplace<Drop>(e, 2);
  commands.emplace<Drop>(e, 3);
  commands.emplace<std::string>(e, "late");
  commands.apply();
  EXPECT_EQ(r.get<Drop>(e).generation, 3);
  EXPECT_EQ(r.get<std::string>(e), "late");
}

TEST(Commands, TheDeadArePassedOver) {
  Registry r;
  Commands commands(r);
  const Entity e = r.create();
  commands.destroy(e);
  commands.destroy(e);
  commands.emplace<Drop>(e, 1);
  commands.remove<Drop>(e);
  commands.apply();
  EXPECT_FALSE(r.alive(e));
  EXPECT_EQ(r.size<Drop>(), 0u);
  const Entity successor = r.create();
  commands.destroy(e);
  commands.apply();
  EXPECT_TRUE(r.alive(successor));
}

TEST(Commands, MoveOnlyComponents) {
  Registry r;
  Commands commands(r);
  const Entity e = r.create();
  commands.emplace<std::unique_ptr<int>>(e, std::make_unique<int>(7));
  commands.apply();
  EXPECT_EQ(*r.get<std::unique_ptr<int>>(e), 7);
}

}  // namespace
}  // namespace petrichor
