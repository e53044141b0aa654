// pairs and next: the same order in every run.

#include <algorithm>
#include <cmath>
#include <lua.hpp>

#include "engine/script/library.hpp"

namespace petrichor::script {
namespace {

// Where keys stand in pairs(): numbers by value, then strings by their bytes, then false and true, then things
// that know their place by __order (entities). Lua's own order changes from run to run with the hash seed.
int rank_of(lua_State* state, int index) {
  switch (lua_type(state, index)) {
    case LUA_TNUMBER:
      return 0;
    case LUA_TSTRING:
      return 1;
    case LUA_TBOOLEAN:
      return 2;
    case LUA_TUSERDATA: {
      const bool ordered = luaL_getmetafield(state, index, "__order") != LUA_TNIL;
      if (ordered) lua_pop(state, 1);
      return ordered ? 3 : -1;
    }
    default:
      return -1;
  }
}

bool key_less(lua_State* state, int a, int b) {
  const int rank_a = rank_of(state, a);
  const int rank_b = rank_of(state, b);
  if (rank_a != rank_b) return rank_a < rank_b;
  switch (rank_a) {
    case 0:
      return lua_compare(state, a, b, LUA_OPLT) != 0;
    case 1: {
      std::size_t length_a = 0, length_b = 0;
      const char* text_a = lua_tolstring(state, a, &length_a);
      const char* text_b = lua_tolstring(state, b, &length_b);
      return std::string_view(text_a, length_a) < std::string_view(text_b, length_b);
    }
    case 2:
      return lua_toboolean(state, a) < lua_toboolean(state, b);
    default:
      return *static_cast<std::uint32_t*>(lua_touserdata(state, a)) <
             *static_cast<std::uint32_t*>(lua_touserdata(state, b));
  }
}

void check_order(lua_State* state, int index) {
  if (rank_of(state, index) < 0) {
    luaL_error(state,
               "a %s as a key has no place in an order that is the same in every run; use strings, numbers or entities",
               luaL_typename(state, index));
  }
}

// The iterator: upvalues are the sorted keys, their count and how many were visited.
int next_in_order(lua_State* state) {
  luaL_checktype(state, 1, LUA_TTABLE);
  const lua_Integer count = lua_tointeger(state, lua_upvalueindex(2));
  lua_Integer at = lua_tointeger(state, lua_upvalueindex(3));
  while (at < count) {
    lua_rawgeti(state, lua_upvalueindex(1), ++at);
    lua_pushvalue(state, -1);
    if (lua_rawget(state, 1) != LUA_TNIL) {  // a key that was cleared on the way is left out
      lua_pushinteger(state, at);
      lua_replace(state, lua_upvalueindex(3));
      return 2;
    }
    lua_pop(state, 2);
  }
  return 0;
}

int pairs(lua_State* state) {
  luaL_checkany(state, 1);
  if (luaL_getmetafield(state, 1, "__pairs") != LUA_TNIL) {
    lua_pushvalue(state, 1);
    lua_call(state, 1, 3);
    return 3;
  }
  luaL_checktype(state, 1, LUA_TTABLE);
  lua_settop(state, 1);
  lua_newtable(state);  // 2: keys
  lua_Integer count = 0;
  bool sorted = true;
  lua_pushnil(state);
  while (lua_next(state, 1)) {
    lua_pop(state, 1);
    check_order(state, -1);
    if (count > 0 && sorted) {
      lua_rawgeti(state, 2, count);
      sorted = key_less(state, -1, -2);
      lua_pop(state, 1);
    }
    lua_pushvalue(state, -1);
    lua_rawseti(state, 2, ++count);
  }
  charge(state, static_cast<std::uint64_t>(count) * 4);
  if (!sorted) {
    // Keys sort through their stack-free ranks: an index sort, so that only C++ moves while Lua holds the keys.
    std::vector<lua_Integer> order(static_cast<std::size_t>(count));
    for (lua_Integer i = 0; i < count; ++i) order[static_cast<std::size_t>(i)] = i + 1;
    charge(state, static_cast<std::uint64_t>(static_cast<double>(count) * std::log2(static_cast<double>(count) + 1.0)));
    std::sort(order.begin(), order.end(), [&](lua_Integer a, lua_Integer b) {
      lua_rawgeti(state, 2, a);
      lua_rawgeti(state, 2, b);
      const bool less = key_less(state, -2, -1);
      lua_pop(state, 2);
      return less;
    });
    lua_createtable(state, static_cast<int>(count), 0);
    for (std::size_t i = 0; i < order.size(); ++i) {
      lua_rawgeti(state, 2, order[i]);
      lua_rawseti(state, 3, static_cast<lua_Integer>(i) + 1);
    }
    lua_replace(state, 2);
  }
  lua_pushinteger(state, count);
  lua_pushinteger(state, 0);
  lua_pushcclosure(state, guarded<next_in_order>, 3);
  lua_pushvalue(state, 1);
  lua_pushnil(state);
  return 3;
}

// The key after `key` in the order of pairs; a walk over the whole table.
int next_key(lua_State* state) {
  luaL_checktype(state, 1, LUA_TTABLE);
  lua_settop(state, 2);  // 2: the key, or nil
  lua_pushnil(state);    // 3: the best so far
  std::uint64_t count = 0;
  lua_pushnil(state);
  while (lua_next(state, 1)) {
    lua_pop(state, 1);
    check_order(state, 4);
    ++count;
    if ((lua_isnil(state, 2) || key_less(state, 2, 4)) && (lua_isnil(state, 3) || key_less(state, 4, 3))) {
      lua_pushvalue(state, 4);
      lua_replace(state, 3);
    }
  }
  charge(state, count);
  if (lua_isnil(state, 3)) return 1;
  lua_pushvalue(state, 3);
  lua_rawget(state, 1);
  return 2;
}

constexpr LibraryFunction functions[] = {{"", "pairs", guarded<pairs>}, {"", "next", guarded<next_key>}};

}  // namespace

std::span<const LibraryFunction> order_library() {
  return functions;
}

}  // namespace petrichor::script
