#include "engine/ecs/schedule.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace petrichor {
namespace {

struct Lamp {
  float intensity_cd = 1.0f;
};
struct Puddle {
  float depth_mm = 0.0f;
};

std::vector<Schema> test_schemas() {
  return {schema<Lamp>("lamp", "A lamp.", {}), schema<Puddle>("puddle", "A puddle.", {})};
}

struct Context {
  Registry registry;
  Commands commands{registry};
  std::vector<std::string> ran;
};
using Entry = SystemEntry<Context>;

std::function<void(Context&)> note(std::string name) {
  return [name](Context& c) { c.ran.push_back(name); };
}

std::vector<std::string> run(std::vector<Entry> list, Context& c) {
  const auto schemas = test_schemas();
  Schedule<Context> schedule(std::move(list), schemas);
  schedule.run(c, c.registry, c.commands);
  return c.ran;
}

TEST(Schedule, PhaseOrderThenDeclarationOrder) {
  Context c;
  EXPECT_EQ(run({{.name = "extract", .phase = Phase::extract, .run = note("extract")},
                 {.name = "rain", .phase = Phase::simulate, .run = note("rain")},
                 {.name = "keys", .phase = Phase::input, .run = note("keys")},
                 {.name = "wind", .phase = Phase::simulate, .run = note("wind")},
                 {.name = "tree", .phase = Phase::propagate, .run = note("tree")},
                 {.name = "lua", .phase = Phase::script, .run = note("lua")}},
                c),
            (std::vector<std::string>{"keys", "lua", "rain", "wind", "tree", "extract"}));
}

TEST(Schedule, RunsARangeOfPhases) {
  Context c;
  const auto schemas = test_schemas();
  Schedule<Context> s({{.name = "keys", .phase = Phase::input, .run = note("keys")},
                       {.name = "rain", .phase = Phase::simulate, .run = note("rain")},
                       {.name = "draw", .phase = Phase::extract, .run = note("draw")}},
                      schemas);
  s.run(c, c.registry, c.commands, Phase::simulate, Phase::simulate);
  s.run(c, c.registry, c.commands, Phase::simulate, Phase::simulate);
  s.run(c, c.registry, c.commands, Phase::propagate, Phase::extract);
  EXPECT_EQ(c.ran, (std::vector<std::string>{"rain", "rain", "draw"}));
  EXPECT_EQ(s.stats()[1].runs, 2);
  EXPECT_EQ(s.stats()[0].runs, 0);
}

TEST(Schedule, SyncPoint) {
  const std::vector<SystemAccess> list{
      {.name = "spawn", .writes = {"lamp"}, .changes = {"puddle"}},
      {.name = "shine", .reads = {"lamp"}},                        // not what spawn changed
      {.name = "more", .reads = {"lamp"}, .changes = {"puddle"}},  // commands keep their own order
      {.name = "fill", .reads = {"puddle"}},                       // needs both applied
      {.name = "drain", .writes = {"puddle"}},                     // already applied
      {.name = "script", .changes = {"*"}},
      {.name = "clock", .reads = {}},  // touches nothing
      {.name = "shine again", .reads = {"lamp"}},
  };
  EXPECT_EQ(sync_points(list), (std::vector<bool>{false, false, false, true, false, false, false, true}));
}

TEST(Schedule, CommandsArriveExactlyAtTheSyncPoint) {
  Context c;
  std::vector<std::size_t> seen;
  const auto look = [&](Context& x) { seen.push_back(x.registry.size<Puddle>()); };
  run({{.name = "spawn",
        .changes = {"puddle"},
        .run = [](Context& x) { x.commands.emplace<Puddle>(x.commands.create()); }},
       {.name = "blind", .reads = {"lamp"}, .run = look},
       {.name = "reader", .reads = {"puddle"}, .run = look},
       {.name = "late",
        .changes = {"puddle"},
        .run = [](Context& x) { x.commands.emplace<Puddle>(x.commands.create()); }}},
      c);
  EXPECT_EQ(seen, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(c.registry.size<Puddle>(), 2u) << "what is left is applied at the end";
}

TEST(Schedule, IdleSystemsAreSkipped) {
  Context c;
  const auto schemas = test_schemas();
  Schedule<Context> s({{.name = "lamps", .needs = {"lamp"}, .run = note("lamps")},
                       {.name = "either", .needs = {"lamp", "puddle"}, .run = note("either")},
                       {.name = "always", .run = note("always")}},
                      schemas);
  s.run(c, c.registry, c.commands);
  EXPECT_EQ(c.ran, (std::vector<std::string>{"always"}));
  EXPECT_EQ(s.stats()[0].skips, 1);
  c.ran.clear();
  const Entity e = c.registry.create();
  c.registry.emplace<Puddle>(e);
  s.run(c, c.registry, c.commands);
  EXPECT_EQ(c.ran, (std::vector<std::string>{"either", "always"}));
  c.ran.clear();
  c.registry.destroy(e);
  s.run(c, c.registry, c.commands);
  EXPECT_EQ(c.ran, (std::vector<std::string>{"always"}));
}

TEST(Schedule, AnIdleSystemWakesForWhatWasJustSpawned) {
  Context c;
  EXPECT_EQ(run({{.name = "spawn",
                  .changes = {"lamp"},
                  .run = [](Context& x) { x.commands.emplace<Lamp>(x.commands.create()); }},
                 {.name = "lamps", .needs = {"lamp"}, .run = note("lamps")}},
                c),
            (std::vector<std::string>{"lamps"}));
}

TEST(Schedule, Dependencies) {
  const auto pairs = [](std::vector<SystemAccess> list) {
    std::vector<std::string> out;
    for (const Conflict& x : conflicts(list)) {
      out.push_back(std::string(x.first) + "|" + std::string(x.second) + "|" + std::string(x.what));
    }
    return out;
  };
  using Pairs = std::vector<std::string>;
  // Write against read, read against write, write against write; two readers do not mind each other.
  EXPECT_EQ(pairs({{.name = "a", .writes = {"x"}}, {.name = "b", .reads = {"x"}}}), Pairs{"a|b|x"});
  EXPECT_EQ(pairs({{.name = "a", .reads = {"x"}}, {.name = "b", .writes = {"x"}}}), Pairs{"a|b|x"});
  EXPECT_EQ(pairs({{.name = "a", .writes = {"x"}}, {.name = "b", .writes = {"x"}}}), Pairs{"a|b|x"});
  EXPECT_EQ(pairs({{.name = "a", .reads = {"x"}}, {.name = "b", .reads = {"x"}}}), Pairs{});
  EXPECT_EQ(pairs({{.name = "a", .writes = {"x"}}, {.name = "b", .reads = {"y"}}}), Pairs{});
  // Adding and removing counts as writing; so does needing as reading.
  EXPECT_EQ(pairs({{.name = "a", .changes = {"x"}}, {.name = "b", .needs = {"x"}}}), Pairs{"a|b|x"});
  EXPECT_EQ(pairs({{.name = "a", .reads = {"x"}}, {.name = "b", .changes = {"*"}}}), Pairs{"a|b|x"});
  // Declared order settles it, also through a third; another phase is an order already.
  EXPECT_EQ(pairs({{.name = "a", .writes = {"x"}}, {.name = "b", .reads = {"x"}, .after = {"a"}}}), Pairs{});
  EXPECT_EQ(pairs({{.name = "a", .writes = {"x"}},
                   {.name = "b", .after = {"a"}},
                   {.name = "c", .reads = {"x"}, .after = {"b"}}}),
            Pairs{});
  EXPECT_EQ(pairs({{.name = "a", .phase = Phase::script, .writes = {"x"}}, {.name = "b", .reads = {"x"}}}), Pairs{});
  // Being after a third settles nothing between the two.
  EXPECT_EQ(pairs({{.name = "z"},
                   {.name = "a", .writes = {"x"}, .after = {"z"}},
                   {.name = "b", .reads = {"x"}, .after = {"z"}}}),
            Pairs{"a|b|x"});
}

TEST(Schedule, ProblemsAreNamed) {
  const auto schemas = test_schemas();
  const auto all = [&](std::vector<SystemAccess> list) {
    const std::string_view resources[] = {"time"};
    std::string text;
    for (const std::string& p : problems(list, schemas, resources)) text += p + "\n";
    return text;
  };
  EXPECT_EQ(all({{.name = "a", .reads = {"lamp", "time"}, .writes = {"shadows"}, .needs = {"lamp"}},
                 {.name = "b", .reads = {"shadows"}, .changes = {"puddle", "*"}, .after = {"a"}}}),
            "");
  EXPECT_NE(all({{.name = "a"}, {.name = "a"}}).find("used twice"), std::string::npos);
  EXPECT_NE(all({{.name = "a", .reads = {"lamb"}}}).find("did you mean \"lamp\"?"), std::string::npos);
  EXPECT_NE(all({{.name = "a", .needs = {"shadows"}}}).find("no schema"), std::string::npos);
  EXPECT_NE(all({{.name = "a", .after = {"b"}}, {.name = "b"}}).find("no earlier entry"), std::string::npos);
  EXPECT_NE(all({{.name = "a", .phase = Phase::input}, {.name = "b", .after = {"a"}}}).find("no earlier entry"),
            std::string::npos);
  EXPECT_NE(all({{.name = "a", .changes = {"nothing"}}}).find("no component"), std::string::npos);
}

// A system that only reads can be handed a const registry: what it can call is what it declared.
TEST(Schedule, ConstRegistry) {
  Context c;
  c.registry.emplace<Lamp>(c.registry.create(), 5.0f);
  float seen = 0.0f;
  const auto reader = [&](const Registry& r) {
    r.view<Lamp>().each([&](const Lamp& lamp) { seen += lamp.intensity_cd; });
  };
  run({{.name = "reader", .reads = {"lamp"}, .run = [&](Context& x) { reader(x.registry); }}}, c);
  EXPECT_EQ(seen, 5.0f);
}

}  // namespace
}  // namespace petrichor
