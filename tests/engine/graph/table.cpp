#include "engine/graph/table.hpp"

#include <gtest/gtest.h>

#include "tests/engine/graph/graph_test.hpp"

namespace petrichor {
namespace {

using nlohmann::json;

class TableTest : public ::testing::Test {
 protected:
  std::string error(const char* text) {
    auto table = read_table(json::parse(text), "city.lua", offers);
    return table ? "(no error)" : table.error().message;
  }
  void expect(const char* text, std::initializer_list<const char*> parts) {
    const std::string message = error(text);
    for (const char* part : parts) EXPECT_NE(message.find(part), std::string::npos) << "in: " << message;
  }
  test::Seen seen;
  std::vector<PassOffer> offers = test::offers(seen);
};

#define RESOURCES                                                                          \
  R"("resources": {"a": {"format": "rgba16f"}, "b": {"format": "rgba16f", "scale": 0.5},)" \
  R"( "d": {"format": "depth32f"}, "h": {"format": "r32f", "history": true}},)"

TEST_F(TableTest, ReadsPassesInBothWaysOfWritingThem) {
  auto table = read_table(json::parse("{" RESOURCES R"("passes": [{"1": "fill", "out": "a", "parameters": {"value": 3}},
      {"pass": "copy", "id": "second", "image": "a", "out": "b"}], "output": "b"})"),
                          "city.lua", offers);
  ASSERT_TRUE(table) << table.error().message;
  ASSERT_EQ(table->passes.size(), 2u);
  EXPECT_EQ(table->passes[0].id, "fill");
  EXPECT_EQ(table->passes[0].parameters.at("value"), 3.0);
  EXPECT_EQ(table->passes[1].id, "second");
  EXPECT_EQ(table->passes[1].offer->name, "copy");
  EXPECT_EQ(table->resources[table->output].name, "b");
}

TEST_F(TableTest, EmptyLuaTablesAreListsAndMapsAlike) {
  expect(R"({"resources": [], "passes": [], "output": "a"})", {"city.lua: output: unknown resource \"a\""});
  auto table = read_table(json::parse("{" RESOURCES R"("passes": [{"pass": "fill", "out": "a", "parameters": []}],
      "output": "a"})"),
                          "city.lua", offers);
  EXPECT_TRUE(table);
}

TEST_F(TableTest, WrongShapes) {
  expect("[1]", {"city.lua: ", "table"});
  expect("3", {"city.lua: ", "table"});
  expect(R"({"passes": [], "output": "a"})", {"resources is missing"});
  expect(R"({"resources": {}, "output": "a"})", {"passes is missing"});
  expect("{" RESOURCES R"("passes": []})", {"output is missing"});
  expect("{" RESOURCES R"("passes": {"x": 1}, "output": "a"})", {"passes: expected a list"});
  expect("{" RESOURCES R"("passes": [3], "output": "a"})", {"passes[1]: expected a table, got number"});
  expect("{" RESOURCES R"("passes": [{}], "output": "a"})", {"passes[1]: names no pass"});
  expect("{" RESOURCES R"("passes": [{"pass": 3}], "output": "a"})", {"passes[1].pass: expected a string, got number"});
  expect("{" RESOURCES R"("passes": [], "output": 1})", {"output: expected a string"});
  expect("{" RESOURCES R"("passes": [], "outputs": "a"})", {"unknown key \"outputs\"", "did you mean \"output\""});
  expect(R"({"resources": [1], "passes": [], "output": "a"})", {"resources: expected"});
}

TEST_F(TableTest, WrongResources) {
  const auto resource = [&](const std::string& body) {
    return error((R"({"resources": {"x": )" + body + R"(}, "passes": [], "output": "x"})").c_str());
  };
  const auto holds = [](const std::string& message, const std::string& part) {
    EXPECT_NE(message.find(part), std::string::npos) << message;
  };
  holds(resource(R"({"format": "rgba16"})"), "no pass writes \"x\"");
  holds(resource(R"({"format": "rgba61f"})"),
        "resources.x.format: unknown format \"rgba61f\"; did you mean \"rgba16f\"?");
  holds(resource(R"({"format": 3})"), "resources.x.format: expected a string");
  holds(resource("{}"), "resources.x: format is missing");
  holds(resource("7"), "resources.x: expected a table, got number");
  holds(resource(R"({"format": "r8", "scale": 0})"), "resources.x.scale: 0 is outside");
  holds(resource(R"({"format": "r8", "scale": "1"})"), "resources.x.scale: expected a number, got string");
  holds(resource(R"({"format": "r8", "width": 16})"), "width and height go together");
  holds(resource(R"({"format": "r8", "width": 1.5, "height": 2})"), "width: expected a whole number");
  holds(resource(R"({"format": "r8", "width": 100000, "height": 2})"), "resources.x.width: 100000 is outside");
  holds(resource(R"({"format": "r8", "width": 8, "height": 8, "scale": 1})"), "both scale and width");
  holds(resource(R"({"format": "r8", "history": 1})"), "history: expected true or false");
  holds(resource(R"({"format": "r8", "history": true, "persistent": true})"), "both history and persistent");
  holds(resource(R"({"format": "r8", "clear": [1, 2, 3, 4, 5]})"), "clear: expected 1 to 4 numbers, got 5");
  holds(resource(R"({"format": "r8", "clear": "red"})"), "clear: expected a number or a list");
  holds(resource(R"({"format": "none", "persistent": true})"), "has no texture");
  holds(resource(R"({"format": "r8", "mip": 1})"), "unknown key \"mip\"; did you mean \"mips\"?");
  holds(error(R"({"resources": {"previous:x": {"format": "r8"}}, "passes": [], "output": "x"})"), "holds no \":\"");
}

TEST_F(TableTest, WrongPasses) {
  const auto expect_pass = [&](const std::string& body, std::initializer_list<const char*> parts) {
    expect(("{" RESOURCES R"("passes": [{"pass": "fill", "out": "a"}, )" + body + R"(], "output": "a"})").c_str(),
           parts);
  };
  expect_pass(R"({"pass": "coppy"})", {"passes[2]: unknown pass \"coppy\"; did you mean \"copy\"? Known: ", "measure"});
  expect_pass(R"({"pass": "copy", "imagee": "a"})",
              {"passes[2] (copy): unknown slot \"imagee\"; did you mean \"image\"?"});
  expect_pass(R"({"pass": "copy", "image": "a"})", {"passes[2] (copy): slot \"out\" is not connected", "writes"});
  expect_pass(R"({"pass": "copy", "out": "b"})", {"slot \"image\" is not connected", "reads"});
  expect_pass(R"({"pass": "copy", "image": "aa", "out": "b"})",
              {"passes[2] (copy).image: unknown resource \"aa\"; did you mean \"a\"? Known: a, b, d, h"});
  expect_pass(R"({"pass": "copy", "image": 3, "out": "b"})", {"passes[2] (copy).image: expected a string, got number"});
  expect_pass(R"({"pass": "fill", "out": "b"})", {"passes[2]: a second pass \"fill\"; give it an id"});
  expect_pass(R"({"pass": "add", "id": "fill", "target": "a"})", {"a second pass \"fill\""});
  expect_pass(R"({"pass": "add", "target": "a", "parameters": {"amout": 1}})",
              {"(add).parameters: unknown parameter \"amout\"; did you mean \"amount\"?"});
  expect_pass(R"({"pass": "add", "target": "a", "parameters": {"amount": "1"}})",
              {"(add).parameters.amount: expected a number, got string"});
  expect_pass(R"({"pass": "add", "target": "a", "parameters": 4})", {"parameters: expected a table"});
  expect_pass(R"({"pass": "copy", "parameters": {"x": 1}, "image": "a", "out": "b"})",
              {"unknown parameter \"x\"; there is none"});
  expect_pass(R"({"pass": "add", "target": "a", "enabled": "no"})", {"enabled: expected true or false"});
}

TEST_F(TableTest, WrongOrder) {
  expect("{" RESOURCES R"("passes": [{"pass": "copy", "image": "b", "out": "a"}], "output": "a"})",
         {"passes[1] (copy).image: \"b\" is read but no pass writes it"});
  expect("{" RESOURCES R"("passes": [{"pass": "copy", "image": "b", "out": "a"}, {"pass": "fill", "out": "b"}],
      "output": "a"})",
         {"passes[1] (copy).image: \"b\" is read before any pass has written it"});
  expect("{" RESOURCES R"("passes": [{"pass": "copy", "image": "a", "out": "a"}], "output": "a"})",
         {"\"a\" is read before"});
  expect("{" RESOURCES R"("passes": [{"pass": "add", "target": "a"}], "output": "a"})",
         {"(add).target: \"a\" is read"});
  expect("{" RESOURCES R"("passes": [{"pass": "fill", "out": "a"}], "output": "b"})", {"output: no pass writes \"b\""});
  expect("{" RESOURCES R"("passes": [{"pass": "fill", "out": "a"}], "output": "c"})",
         {"output: unknown resource \"c\""});
}

TEST_F(TableTest, WrongHistory) {
  expect("{" RESOURCES R"("passes": [{"pass": "copy", "image": "previous:b", "out": "b"}], "output": "b"})",
         {"\"b\" keeps no history; declare it with history = true"});
  expect("{" RESOURCES R"("passes": [{"pass": "fill", "out": "previous:h"}], "output": "h"})",
         {"last frame's h can only be read"});
  expect("{" RESOURCES R"("passes": [{"pass": "copy", "image": "previous:h", "out": "a"}], "output": "a"})",
         {"\"h\" is read but no pass writes it"});
  expect("{" RESOURCES R"("passes": [{"pass": "fill", "out": "h"}], "output": "previous:h"})",
         {"output: is last frame's"});
  expect("{" RESOURCES R"("passes": [{"pass": "copy", "image": "previous:x", "out": "a"}], "output": "a"})",
         {"unknown resource \"x\""});
}

TEST_F(TableTest, OneResourceInTwoSlots) {
  expect("{" RESOURCES R"("passes": [{"pass": "fill", "out": "a"},
      {"pass": "mix", "image": "a", "out": "b", "debug": "b"}], "output": "b"})",
         {"passes[2] (mix): slots \"out\" and \"debug\" are both \"b\""});
  expect(R"({"resources": {"p": {"format": "r8", "persistent": true}}, "passes": [{"pass": "fill", "out": "p"},
      {"pass": "copy", "image": "p", "out": "p"}], "output": "p"})",
         {"slots \"image\" and \"out\" are both \"p\""});
}

TEST_F(TableTest, WrongArtistPasses) {
  const auto expect_pass = [&](const std::string& body, std::initializer_list<const char*> parts) {
    expect(("{" RESOURCES R"("passes": [{"pass": "fill", "out": "a"}, )" + body + R"(], "output": "a"})").c_str(),
           parts);
  };
  expect_pass(R"({"compute": 3})", {"passes[2].compute: expected a string"});
  expect_pass(R"({"compute": "x.glsl"})", {"ends in .comp.glsl"});
  expect_pass(R"({"compute": "x.comp.glsl"})", {"passes[2] (x): writes nothing"});
  expect_pass(R"({"compute": "x.comp.glsl", "writes": {}})", {"unknown key \"writes\"; did you mean \"write\"?"});
  expect_pass(R"({"compute": "x.comp.glsl", "write": "a"})", {"(x).write: expected a table"});
  expect_pass(R"({"compute": "x.comp.glsl", "write": {"o": "q"}})", {"(x).write.o: unknown resource \"q\""});
  expect_pass(R"({"compute": "x.comp.glsl", "write": {"o": "d"}})",
              {"\"d\" is depth32f, which no compute shader can write"});
  expect_pass(R"({"compute": "x.comp.glsl", "read": {"o": "a"}, "write": {"o": "b"}})", {"named twice"});
  expect_pass(R"({"compute": "x.comp.glsl", "write": {"o": "b"}, "parameters": {"p": "x"}})",
              {"(x).parameters.p: expected a number"});
  expect_pass(R"({"compute": "x.comp.glsl", "write": {"o": "b"}, "name": "fill"})", {"a second pass \"fill\""});
}

}  // namespace
}  // namespace petrichor
