#include "engine/ecs/schema.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "engine/core/names.hpp"

namespace petrichor {
namespace {

using nlohmann::json;

// Where a value stands, for messages: component, field and, in a vector, the element.
struct Place {
  const Schema& schema;
  const Field& field;
  int element = -1;
};

std::string shown(std::string_view text) {
  constexpr std::size_t longest = 60;
  if (text.size() <= longest) return fmt::format("\"{}\"", text);
  return fmt::format("\"{}...\" ({} bytes)", text.substr(0, longest), text.size());
}

std::string came(const json& value) {
  switch (value.type()) {
    case json::value_t::null:
      return "null";
    case json::value_t::boolean:
      return value.get<bool>() ? "true" : "false";
    case json::value_t::number_integer:
      return fmt::format("{}", value.get<std::int64_t>());
    case json::value_t::number_unsigned:
      return fmt::format("{}", value.get<std::uint64_t>());
    case json::value_t::number_float:
      return fmt::format("{}", value.get<double>());
    case json::value_t::string:
      return "the string " + shown(value.get_ref<const std::string&>());
    case json::value_t::array:
      return fmt::format("an array of {}", value.size());
    case json::value_t::object:
      return "an object";
    default:
      return "something that is no JSON value";
  }
}

std::string range_words(const Field& f) {
  const std::string unit = f.unit.empty() ? std::string() : fmt::format(" {}", f.unit);
  const bool low = std::isfinite(f.minimum), high = std::isfinite(f.maximum);
  if (low && high) return fmt::format(" from {} to {}{}", f.minimum, f.maximum, unit);
  if (low) return fmt::format(" of at least {}{}", f.minimum, unit);
  if (high) return fmt::format(" of at most {}{}", f.maximum, unit);
  return unit.empty() ? unit : " in" + unit;
}

std::string expected_words(const Field& f) {
  switch (f.type) {
    case FieldType::boolean:
      return "true or false";
    case FieldType::integer:
      return "a whole number" + range_words(f);
    case FieldType::real:
      return "a finite number" + range_words(f);
    case FieldType::vec2:
      return "an array of 2 finite numbers" + range_words(f);
    case FieldType::vec3:
      return "an array of 3 finite numbers" + range_words(f);
    case FieldType::colour:
      return "an array [r, g, b] of 3 finite numbers (linear RGB)" + range_words(f);
    case FieldType::rotation:
      return "an array [x, y, z, w], a quaternion of length 1";
    case FieldType::text:
      return "a string";
    case FieldType::choice: {
      std::string words;
      for (const std::string_view c : f.choices) words += fmt::format("{} \"{}\"", words.empty() ? "one of" : ",", c);
      return words;
    }
  }
  return {};
}

tl::unexpected<Error> refused(const Place& p, const std::string& what, const std::string& hint = {}) {
  const std::string element = p.element < 0 ? std::string() : fmt::format("[{}]", p.element);
  return failure(fmt::format("{}.{}{}: got {}, expected {}{}", p.schema.name, p.field.name, element, what,
                             expected_words(p.field), hint));
}

template <class T>
Result<T> parse_real(const Place& p, const json& value) {
  if (!value.is_number()) return refused(p, came(value));
  const double number = value.get<double>();
  if (!std::isfinite(number)) return refused(p, came(value));
  // Compared as the member will hold it: 0.05f is above 0.05, and is in a range that ends there.
  const T narrowed = static_cast<T>(number);
  if (!std::isfinite(narrowed) || narrowed < static_cast<T>(p.field.minimum) ||
      narrowed > static_cast<T>(p.field.maximum)) {
    return refused(p, came(value));
  }
  return narrowed;
}

template <class T>
Result<T> parse_integer(const Place& p, const json& value) {
  const auto fits = [&](auto number) {
    return std::in_range<T>(number) && static_cast<double>(number) >= p.field.minimum &&
           static_cast<double>(number) <= p.field.maximum;
  };
  if (value.is_number_unsigned()) {
    if (const auto number = value.get<std::uint64_t>(); fits(number)) return static_cast<T>(number);
  } else if (value.is_number_integer()) {
    if (const auto number = value.get<std::int64_t>(); fits(number)) return static_cast<T>(number);
  } else if (value.is_number_float()) {
    const double number = value.get<double>();  // Lua's 3.0; whole numbers are exact up to 2^53
    if (std::abs(number) <= 9007199254740992.0 && number == std::trunc(number)) {
      if (const auto whole = static_cast<std::int64_t>(number); fits(whole)) return static_cast<T>(whole);
    }
  }
  return refused(p, came(value));
}

template <int N>
Result<glm::vec<N, float>> parse_vector(Place p, const json& value) {
  if (!value.is_array() || value.size() != N) return refused(p, came(value));
  glm::vec<N, float> out;
  for (p.element = 0; p.element < N; ++p.element) {
    const Result<float> x = parse_real<float>(p, value[static_cast<std::size_t>(p.element)]);
    if (!x) return tl::unexpected(x.error());
    out[p.element] = *x;
  }
  return out;
}

Result<glm::quat> parse_rotation(const Place& p, const json& value) {
  const Result<glm::vec4> v = parse_vector<4>(p, value);
  if (!v) return tl::unexpected(v.error());
  const float length = glm::length(*v);
  if (length < 0.5f) return refused(p, fmt::format("[{}, {}, {}, {}]", v->x, v->y, v->z, v->w));
  // An interpolated quaternion is shorter than 1; one that is as good as unit stays bit for bit.
  const glm::vec4 unit = std::abs(length - 1.0f) < 1e-6f ? *v : *v / length;
  return glm::quat(unit.w, unit.x, unit.y, unit.z);
}

Result<std::uint64_t> parse_choice(const Place& p, const json& value) {
  if (!value.is_string()) return refused(p, came(value));
  const auto& name = value.get_ref<const std::string&>();
  for (std::uint64_t i = 0; i < p.field.choices.size(); ++i) {
    if (p.field.choices[i] == name) return i;
  }
  const std::string_view near = nearest_name(name, p.field.choices);
  return refused(p, came(value), near.empty() ? std::string() : fmt::format("; did you mean \"{}\"?", near));
}

// Checks the value and, where target is not null, stores it.
template <class T>
Result<void> store(Result<T> parsed, void* target) {
  if (!parsed) return tl::unexpected(std::move(parsed.error()));
  if (target) *static_cast<T*>(target) = std::move(*parsed);
  return {};
}

Result<void> store_choice(Result<std::uint64_t> parsed, void* target, std::size_t size_bytes) {
  if (!parsed) return tl::unexpected(std::move(parsed.error()));
  if (!target) return {};
  const auto write = [&](auto number) { std::memcpy(target, &number, sizeof number); };
  switch (size_bytes) {
    case 1:
      write(static_cast<std::uint8_t>(*parsed));
      break;
    case 2:
      write(static_cast<std::uint16_t>(*parsed));
      break;
    case 4:
      write(static_cast<std::uint32_t>(*parsed));
      break;
    default:
      write(*parsed);
      break;
  }
  return {};
}

Result<void> store_integer(const Place& p, const json& value, void* target) {
  switch (p.field.size_bytes) {
    case 1:
      return p.field.is_signed ? store(parse_integer<std::int8_t>(p, value), target)
                               : store(parse_integer<std::uint8_t>(p, value), target);
    case 2:
      return p.field.is_signed ? store(parse_integer<std::int16_t>(p, value), target)
                               : store(parse_integer<std::uint16_t>(p, value), target);
    case 4:
      return p.field.is_signed ? store(parse_integer<std::int32_t>(p, value), target)
                               : store(parse_integer<std::uint32_t>(p, value), target);
    default:
      return p.field.is_signed ? store(parse_integer<std::int64_t>(p, value), target)
                               : store(parse_integer<std::uint64_t>(p, value), target);
  }
}

Result<void> check_and_store(const Schema& schema, const Field& f, const json& value, void* target) {
  const Place p{schema, f};
  switch (f.type) {
    case FieldType::boolean:
      if (!value.is_boolean()) return refused(p, came(value));
      return store(Result<bool>(value.get<bool>()), target);
    case FieldType::integer:
      return store_integer(p, value, target);
    case FieldType::real:
      return f.size_bytes == sizeof(double) ? store(parse_real<double>(p, value), target)
                                            : store(parse_real<float>(p, value), target);
    case FieldType::vec2:
      return store(parse_vector<2>(p, value), target);
    case FieldType::vec3:
    case FieldType::colour:
      return store(parse_vector<3>(p, value), target);
    case FieldType::rotation:
      return store(parse_rotation(p, value), target);
    case FieldType::text:
      if (!value.is_string()) return refused(p, came(value));
      return store(Result<std::string>(value.get<std::string>()), target);
    case FieldType::choice:
      return store_choice(parse_choice(p, value), target, f.size_bytes);
  }
  return {};
}

template <class T>
T load(const void* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

std::uint64_t load_unsigned(const void* from, std::size_t size_bytes) {
  switch (size_bytes) {
    case 1:
      return load<std::uint8_t>(from);
    case 2:
      return load<std::uint16_t>(from);
    case 4:
      return load<std::uint32_t>(from);
    default:
      return load<std::uint64_t>(from);
  }
}

std::int64_t load_signed(const void* from, std::size_t size_bytes) {
  switch (size_bytes) {
    case 1:
      return load<std::int8_t>(from);
    case 2:
      return load<std::int16_t>(from);
    case 4:
      return load<std::int32_t>(from);
    default:
      return load<std::int64_t>(from);
  }
}

}  // namespace

const Schema* find_schema(std::span<const Schema> schemas, std::string_view name) {
  for (const Schema& s : schemas) {
    if (s.name == name) return &s;
  }
  return nullptr;
}

const Field* find_field(const Schema& schema, std::string_view name) {
  for (const Field& f : schema.fields) {
    if (f.name == name) return &f;
  }
  return nullptr;
}

json read_field(const Field& f, const void* component) {
  const void* from = f.address(const_cast<void*>(component));  // only read
  switch (f.type) {
    case FieldType::boolean:
      return load<bool>(from);
    case FieldType::integer:
      return f.is_signed ? json(load_signed(from, f.size_bytes)) : json(load_unsigned(from, f.size_bytes));
    case FieldType::real:
      return f.size_bytes == sizeof(double) ? load<double>(from) : load<float>(from);
    case FieldType::vec2: {
      const auto v = load<glm::vec2>(from);
      return json::array({v.x, v.y});
    }
    case FieldType::vec3:
    case FieldType::colour: {
      const auto v = load<glm::vec3>(from);
      return json::array({v.x, v.y, v.z});
    }
    case FieldType::rotation: {
      const auto q = load<glm::quat>(from);
      return json::array({q.x, q.y, q.z, q.w});
    }
    case FieldType::text:
      return *static_cast<const std::string*>(from);
    case FieldType::choice: {
      const std::uint64_t i = load_unsigned(from, f.size_bytes);
      return i < f.choices.size() ? json(std::string(f.choices[i])) : json(nullptr);
    }
  }
  return nullptr;
}

Result<void> write_field(const Schema& schema, const Field& field, void* component, const json& value) {
  return check_and_store(schema, field, value, field.address(component));
}

Result<void> write_fields(const Schema& schema, void* component, const json& object) {
  if (!object.is_object()) {
    return failure(fmt::format("{}: got {}, expected an object of fields", schema.name, came(object)));
  }
  // Everything is checked before anything is stored, so that an error leaves the component as it was.
  for (const bool storing : {false, true}) {
    for (const auto& [key, value] : object.items()) {
      const Field* f = find_field(schema, key);
      if (!f) {
        std::vector<std::string_view> known;
        for (const Field& each : schema.fields) known.push_back(each.name);
        return failure(fmt::format("{} has no field {}{}", schema.name, shown(key), name_hint(key, known)));
      }
      if (auto done = check_and_store(schema, *f, value, storing ? f->address(component) : nullptr); !done) return done;
    }
  }
  return {};
}

}  // namespace petrichor
