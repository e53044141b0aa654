#include "engine/script/values.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <lua.hpp>
#include <nlohmann/json.hpp>

#include "engine/script/sandbox.hpp"

namespace petrichor::script {
namespace {

using nlohmann::json;

constexpr const char* vector_metatable = "petrichor.vector";

// 0..3 for x y z w and r g b a, -1 for anything else.
int element_of(lua_State* state, int index) {
  if (lua_type(state, index) != LUA_TSTRING || lua_rawlen(state, index) != 1) return -1;
  switch (*lua_tostring(state, index)) {
    case 'x':
    case 'r':
      return 0;
    case 'y':
    case 'g':
      return 1;
    case 'z':
    case 'b':
      return 2;
    case 'w':
    case 'a':
      return 3;
    default:
      return -1;
  }
}

int vector_index(lua_State* state) {
  const int element = element_of(state, 2);
  if (element < 0) {
    if (lua_type(state, 2) == LUA_TNUMBER) return 0;
    return luaL_error(state, "a vector has x, y, z (or r, g, b), not %s", luaL_tolstring(state, 2, nullptr));
  }
  lua_rawgeti(state, 1, element + 1);
  return 1;
}

int vector_newindex(lua_State* state) {
  return luaL_error(state, "a vector is a value and does not change; make a new one with vec3(x, y, z)");
}

struct Vector {
  std::array<double, 4> v{};
  std::size_t size = 0;
};

Vector get_vector(lua_State* state, int index) {
  Vector out;
  out.size = std::min<std::size_t>(lua_rawlen(state, index), 4);
  for (std::size_t i = 0; i < out.size; ++i) {
    lua_rawgeti(state, index, static_cast<lua_Integer>(i) + 1);
    out.v[i] = lua_tonumber(state, -1);
    lua_pop(state, 1);
  }
  return out;
}

template <class Op>
int arithmetic(lua_State* state, const char* sign, Op op) {
  const bool a_is_number = lua_type(state, 1) == LUA_TNUMBER;
  const bool b_is_number = lua_type(state, 2) == LUA_TNUMBER;
  if ((!a_is_number && !lua_istable(state, 1)) || (!b_is_number && !lua_istable(state, 2))) {
    return luaL_error(state, "a vector %s %s makes no sense", sign,
                      luaL_typename(state, a_is_number || lua_istable(state, 1) ? 2 : 1));
  }
  Vector a = a_is_number ? Vector{} : get_vector(state, 1);
  Vector b = b_is_number ? Vector{} : get_vector(state, 2);
  if (a_is_number) a.size = b.size, a.v.fill(lua_tonumber(state, 1));
  if (b_is_number) b.size = a.size, b.v.fill(lua_tonumber(state, 2));
  if (a.size != b.size)
    return luaL_error(state, "vectors of %d and %d numbers do not go together", static_cast<int>(a.size),
                      static_cast<int>(b.size));
  for (std::size_t i = 0; i < a.size; ++i) a.v[i] = op(a.v[i], b.v[i]);
  push_vector(state, std::span(a.v).first(a.size));
  return 1;
}

int vector_add(lua_State* s) {
  return arithmetic(s, "+", [](double a, double b) { return a + b; });
}
int vector_subtract(lua_State* s) {
  return arithmetic(s, "-", [](double a, double b) { return a - b; });
}
int vector_multiply(lua_State* s) {
  return arithmetic(s, "*", [](double a, double b) { return a * b; });
}
int vector_divide(lua_State* s) {
  return arithmetic(s, "/", [](double a, double b) { return a / b; });
}

int vector_negate(lua_State* state) {
  Vector a = get_vector(state, 1);
  for (double& x : a.v) x = -x;
  push_vector(state, std::span(a.v).first(a.size));
  return 1;
}

int vector_equal(lua_State* state) {
  if (!lua_istable(state, 1) || !lua_istable(state, 2)) {
    lua_pushboolean(state, 0);
    return 1;
  }
  const Vector a = get_vector(state, 1);
  const Vector b = get_vector(state, 2);
  lua_pushboolean(state, a.size == b.size && a.v == b.v);
  return 1;
}

int vector_text(lua_State* state) {
  const Vector a = get_vector(state, 1);
  std::string text = "{";
  for (std::size_t i = 0; i < a.size; ++i) text += fmt::format("{}{:.6g}", i ? ", " : "", a.v[i]);
  text += "}";
  lua_pushlstring(state, text.data(), text.size());
  return 1;
}

std::size_t elements_of(FieldType type) {
  switch (type) {
    case FieldType::vec2:
      return 2;
    case FieldType::vec3:
    case FieldType::colour:
      return 3;
    case FieldType::rotation:
      return 4;
    default:
      return 0;
  }
}

}  // namespace

void open_vectors(lua_State* state) {
  luaL_newmetatable(state, vector_metatable);
  const luaL_Reg functions[] = {{"__index", guarded<vector_index>},   {"__newindex", guarded<vector_newindex>},
                                {"__add", guarded<vector_add>},       {"__sub", guarded<vector_subtract>},
                                {"__mul", guarded<vector_multiply>},  {"__div", guarded<vector_divide>},
                                {"__unm", guarded<vector_negate>},    {"__eq", guarded<vector_equal>},
                                {"__tostring", guarded<vector_text>}, {nullptr, nullptr}};
  luaL_setfuncs(state, functions, 0);
  lua_pushliteral(state, "vector");
  lua_setfield(state, -2, "__metatable");
  lua_pop(state, 1);
}

void push_vector(lua_State* state, std::span<const double> numbers) {
  lua_createtable(state, static_cast<int>(numbers.size()), 0);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    lua_pushnumber(state, numbers[i]);
    lua_rawseti(state, -2, static_cast<lua_Integer>(i) + 1);
  }
  luaL_setmetatable(state, vector_metatable);
}

void check_vector(lua_State* state, int index, std::span<double> out, const std::string& what) {
  index = lua_absindex(state, index);
  const auto refuse = [&] {
    raise(state, fmt::format("{}: got {}, expected {} numbers such as {}", what, describe(state, index), out.size(),
                             out.size() == 2   ? "{1, 2}"
                             : out.size() == 3 ? "{1, 2, 3} or {x=1, y=2, z=3}"
                                               : "{x, y, z, w}"));
  };
  if (!lua_istable(state, index)) refuse();
  std::size_t found = 0;
  bool by_position = true;
  std::array<bool, 4> seen{};
  lua_pushnil(state);
  while (lua_next(state, index)) {
    int element = -1;
    if (lua_isinteger(state, -2)) {
      const lua_Integer at = lua_tointeger(state, -2);
      if (at >= 1 && at <= 4) element = static_cast<int>(at) - 1;
      if (found > 0 && !by_position) element = -1;
    } else {
      element = element_of(state, -2);
      if (found > 0 && by_position) element = -1;
      by_position = false;
    }
    if (element < 0 || static_cast<std::size_t>(element) >= out.size() || seen[static_cast<std::size_t>(element)] ||
        lua_type(state, -1) != LUA_TNUMBER) {
      refuse();
    }
    seen[static_cast<std::size_t>(element)] = true;
    out[static_cast<std::size_t>(element)] = lua_tonumber(state, -1);
    ++found;
    lua_pop(state, 1);
  }
  if (found != out.size()) refuse();
}

json check_field_value(lua_State* state, int index, const Schema& schema, const Field& field) {
  index = lua_absindex(state, index);
  const std::string what = fmt::format("{}.{}", schema.name, field.name);
  if (const std::size_t count = elements_of(field.type); count > 0) {
    std::array<double, 4> numbers{};
    check_vector(state, index, std::span(numbers).first(count), what);
    json out = json::array();
    for (std::size_t i = 0; i < count; ++i) out.push_back(numbers[i]);
    return out;
  }
  switch (lua_type(state, index)) {
    case LUA_TBOOLEAN:
      return lua_toboolean(state, index) != 0;
    case LUA_TNUMBER:
      if (lua_isinteger(state, index)) return static_cast<std::int64_t>(lua_tointeger(state, index));
      return lua_tonumber(state, index);
    case LUA_TSTRING: {
      std::size_t length = 0;
      const char* text = lua_tolstring(state, index, &length);
      const std::size_t most = sandbox_of(state).limits.text_bytes;
      if (length > most) raise(state, fmt::format("{}: a text of {} bytes; at most {} fit", what, length, most));
      if (!is_utf8(std::string_view(text, length))) raise(state, what + ": the text is not UTF-8");
      return std::string(text, length);
    }
    default:
      raise(state, fmt::format("{}: got {}, expected a value", what, describe(state, index)));
  }
}

void push_json(lua_State* state, const json& value) {
  luaL_checkstack(state, 4, "nested too deep");
  switch (value.type()) {
    case json::value_t::boolean:
      lua_pushboolean(state, value.get<bool>());
      return;
    case json::value_t::number_integer:
      lua_pushinteger(state, value.get<std::int64_t>());
      return;
    case json::value_t::number_unsigned:
      lua_pushinteger(state, static_cast<lua_Integer>(value.get<std::uint64_t>()));
      return;
    case json::value_t::number_float:
      lua_pushnumber(state, value.get<double>());
      return;
    case json::value_t::string: {
      const auto& text = value.get_ref<const std::string&>();
      lua_pushlstring(state, text.data(), text.size());
      return;
    }
    case json::value_t::array: {
      if (value.size() >= 2 && value.size() <= 4 &&
          std::all_of(value.begin(), value.end(), [](const json& v) { return v.is_number(); })) {
        std::array<double, 4> numbers{};
        for (std::size_t i = 0; i < value.size(); ++i) numbers[i] = value[i].get<double>();
        push_vector(state, std::span(numbers).first(value.size()));
        return;
      }
      lua_createtable(state, static_cast<int>(value.size()), 0);
      for (std::size_t i = 0; i < value.size(); ++i) {
        push_json(state, value[i]);
        lua_rawseti(state, -2, static_cast<lua_Integer>(i) + 1);
      }
      return;
    }
    case json::value_t::object:
      lua_createtable(state, 0, static_cast<int>(value.size()));
      for (const auto& [key, item] : value.items()) {
        lua_pushlstring(state, key.data(), key.size());
        push_json(state, item);
        lua_rawset(state, -3);
      }
      return;
    default:
      lua_pushnil(state);
      return;
  }
}

std::string describe(lua_State* state, int index) {
  switch (lua_type(state, index)) {
    case LUA_TNIL:
    case LUA_TNONE:
      return "nil";
    case LUA_TBOOLEAN:
      return lua_toboolean(state, index) ? "true" : "false";
    case LUA_TNUMBER:
      return lua_isinteger(state, index) ? fmt::format("{}", lua_tointeger(state, index))
                                         : fmt::format("{}", lua_tonumber(state, index));
    case LUA_TSTRING: {
      std::size_t length = 0;
      const char* text = lua_tolstring(state, index, &length);
      return length <= 60 ? fmt::format("the string \"{}\"", std::string_view(text, length))
                          : fmt::format("a string of {} bytes", length);
    }
    default:
      return fmt::format("a {}", luaL_typename(state, index));
  }
}

int make_vector(lua_State* state) {
  std::array<double, 3> v{};
  for (int i = 0; i < 3; ++i) v[static_cast<std::size_t>(i)] = luaL_checknumber(state, i + 1);
  push_vector(state, v);
  return 1;
}

}  // namespace petrichor::script
