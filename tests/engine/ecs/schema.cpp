#include "engine/ecs/schema.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/ecs/schema_reference.hpp"

namespace petrichor {
namespace {

using nlohmann::json;

enum class Shape : std::uint8_t { round, flat, torn };
constexpr std::array<std::string_view, 3> shapes{"round", "flat", "torn"};

// One member of each kind, narrow integers among them, with a guard on either side of each.
struct Everything {
  bool flag = false;
  std::int8_t tiny = -5;
  std::uint16_t small = 5;
  std::int64_t wide = 0;
  std::uint64_t wider = 0;
  float real = 0.5f;
  double exact = 0.1;
  glm::vec2 flat{1, 2};
  glm::quat turn{1, 0, 0, 0};
  Shape shape = Shape::flat;
  std::string text = "a|b<c";
};

const Schema& everything() {
  constexpr Range any{};
  static const Schema s = schema<Everything>(
      "everything", "One of each.",
      {field<&Everything::flag>("flag", "", any, "A flag."), field<&Everything::tiny>("tiny", "", any, "8 bits."),
       field<&Everything::small>("small", "", {0, 1000}, "16 bits."),
       field<&Everything::wide>("wide", "", any, "64 bits."), field<&Everything::wider>("wider", "", any, "64 bits."),
       field<&Everything::real>("real", "m", {0.1, 0.7}, "Single."),
       field<&Everything::exact>("exact", "", any, "Double."), field<&Everything::flat>("flat", "", any, "Two."),
       field<&Everything::turn>("turn", "", {-1, 1}, "A rotation."),
       field<&Everything::shape>("shape", "", any, "A choice.", shapes),
       field<&Everything::text>("text", "", any, "Words | bars.")});
  return s;
}

Result<void> write(Everything& e, std::string_view name, const json& value) {
  return write_field(everything(), *find_field(everything(), name), &e, value);
}
std::string message(const Result<void>& r) {
  return r ? "no error" : r.error().message;
}

TEST(Schema, FindsByName) {
  const std::vector<Schema> all{everything()};
  EXPECT_EQ(find_schema(all, "everything"), &all[0]);
  EXPECT_EQ(find_schema(all, "nothing"), nullptr);
  EXPECT_EQ(find_field(everything(), "real"), &everything().fields[5]);
  EXPECT_EQ(find_field(everything(), "Real"), nullptr);
}

TEST(Schema, ReadsEveryKind) {
  const Everything e;
  const auto read = [&](std::string_view name) { return read_field(*find_field(everything(), name), &e); };
  EXPECT_EQ(read("flag"), false);
  EXPECT_EQ(read("tiny"), -5);
  EXPECT_EQ(read("small"), 5);
  EXPECT_EQ(read("exact"), 0.1);
  EXPECT_EQ(read("flat"), json::array({1, 2}));
  EXPECT_EQ(read("turn"), json::array({0, 0, 0, 1})) << "x, y, z, w";
  EXPECT_EQ(read("shape"), "flat");
  EXPECT_EQ(read("text"), "a|b<c");
}

TEST(Schema, IntegersKeepTheirWidth) {
  Everything e;
  EXPECT_TRUE(write(e, "tiny", -128));
  EXPECT_FALSE(write(e, "tiny", -129));
  EXPECT_FALSE(write(e, "tiny", 128));
  EXPECT_EQ(e.tiny, -128);
  EXPECT_EQ(e.flag, false);
  EXPECT_EQ(e.small, 5);
  EXPECT_FALSE(write(e, "small", 1001)) << "fits 16 bits, not the range";
  EXPECT_TRUE(write(e, "small", 12.0)) << "a whole number in a float, as Lua makes them";
  EXPECT_EQ(e.small, 12);
  EXPECT_TRUE(write(e, "wide", std::numeric_limits<std::int64_t>::min()));
  EXPECT_EQ(e.wide, std::numeric_limits<std::int64_t>::min());
  EXPECT_FALSE(write(e, "wide", std::numeric_limits<std::uint64_t>::max()));
  EXPECT_TRUE(write(e, "wider", std::numeric_limits<std::uint64_t>::max()));
  EXPECT_EQ(e.wider, std::numeric_limits<std::uint64_t>::max());
  EXPECT_FALSE(write(e, "wider", -1));
  EXPECT_FALSE(write(e, "wider", 1e300));
}

TEST(Schema, RangesAreComparedAsTheMemberHoldsThem) {
  Everything e;
  EXPECT_TRUE(write(e, "real", 0.1)) << "0.1f is above 0.1 by an eighth of a billionth: still inside";
  EXPECT_TRUE(write(e, "real", 0.7)) << "0.7f is below 0.7";
  EXPECT_TRUE(write(e, "real", static_cast<double>(0.1f)));
  EXPECT_FALSE(write(e, "real", 0.0999));
  EXPECT_FALSE(write(e, "real", 0.7001));
  EXPECT_FALSE(write(e, "flat", json::array({1e300, 0}))) << "infinite as a float";
}

TEST(Schema, RotationsBecomeUnit) {
  Everything e;
  ASSERT_TRUE(write(e, "turn", json::array({0.6, 0, 0, 0.6})));
  EXPECT_NEAR(glm::length(e.turn), 1.0f, 1e-6f);
  EXPECT_NEAR(e.turn.x, 0.70710678f, 1e-6f);
  EXPECT_FALSE(write(e, "turn", json::array({0, 0, 0, 0}))) << "no direction at all";
  EXPECT_FALSE(write(e, "turn", json::array({0, 0, 1})));
}

TEST(Schema, MessagesSayWhatCameAndWhatWasExpected) {
  Everything e;
  EXPECT_EQ(message(write(e, "real", -3)), "everything.real: got -3, expected a finite number from 0.1 to 0.7 m");
  EXPECT_EQ(message(write(e, "flag", "yes")), "everything.flag: got the string \"yes\", expected true or false");
  EXPECT_EQ(message(write(e, "shape", "falt")),
            "everything.shape: got the string \"falt\", expected one of \"round\", \"flat\", \"torn\"; did you mean "
            "\"flat\"?");
  EXPECT_NE(message(write(e, "flat", json::array({0, NAN}))).find("flat[1]: got nan"), std::string::npos);
  EXPECT_NE(message(write(e, "real", std::string(100000, 'x'))).find("100000 bytes"), std::string::npos);
  EXPECT_LT(message(write(e, "real", std::string(100000, 'x'))).size(), 400u) << "a message, not the whole value";
  const std::string unknown = message(write_fields(everything(), &e, {{"reel", 1}}));
  EXPECT_EQ(unknown.rfind("everything has no field \"reel\"; did you mean \"real\"? Known: flag, tiny", 0), 0u)
      << unknown;
}

TEST(Schema, WriteFieldsIsAllOrNothing) {
  Everything e;
  EXPECT_FALSE(write_fields(everything(), &e, {{"flag", true}, {"real", 0.6}, {"tiny", 1000}}));
  EXPECT_EQ(e.flag, false);
  EXPECT_EQ(e.real, 0.5f);
  EXPECT_TRUE(write_fields(everything(), &e, {{"flag", true}, {"real", 0.6}, {"tiny", 100}}));
  EXPECT_EQ(e.flag, true);
  EXPECT_EQ(e.tiny, 100);
  EXPECT_TRUE(write_fields(everything(), &e, json::object()));
}

TEST(Schema, ReferenceEscapesWhatWouldBreakTheTable) {
  const std::vector<Schema> all{everything()};
  const std::string page = schema_reference(all);
  EXPECT_NE(page.find("| `text` | text |  | \"a\\|b&lt;c\" |  | Words \\| bars. |"), std::string::npos) << page;
  EXPECT_NE(page.find("| `real` | number | m | 0.5 | 0.1 to 0.7 | Single. |"), std::string::npos) << page;
  EXPECT_NE(page.find("| `exact` | number |  | 0.1 |"), std::string::npos) << page;
}

}  // namespace
}  // namespace petrichor
