// Tables of plain data as JSON.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <lua.hpp>
#include <nlohmann/json.hpp>

#include "engine/script/values.hpp"

namespace petrichor::script {

using nlohmann::json;

// Texts go to JSON files and to the screen: UTF-8 only.
bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const std::size_t length = byte < 0x80                   ? 1
                               : byte >= 0xc2 && byte < 0xe0 ? 2
                               : byte >= 0xe0 && byte < 0xf0 ? 3
                               : byte >= 0xf0 && byte < 0xf5 ? 4
                                                             : 0;
    if (length == 0 || i + length > text.size()) return false;
    for (std::size_t k = 1; k < length; ++k) {
      if ((static_cast<unsigned char>(text[i + k]) & 0xc0) != 0x80) return false;
    }
    const auto second = length > 2 ? static_cast<unsigned char>(text[i + 1]) : 0;
    if ((byte == 0xe0 && second < 0xa0) || (byte == 0xed && second > 0x9f) || (byte == 0xf0 && second < 0x90) ||
        (byte == 0xf4 && second > 0x8f))
      return false;
    i += length;
  }
  return true;
}

namespace {

constexpr int deepest = 64;
constexpr std::size_t most_values = 200'000;

// The walk of to_json. Only raw access: no metamethod of the script runs.
struct JsonWriter {
  lua_State* state;
  std::vector<const void*> open_tables;
  std::size_t values = 0;

  Result<json> value(int index, const std::string& place) {
    if (++values > most_values) return failure(fmt::format("{}: more than {} values", place, most_values));
    switch (lua_type(state, index)) {
      case LUA_TNIL:
        return json(nullptr);
      case LUA_TBOOLEAN:
        return json(lua_toboolean(state, index) != 0);
      case LUA_TNUMBER: {
        if (lua_isinteger(state, index)) return json(static_cast<std::int64_t>(lua_tointeger(state, index)));
        const double number = lua_tonumber(state, index);
        if (!std::isfinite(number)) return failure(fmt::format("{}: {} is no finite number", place, number));
        return json(number);
      }
      case LUA_TSTRING: {
        std::size_t length = 0;
        const char* text = lua_tolstring(state, index, &length);
        if (!is_utf8(std::string_view(text, length)))
          return failure(fmt::format("{}: a string that is not UTF-8", place));
        return json(std::string(text, length));
      }
      case LUA_TTABLE:
        return table(index, place);
      default:
        return failure(fmt::format("{}: a {} is no data; give numbers, strings, booleans and tables", place,
                                   luaL_typename(state, index)));
    }
  }

  Result<json> table(int index, const std::string& place) {
    const void* self = lua_topointer(state, index);
    if (std::find(open_tables.begin(), open_tables.end(), self) != open_tables.end()) {
      return failure(fmt::format("{}: the table contains itself", place));
    }
    if (open_tables.size() >= deepest)
      return failure(fmt::format("{}: tables are nested more than {} deep", place, deepest));
    if (!lua_checkstack(state, 8)) return failure(fmt::format("{}: tables are nested too deep", place));
    open_tables.push_back(self);

    std::size_t count = 0;
    bool is_list = true;
    const auto length = static_cast<std::size_t>(lua_rawlen(state, index));
    lua_pushnil(state);
    while (lua_next(state, index)) {
      lua_pop(state, 1);
      ++count;
      if (!lua_isinteger(state, -1) || lua_tointeger(state, -1) < 1 ||
          static_cast<std::size_t>(lua_tointeger(state, -1)) > length)
        is_list = false;
    }
    if (count == 0) is_list = false;

    json out = is_list ? json::array() : json::object();
    if (is_list) {
      for (std::size_t i = 1; i <= length; ++i) {
        lua_rawgeti(state, index, static_cast<lua_Integer>(i));
        auto item = value(lua_gettop(state), fmt::format("{}[{}]", place, i));
        lua_pop(state, 1);
        if (!item) return item;
        out.push_back(std::move(*item));
      }
    } else {
      lua_pushnil(state);
      while (lua_next(state, index)) {
        std::string key;
        if (lua_type(state, -2) == LUA_TSTRING) {
          std::size_t key_length = 0;
          const char* text = lua_tolstring(state, -2, &key_length);
          key.assign(text, key_length);
          if (!is_utf8(key)) return failure(fmt::format("{}: a key that is not UTF-8", place));
        } else if (lua_isinteger(state, -2)) {
          key = std::to_string(lua_tointeger(state, -2));
        } else {
          return failure(
              fmt::format("{}: a {} as a key; keys are strings or whole numbers", place, luaL_typename(state, -2)));
        }
        const std::string inside = place + "." + key;
        if (out.contains(key)) return failure(fmt::format("{}: there as a number and as a string", inside));
        auto item = value(lua_gettop(state), inside);
        lua_pop(state, 1);
        if (!item) return item;
        out[key] = std::move(*item);
      }
    }
    open_tables.pop_back();
    return out;
  }
};

}  // namespace

Result<json> to_json(lua_State* state, int index) {
  JsonWriter writer{state, {}, 0};
  return writer.value(lua_absindex(state, index), "the table");
}

}  // namespace petrichor::script
