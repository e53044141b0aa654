#pragma once
// One schema per component. It alone makes the Lua binding, the glTF extras, --set, the inspector's
// widgets and the reference page in docs/: whatever must know a component's fields iterates a Schema.

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/ecs/registry.hpp"

namespace petrichor {

// The kinds of value a field may hold. `choice` is an enum class whose values are 0..n-1, named in order
// by Field::choices; `colour` is a linear RGB vec3 shown as a colour picker; `rotation` is a glm::quat.
enum class FieldType { boolean, integer, real, vec2, vec3, colour, rotation, text, choice };

struct Field {
  std::string_view name;  // snake_case with its unit: "rain_mm_per_hour"
  FieldType type;
  std::string_view unit;  // "mm/h", "" where none
  double minimum;         // inclusive range of a number (each element of a vector)
  double maximum;
  std::string_view meaning;  // one sentence for people
  std::span<const std::string_view> choices;
  std::size_t size_bytes;  // of the member; tells int32 from uint32/uint64 together with is_signed
  bool is_signed;
  void* (*address)(void* component);
};

struct Schema {
  std::string_view name;  // snake_case: "emitter"
  std::string_view meaning;
  std::vector<Field> fields;
  // Type-erased storage operations.
  void* (*emplace)(Registry&, Entity);  // adds with defaults, or finds what is there
  void* (*find)(Registry&, Entity);     // nullptr where absent
  void (*remove)(Registry&, Entity);
  std::vector<Entity> (*entities)(Registry&);
  std::size_t (*count)(const Registry&);  // of entities that have it, without a walk
};

namespace detail {

template <class T>
constexpr FieldType field_type() {
  if constexpr (std::is_same_v<T, bool>)
    return FieldType::boolean;
  else if constexpr (std::is_enum_v<T>)
    return FieldType::choice;
  else if constexpr (std::is_integral_v<T>)
    return FieldType::integer;
  else if constexpr (std::is_floating_point_v<T>)
    return FieldType::real;
  else if constexpr (std::is_same_v<T, glm::vec2>)
    return FieldType::vec2;
  else if constexpr (std::is_same_v<T, glm::vec3>)
    return FieldType::vec3;
  else if constexpr (std::is_same_v<T, glm::quat>)
    return FieldType::rotation;
  else {
    static_assert(std::is_same_v<T, std::string>,
                  "a schema field must be a bool, number, vec2, vec3, quat, string or enum");
    return FieldType::text;
  }
}

template <class M>
struct MemberOf;
template <class C, class T>
struct MemberOf<T C::*> {
  using Component = C;
  using Value = T;
};

}  // namespace detail

struct Range {
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
};

// field<&Emitter::rain_mm_per_hour>("rain_mm_per_hour", "mm/h", {0, 300}, "Water reaching the ground.")
template <auto Member>
Field field(std::string_view name, std::string_view unit, Range range, std::string_view meaning,
            std::span<const std::string_view> choices = {}) {
  using M = detail::MemberOf<decltype(Member)>;
  using T = typename M::Value;
  return Field{name,
               detail::field_type<T>(),
               unit,
               range.minimum,
               range.maximum,
               meaning,
               choices,
               sizeof(T),
               std::is_signed_v<T>,
               [](void* component) -> void* { return &(static_cast<typename M::Component*>(component)->*Member); }};
}

// As field(), for a vec3 that is a linear RGB colour.
template <auto Member>
Field colour(std::string_view name, std::string_view unit, Range range, std::string_view meaning) {
  Field f = field<Member>(name, unit, range, meaning);
  static_assert(std::is_same_v<typename detail::MemberOf<decltype(Member)>::Value, glm::vec3>);
  f.type = FieldType::colour;
  return f;
}

template <class Component>
Schema schema(std::string_view name, std::string_view meaning, std::vector<Field> fields) {
  return Schema{name,
                meaning,
                std::move(fields),
                [](Registry& r, Entity e) -> void* {
                  if (auto* c = r.find<Component>(e)) return c;
                  return &r.emplace<Component>(e);
                },
                [](Registry& r, Entity e) -> void* { return r.find<Component>(e); },
                [](Registry& r, Entity e) { r.remove<Component>(e); },
                [](Registry& r) {
                  std::vector<Entity> out;
                  r.view<Component>().each([&](Entity e, auto&&...) { out.push_back(e); });
                  return out;
                },
                [](const Registry& r) { return r.size<Component>(); }};
}

const Schema* find_schema(std::span<const Schema> schemas, std::string_view name);
const Field* find_field(const Schema&, std::string_view name);

// Values cross as JSON: bool, number, string (text and choice), arrays for vectors; a rotation is
// [x, y, z, w] as in glTF. Errors name the component, the field, what came and what was expected
// (type, finite, range, the list of choices), and leave the component as it was.
nlohmann::json read_field(const Field&, const void* component);
Result<void> write_field(const Schema&, const Field&, void* component, const nlohmann::json& value);
// Every member of the object; an unknown key is an error that lists the known ones.
Result<void> write_fields(const Schema&, void* component, const nlohmann::json& object);

}  // namespace petrichor
