// Protected calls that no kill is lost in, and what else of the base and math libraries differs from Lua's own.

#include <fmt/format.h>

#include <algorithm>
#include <lua.hpp>

#include "engine/core/log.hpp"
#include "engine/core/random.hpp"
#include "engine/script/library.hpp"

namespace petrichor::script {
namespace {

// As Lua's own, but no protected call outlives a kill or a full memory.
int finish_protected(lua_State* state, int status, lua_KContext first) {
  Sandbox& sandbox = sandbox_of(state);
  if (sandbox.killed) raise_kill(state, sandbox.kill_message);
  if (status == LUA_ERRMEM) {
    raise_memory_kill(state);
  }
  if (status != LUA_OK && status != LUA_YIELD) {
    // To recover, Lua walks all the levels of the thread.
    lua_Debug info;
    charge(state, lua_getstack(state, 1000, &info) ? 20'000 : 20);
    lua_pushboolean(state, 0);
    lua_insert(state, -2);
    return 2;
  }
  return lua_gettop(state) - static_cast<int>(first);
}

int protected_call(lua_State* state) {
  luaL_checkany(state, 1);
  lua_pushboolean(state, 1);
  lua_insert(state, 1);
  const int status = lua_pcallk(state, lua_gettop(state) - 2, LUA_MULTRET, 0, 0, finish_protected);
  return finish_protected(state, status, 0);
}

// Lua calls a message handler with hooks off when the error came from a hook: a kill never reaches the script's.
int handle_error(lua_State* state) {
  if (sandbox_of(state).killed) return 1;
  lua_pushvalue(state, lua_upvalueindex(1));
  lua_insert(state, 1);
  lua_call(state, 1, 1);
  return 1;
}

int protected_call_with_handler(lua_State* state) {
  luaL_checktype(state, 2, LUA_TFUNCTION);
  lua_pushvalue(state, 2);
  lua_pushcclosure(state, handle_error, 1);
  lua_replace(state, 2);  // f, handler, arguments
  lua_pushboolean(state, 1);
  lua_pushvalue(state, 1);  // ..., true, f
  lua_rotate(state, 3, 2);  // f, handler, true, f, arguments
  const int status = lua_pcallk(state, lua_gettop(state) - 4, LUA_MULTRET, 2, 2, finish_protected);
  return finish_protected(state, status, 2);
}

// Finalisers run with hooks off, and when they run depends on the collector: there are none.
int set_metatable(lua_State* state) {
  luaL_checktype(state, 1, LUA_TTABLE);
  luaL_argexpected(state, lua_isnoneornil(state, 2) || lua_istable(state, 2), 2, "nil or table");
  if (luaL_getmetafield(state, 1, "__metatable") != LUA_TNIL)
    return luaL_error(state, "cannot change a protected metatable");
  if (lua_istable(state, 2)) {
    lua_pushliteral(state, "__gc");
    if (lua_rawget(state, 2) != LUA_TNIL) return luaL_error(state, "__gc is not available to scripts");
  }
  lua_settop(state, 2);
  lua_setmetatable(state, 1);
  return 1;
}

int collect_garbage(lua_State* state) {
  const char* what = luaL_optstring(state, 1, "collect");
  if (std::string_view(what) != "count")
    return luaL_error(state, "collectgarbage: only \"count\" is available to scripts");
  lua_pushnumber(state, static_cast<double>(sandbox_of(state).memory_used) / 1024.0);
  return 1;
}

int print(lua_State* state) {
  Sandbox& sandbox = sandbox_of(state);
  std::string line;
  for (int i = 1, n = lua_gettop(state); i <= n; ++i) {
    std::size_t length = 0;
    const char* text = luaL_tolstring(state, i, &length);
    if (i > 1) line += '\t';
    line.append(text, std::min<std::size_t>(length, 10'000));
    lua_pop(state, 1);
  }
  charge(state, 1000 + line.size());
  if (sandbox.print)
    sandbox.print(line);
  else
    log_info("{}", line);
  return 0;
}

__extension__ using Wide = unsigned __int128;

std::uint64_t random_word(Sandbox& sandbox) {
  const std::uint64_t index = sandbox.random_index++;
  const glm::uvec4 bits =
      random_bits4(glm::uvec4(static_cast<std::uint32_t>(sandbox.seed), static_cast<std::uint32_t>(sandbox.seed >> 32),
                              static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32)));
  return (static_cast<std::uint64_t>(bits.x) << 32) | bits.y;
}

// As Lua's math.random, but counted from the run's seed.
int random_number(lua_State* state) {
  Sandbox& sandbox = sandbox_of(state);
  lua_Integer low = 1, high = 0;
  switch (lua_gettop(state)) {
    case 0:
      lua_pushnumber(state, static_cast<double>(random_word(sandbox) >> 11) * 0x1p-53);
      return 1;
    case 1:
      high = luaL_checkinteger(state, 1);
      if (high == 0) {
        lua_pushinteger(state, static_cast<lua_Integer>(random_word(sandbox)));
        return 1;
      }
      break;
    case 2:
      low = luaL_checkinteger(state, 1);
      high = luaL_checkinteger(state, 2);
      break;
    default:
      return luaL_error(state, "math.random takes no, one or two arguments");
  }
  luaL_argcheck(state, low <= high, lua_gettop(state), "interval is empty");
  const std::uint64_t span = static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low);
  std::uint64_t offset = random_word(sandbox);
  // By multiplication (Lemire 2019); the bias is below span / 2^64.
  if (span != ~std::uint64_t{0}) offset = static_cast<std::uint64_t>((static_cast<Wide>(offset) * (span + 1)) >> 64);
  lua_pushinteger(state, static_cast<lua_Integer>(static_cast<std::uint64_t>(low) + offset));
  return 1;
}

constexpr LibraryFunction functions[] = {{"", "pcall", guarded<protected_call>},
                                         {"", "xpcall", guarded<protected_call_with_handler>},
                                         {"", "setmetatable", guarded<set_metatable>},
                                         {"", "collectgarbage", guarded<collect_garbage>},
                                         {"", "print", guarded<print>},
                                         {"math", "random", guarded<random_number>}};

}  // namespace

std::span<const LibraryFunction> base_library() {
  return functions;
}

}  // namespace petrichor::script
