// Tables that scripts return, as JSON.

#include <unistd.h>

#include "tests/engine/script/fixture.hpp"

namespace petrichor {
namespace {

using nlohmann::json;

class ReadTable : public ScriptTest {
 protected:
  json value(const std::string& text) {
    const auto result = read_table(write("t.lua", text), options);
    EXPECT_TRUE(result) << result.error().message;
    return result.value_or(json());
  }
  std::string message(const std::string& text) {
    const auto result = read_table(write("t.lua", text), options);
    EXPECT_FALSE(result) << *result;
    return result ? "" : result.error().message;
  }
};

TEST_F(ReadTable, TablesBecomeJson) {
  EXPECT_EQ(value("return {1, 2.5, 'x', true, {a={b={}}}}"), json::parse(R"([1, 2.5, "x", true, {"a": {"b": {}}}])"));
  EXPECT_EQ(value("return {passes={{name='gbuffer', writes={'depth', 'albedo'}}}, size={640, 360}}"),
            json::parse(R"({"passes": [{"name": "gbuffer", "writes": ["depth", "albedo"]}], "size": [640, 360]})"));
  EXPECT_EQ(value("return {10, 20, name='mixed'}"), json::parse(R"({"1": 10, "2": 20, "name": "mixed"})"));
  EXPECT_EQ(value("return {[1]=1, [3]=3}"), json::parse(R"({"1": 1, "3": 3})"));
  EXPECT_EQ(value("return {[-1]=1, [0]=2}"), json::parse(R"({"-1": 1, "0": 2})"));
  EXPECT_EQ(value("return {}"), json::object());
  EXPECT_EQ(value("return {v=vec3 and 1 or 0, i=9007199254740993, f=3.0}"),
            json::parse(R"({"v": 0, "i": 9007199254740993, "f": 3.0})"));
  EXPECT_TRUE(value("return {3}")[0].is_number_integer());
  EXPECT_TRUE(value("return {3.0}")[0].is_number_float());
  // The same table in two places is no cycle.
  EXPECT_EQ(value("local t = {1} return {t, t}"), json::parse("[[1], [1]]"));
}

TEST_F(ReadTable, WhatIsNoDataIsAnErrorWithItsPlace) {
  EXPECT_CONTAINS(message("return {passes={1, {run=print}}}"), "passes[2].run: a function");
  EXPECT_CONTAINS(message("return {passes={1, {run=print}}}"), "t.lua");
  EXPECT_CONTAINS(message("return {a=coroutine.create(print)}"), ".a: a thread");
  EXPECT_CONTAINS(message("return {a={0/0}}"), "a[1]");
  EXPECT_CONTAINS(message("return {a=-math.huge}"), ".a: -inf");
  EXPECT_CONTAINS(message("return {a='\\xff'}"), "UTF-8");
  EXPECT_CONTAINS(message("return {['\\xff']=1}"), "UTF-8");
  EXPECT_CONTAINS(message("return {[true]=1}"), "boolean as a key");
  EXPECT_CONTAINS(message("return {[1.5]=1}"), "number as a key");
  EXPECT_CONTAINS(message("return {[1]=1, ['1']=2, x=1}"), "number and as a string");
  EXPECT_CONTAINS(message("local t = {} t.self = {t} return t"), "contains itself");
  EXPECT_CONTAINS(message("local t = {} for i = 1, 100 do t = {t} end return t"), "deep");
  EXPECT_CONTAINS(message("local t = {1} for i = 1, 40 do t = {t, t} end return t"), "values");
  EXPECT_CONTAINS(message("return 5"), "expected a table");
  EXPECT_CONTAINS(message("local x = 1"), "expected a table");
  EXPECT_CONTAINS(message("coroutine.yield()"), "yield");
  EXPECT_CONTAINS(message("error('wet')"), "t.lua:1: wet");
  EXPECT_CONTAINS(message("return = 3"), "t.lua:1:");
  // No metamethod of the script runs, or hides, anything.
  EXPECT_EQ(value("return setmetatable({a=1}, {__index={b=2}, __pairs=error, __len=error})"),
            json::parse(R"({"a": 1})"));
}

TEST_F(ReadTable, ItIsASandboxOfItsOwn) {
  expect_ok("leaked = 1");
  EXPECT_EQ(value("return {world=type(world), leaked=type(leaked), wait=type(wait), os=type(os)}"),
            json::parse(R"({"world": "nil", "leaked": "nil", "wait": "nil", "os": "nil"})"));
  options.limits.load_instructions = 1'000'000;
  EXPECT_CONTAINS(message("while true do end"), "million instructions");
  options.limits.memory_bytes = 8 << 20;
  EXPECT_CONTAINS(message("local s = 'x' while true do s = s .. s end"), "MiB of memory");
}

TEST_F(ReadTable, ItTellsWhichFilesItRead) {
  write("sizes.lua", "return {640, 360}");
  std::vector<std::filesystem::path> files;
  ASSERT_TRUE(read_table(write("t.lua", "return {size=require('sizes')}"), options, &files));
  EXPECT_EQ(files, (std::vector<std::filesystem::path>{folder / "t.lua", folder / "sizes.lua"}));
  files.clear();
  ASSERT_FALSE(read_table(write("t.lua", "return {size=require('size')}"), options, &files));
  EXPECT_EQ(files, (std::vector<std::filesystem::path>{folder / "t.lua"}));
}

}  // namespace
}  // namespace petrichor
