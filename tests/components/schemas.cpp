// What must hold of every schema the program knows: its fields can be read, written, refused and described.

#include <gtest/gtest.h>

#include <cctype>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "components/components.hpp"
#include "engine/ecs/schema_reference.hpp"

namespace petrichor {
namespace {

using nlohmann::json;

class EverySchema : public testing::TestWithParam<std::size_t> {
 protected:
  const Schema& schema = component_schemas()[GetParam()];
  Registry registry;
  void* component = schema.emplace(registry, registry.create());

  std::string refused(const Field& f, const json& value) {
    const json before = read_field(f, component);
    const Result<void> result = write_field(schema, f, component, value);
    EXPECT_FALSE(result) << schema.name << "." << f.name << " took " << value;
    EXPECT_EQ(read_field(f, component), before) << "a refused value changed the component";
    return result ? "" : result.error().message;
  }
};

// Another value than the default, within the range.
json other_value(const Field& f, const json& present) {
  const double low = std::isfinite(f.minimum) ? f.minimum : -100.0;
  const double high = std::isfinite(f.maximum) ? f.maximum : 100.0;
  const auto between = [&](double share) { return static_cast<float>(low + share * (high - low)); };
  switch (f.type) {
    case FieldType::boolean:
      return !present.get<bool>();
    case FieldType::integer:
      return static_cast<std::int64_t>(low + 0.25 * (high - low));
    case FieldType::real:
      return between(0.25);
    case FieldType::vec2:
      return {between(0.25), between(0.75)};
    case FieldType::vec3:
    case FieldType::colour:
      return {between(0.25), between(0.5), between(0.75)};
    case FieldType::rotation:
      return {0.0, 1.0, 0.0, 0.0};
    case FieldType::text:
      return "the corner of the toy shop";
    case FieldType::choice:
      return std::string(f.choices.back());
  }
  return nullptr;
}

TEST_P(EverySchema, NamesAreSnakeCaseAndDescribed) {
  const auto is_snake = [](std::string_view name) {
    for (const char c : name) {
      if (!std::islower(static_cast<unsigned char>(c)) && !std::isdigit(static_cast<unsigned char>(c)) && c != '_')
        return false;
    }
    return !name.empty();
  };
  EXPECT_TRUE(is_snake(schema.name)) << schema.name;
  EXPECT_FALSE(schema.meaning.empty());
  std::set<std::string_view> names;
  for (const Field& f : schema.fields) {
    EXPECT_TRUE(is_snake(f.name)) << schema.name << "." << f.name;
    EXPECT_TRUE(names.insert(f.name).second) << schema.name << "." << f.name << " twice";
    EXPECT_FALSE(f.meaning.empty()) << schema.name << "." << f.name;
    EXPECT_LE(f.minimum, f.maximum) << schema.name << "." << f.name;
    EXPECT_EQ(f.type == FieldType::choice, !f.choices.empty()) << schema.name << "." << f.name;
  }
}

TEST_P(EverySchema, DefaultsAreInRangeAndRoundTrip) {
  json whole = json::object();
  for (const Field& f : schema.fields) {
    const json value = read_field(f, component);
    ASSERT_FALSE(value.is_null()) << schema.name << "." << f.name;
    const Result<void> result = write_field(schema, f, component, value);
    EXPECT_TRUE(result) << result.error().message;
    EXPECT_EQ(read_field(f, component), value) << schema.name << "." << f.name;
    whole[std::string(f.name)] = value;
  }
  const Result<void> result = write_fields(schema, component, json::parse(whole.dump()));
  EXPECT_TRUE(result) << result.error().message;
}

TEST_P(EverySchema, OtherValuesRoundTripAndTouchOneFieldOnly) {
  for (const Field& f : schema.fields) {
    json before;
    for (const Field& g : schema.fields) before[std::string(g.name)] = read_field(g, component);
    const json value = other_value(f, read_field(f, component));
    const Result<void> result = write_field(schema, f, component, value);
    ASSERT_TRUE(result) << result.error().message;
    for (const Field& g : schema.fields) {
      const json expected = &g == &f ? value : before[std::string(g.name)];
      EXPECT_EQ(read_field(g, component), expected) << schema.name << "." << g.name << " after writing " << f.name;
    }
  }
}

TEST_P(EverySchema, WrongTypesAndRangesAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Field& f : schema.fields) {
    const std::string place = std::string(schema.name) + "." + std::string(f.name);
    EXPECT_NE(refused(f, nullptr).find(place), std::string::npos) << "the message must name " << place;
    refused(f, json::object());
    const json inside = other_value(f, read_field(f, component));
    switch (f.type) {
      case FieldType::boolean:
        refused(f, 1);
        break;
      case FieldType::text:
        refused(f, 5);
        break;
      case FieldType::choice:
        EXPECT_NE(refused(f, "no such choice").find(f.choices.front()), std::string::npos);
        refused(f, 0);
        break;
      case FieldType::integer:
        refused(f, 0.5);
        refused(f, "1");
        refused(f, 1e30);
        [[fallthrough]];
      case FieldType::real:
        refused(f, nan);
        refused(f, true);
        refused(f, std::numeric_limits<double>::infinity());
        if (std::isfinite(f.minimum)) refused(f, f.minimum - 1.0);
        if (std::isfinite(f.maximum)) refused(f, f.maximum + (f.maximum > 1e6 ? f.maximum : 1.0));
        break;
      default: {
        json shorter = inside, odd = inside, outside = inside, worded = inside;
        shorter.erase(shorter.size() - 1);
        refused(f, shorter);
        odd[1] = nan;
        EXPECT_NE(refused(f, odd).find(place + "[1]"), std::string::npos) << "the message must name the element";
        worded[0] = "x";
        refused(f, worded);
        if (std::isfinite(f.maximum)) {
          outside[0] = f.maximum * 2.0 + 1.0;
          refused(f, outside);
        }
      }
    }
  }
}

TEST_P(EverySchema, UnknownKeysListTheKnownOnes) {
  const Result<void> result = write_fields(schema, component, {{"no_such_field", 1}});
  ASSERT_FALSE(result);
  for (const Field& f : schema.fields) EXPECT_NE(result.error().message.find(f.name), std::string::npos);
  EXPECT_FALSE(write_fields(schema, component, 5));
  EXPECT_FALSE(write_fields(schema, component, json::array()));
}

TEST_P(EverySchema, StorageOperations) {
  const Entity e = schema.entities(registry).front();
  EXPECT_EQ(schema.count(registry), 1u);
  EXPECT_EQ(schema.find(registry, e), component);
  EXPECT_EQ(schema.emplace(registry, e), component) << "emplace finds what is there";
  schema.remove(registry, e);
  EXPECT_EQ(schema.find(registry, e), nullptr);
  EXPECT_EQ(schema.count(registry), 0u);
  EXPECT_TRUE(schema.entities(registry).empty());
}

INSTANTIATE_TEST_SUITE_P(Components, EverySchema, testing::Range<std::size_t>(0, component_schemas().size()),
                         [](const auto& info) { return std::string(component_schemas()[info.param].name); });

TEST(Schemas, NamesAreUnique) {
  std::set<std::string_view> names;
  for (const Schema& s : component_schemas()) EXPECT_TRUE(names.insert(s.name).second) << s.name;
}

TEST(Schemas, ReferenceShowsEveryFieldAndReadableDefaults) {
  const std::string page = schema_reference(component_schemas());
  for (const Schema& s : component_schemas()) {
    EXPECT_NE(page.find("\n## " + std::string(s.name) + "\n"), std::string::npos) << s.name;
    for (const Field& f : s.fields)
      EXPECT_NE(page.find("| `" + std::string(f.name) + "` |"), std::string::npos) << f.name;
  }
  // The bloom of a fresh camera, as its header writes it.
  const std::string bloom = page.substr(page.find("| `bloom` |"), 40);
  EXPECT_NE(bloom.find("| 0.06 |"), std::string::npos) << bloom;
}

}  // namespace
}  // namespace petrichor
