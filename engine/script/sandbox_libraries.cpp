// The part of Lua's library that scripts have. What can load code, reach outside or hang in C, where no hook
// runs, is left out or stands behind a guard here.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <lua.hpp>
#include <set>

#include "engine/core/log.hpp"
#include "engine/core/random.hpp"
#include "engine/script/sandbox.hpp"

namespace petrichor::script {
namespace {

// ---- base -------------------------------------------------------------------------------------------------

// As Lua's own, but no protected call outlives a kill or a full memory.
int finish_protected(lua_State* state, int status, lua_KContext first) {
  Sandbox& sandbox = sandbox_of(state);
  if (sandbox.killed) raise_kill(state, sandbox.kill_message);
  if (status == LUA_ERRMEM) {
    raise_kill(state, fmt::format("the script needs more than its {} MiB of memory", sandbox.limits.memory_bytes >> 20));
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
  lua_replace(state, 2);     // f, handler, arguments
  lua_pushboolean(state, 1);
  lua_pushvalue(state, 1);   // ..., true, f
  lua_rotate(state, 3, 2);   // f, handler, true, f, arguments
  const int status = lua_pcallk(state, lua_gettop(state) - 4, LUA_MULTRET, 2, 2, finish_protected);
  return finish_protected(state, status, 2);
}

// Finalisers run with hooks off, and when they run depends on the collector: there are none.
int set_metatable(lua_State* state) {
  luaL_checktype(state, 1, LUA_TTABLE);
  luaL_argexpected(state, lua_isnoneornil(state, 2) || lua_istable(state, 2), 2, "nil or table");
  if (luaL_getmetafield(state, 1, "__metatable") != LUA_TNIL) return luaL_error(state, "cannot change a protected metatable");
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
  if (std::string_view(what) != "count") return luaL_error(state, "collectgarbage: only \"count\" is available to scripts");
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
  charge(state, 1000);
  if (sandbox.print) sandbox.print(line);
  else log_info("{}", line);
  return 0;
}

// Where keys stand in pairs(): numbers by value, then strings by their bytes, then false and true, then things
// that know their place by __order (entities). Lua's own order changes from run to run with the hash seed.
int rank_of(lua_State* state, int index) {
  switch (lua_type(state, index)) {
    case LUA_TNUMBER: return 0;
    case LUA_TSTRING: return 1;
    case LUA_TBOOLEAN: return 2;
    case LUA_TUSERDATA: {
      const bool ordered = luaL_getmetafield(state, index, "__order") != LUA_TNIL;
      if (ordered) lua_pop(state, 1);
      return ordered ? 3 : -1;
    }
    default: return -1;
  }
}

bool key_less(lua_State* state, int a, int b) {
  const int rank_a = rank_of(state, a);
  const int rank_b = rank_of(state, b);
  if (rank_a != rank_b) return rank_a < rank_b;
  switch (rank_a) {
    case 0: return lua_compare(state, a, b, LUA_OPLT) != 0;
    case 1: {
      std::size_t length_a = 0, length_b = 0;
      const char* text_a = lua_tolstring(state, a, &length_a);
      const char* text_b = lua_tolstring(state, b, &length_b);
      return std::string_view(text_a, length_a) < std::string_view(text_b, length_b);
    }
    case 2: return lua_toboolean(state, a) < lua_toboolean(state, b);
    default: return *static_cast<std::uint32_t*>(lua_touserdata(state, a)) < *static_cast<std::uint32_t*>(lua_touserdata(state, b));
  }
}

void check_order(lua_State* state, int index) {
  if (rank_of(state, index) < 0) {
    luaL_error(state, "a %s as a key has no place in an order that is the same in every run; use strings, numbers or entities",
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

// ---- require ----------------------------------------------------------------------------------------------

constexpr const char* modules_key = "petrichor.modules";

// "scenes.city" or "scenes/city": folders and names of letters, digits, '_' and '-', under a root.
std::string module_path(lua_State* state, std::string_view name) {
  std::string path(name);
  std::replace(path.begin(), path.end(), '.', '/');
  const auto is_ok = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == '/'; };
  if (path.empty() || path.size() > 200 || path.front() == '/' || path.back() == '/' ||
      path.find("//") != std::string::npos || !std::all_of(path.begin(), path.end(), is_ok)) {
    raise(state, fmt::format("require(\"{}\"): give a name under scripts/, such as \"scenes.city\"", name.substr(0, 200)));
  }
  return path + ".lua";
}

bool is_inside(const std::filesystem::path& file, const std::filesystem::path& root) {
  std::error_code code;
  const auto real_file = std::filesystem::canonical(file, code);
  if (code) return false;
  const auto real_root = std::filesystem::canonical(root, code);
  if (code) return false;
  return std::mismatch(real_root.begin(), real_root.end(), real_file.begin(), real_file.end()).first == real_root.end();
}

int require_module(lua_State* state) {
  std::size_t length = 0;
  const char* text = luaL_checklstring(state, 1, &length);
  Sandbox& sandbox = sandbox_of(state);
  const std::string path = module_path(state, std::string_view(text, length));
  lua_settop(state, 1);
  luaL_getsubtable(state, LUA_REGISTRYINDEX, modules_key);  // 2
  lua_pushlstring(state, path.data(), path.size());
  if (lua_rawget(state, 2) != LUA_TNIL) {
    if (lua_islightuserdata(state, -1)) raise(state, fmt::format("require(\"{}\"): it is required by itself", text));
    return 1;
  }
  lua_pop(state, 1);
  std::string looked_in;
  for (const auto& root : sandbox.roots) {
    const auto file = root / path;
    std::error_code code;
    if (!std::filesystem::exists(file, code) || !is_inside(file, root)) {
      looked_in += (looked_in.empty() ? "" : ", ") + file.generic_string();
      continue;
    }
    const auto loaded = sandbox.load(state, file);
    if (!loaded) raise(state, loaded.error().message);
    lua_pushlstring(state, path.data(), path.size());
    lua_pushlightuserdata(state, &sandbox);  // marks a module that is being loaded
    lua_rawset(state, 2);
    lua_pushvalue(state, 1);
    // A failing module may be required again (play goes on), so its mark is taken back.
    if (const int status = lua_pcall(state, 1, 1, 0); status != LUA_OK) {
      lua_pushlstring(state, path.data(), path.size());
      lua_pushnil(state);
      lua_rawset(state, 2);
      if (sandbox.killed) raise_kill(state, sandbox.kill_message);
      if (status == LUA_ERRMEM) {
        raise_kill(state, fmt::format("the script needs more than its {} MiB of memory", sandbox.limits.memory_bytes >> 20));
      }
      return lua_error(state);
    }
    if (lua_isnil(state, -1)) {
      lua_pop(state, 1);
      lua_pushboolean(state, 1);
    }
    lua_pushlstring(state, path.data(), path.size());
    lua_pushvalue(state, -2);
    lua_rawset(state, 2);
    return 1;
  }
  raise(state, fmt::format("require(\"{}\"): no such script; looked for {}", text, looked_in.empty() ? "it nowhere" : looked_in));
}

// ---- coroutine --------------------------------------------------------------------------------------------

lua_State* coroutine_argument(lua_State* state) {
  lua_State* thread = lua_tothread(state, 1);
  luaL_argexpected(state, thread, 1, "coroutine");
  const Sandbox& sandbox = sandbox_of(state);
  if (sandbox.is_timeline_thread && sandbox.is_timeline_thread(thread)) {
    luaL_error(state, "this coroutine belongs to the timeline, which resumes it when it is due");
  }
  return thread;
}

int create_coroutine(lua_State* state) {
  luaL_checktype(state, 1, LUA_TFUNCTION);
  charge(state, 200);  // instructions that its first hook has not seen yet, many times over
  lua_State* thread = lua_newthread(state);  // inherits the hook
  lua_pushvalue(state, 1);
  lua_xmove(state, thread, 1);
  return 1;
}

// Resumes with `count` arguments from the top of `state`; leaves results or the error there. -1 on error.
int resume_with(lua_State* state, lua_State* thread, int count) {
  charge(state, 10);
  if (!lua_checkstack(thread, count)) {
    lua_pushliteral(state, "too many arguments to resume");
    return -1;
  }
  lua_xmove(state, thread, count);
  int results = 0;
  const int status = lua_resume(thread, state, count, &results);
  Sandbox& sandbox = sandbox_of(state);
  if (sandbox.killed) raise_kill(state, sandbox.kill_message);
  if (status == LUA_ERRMEM) {
    raise_kill(state, fmt::format("the script needs more than its {} MiB of memory", sandbox.limits.memory_bytes >> 20));
  }
  if (status == LUA_OK || status == LUA_YIELD) {
    if (!lua_checkstack(state, results + 1)) {
      lua_pop(thread, results);
      lua_pushliteral(state, "too many results to resume");
      return -1;
    }
    lua_xmove(thread, state, results);
    return results;
  }
  lua_xmove(thread, state, 1);
  return -1;
}

int resume_coroutine(lua_State* state) {
  lua_State* thread = coroutine_argument(state);
  const int results = resume_with(state, thread, lua_gettop(state) - 1);
  lua_pushboolean(state, results >= 0);
  lua_insert(state, results >= 0 ? -(results + 1) : -2);
  return results >= 0 ? results + 1 : 2;
}

// Runs a thread's pending __close metamethods. Lua 5.4.4 does not count the C stack across this call, so the
// nesting is counted here.
int close_thread(lua_State* state, lua_State* thread) {
  Sandbox& sandbox = sandbox_of(state);
  if (sandbox.closing >= 8) luaL_error(state, "coroutines are closed inside one another too deep");
  ++sandbox.closing;
  const int status = lua_resetthread(thread);
  --sandbox.closing;
  if (sandbox.killed) raise_kill(state, sandbox.kill_message);
  return status;
}

int call_wrapped(lua_State* state) {
  lua_State* thread = lua_tothread(state, lua_upvalueindex(1));
  const int results = resume_with(state, thread, lua_gettop(state));
  if (results >= 0) return results;
  const int status = lua_status(thread);
  if (status != LUA_OK && status != LUA_YIELD && close_thread(state, thread) != LUA_OK) {
    lua_xmove(thread, state, 1);  // an error in closing takes the place of the first
  }
  return lua_error(state);
}

int wrap_coroutine(lua_State* state) {
  create_coroutine(state);
  lua_pushcclosure(state, guarded<call_wrapped>, 1);
  return 1;
}

int close_coroutine(lua_State* state) {
  lua_State* thread = coroutine_argument(state);
  if (lua_gethookcount(thread) == 1) {  // killed: its hooks are off for ever, so nothing of it may run
    lua_pushboolean(state, 0);
    lua_pushliteral(state, "killed");
    return 2;
  }
  const int status = lua_status(thread);
  lua_Debug info;
  const bool idle = status == LUA_YIELD || (status == LUA_OK && thread != state && lua_getstack(thread, 0, &info) == 0) ||
                    status > LUA_YIELD;
  if (!idle) return luaL_error(state, "cannot close a running coroutine");
  const int closed = close_thread(state, thread);
  lua_pushboolean(state, closed == LUA_OK);
  if (closed == LUA_OK) return 1;
  lua_xmove(thread, state, 1);
  return 2;
}

// ---- string, utf8, table: C loops that no hook sees --------------------------------------------------------

// Calls the library's function in this very frame: same arguments, same name in its errors.
int call_original(lua_State* state) { return lua_tocfunction(state, lua_upvalueindex(1))(state); }

void charge_text(lua_State* state) {
  std::uint64_t bytes = 0;
  for (int i = 1, n = lua_gettop(state); i <= n; ++i) {
    if (lua_type(state, i) == LUA_TSTRING) bytes += lua_rawlen(state, i);
  }
  if (bytes > 64) charge(state, bytes / 16);
}

int text_function(lua_State* state) {
  charge_text(state);
  return call_original(state);
}

int repeat_text(lua_State* state) {
  std::size_t length = 0, separator = 0;
  luaL_checklstring(state, 1, &length);
  const lua_Integer count = luaL_checkinteger(state, 2);
  luaL_optlstring(state, 3, "", &separator);
  if (length + separator == 0 || count <= 0) {  // Lua's own would loop `count` times over nothing
    lua_pushliteral(state, "");
    return 1;
  }
  const std::size_t limit = sandbox_of(state).limits.memory_bytes;
  if (static_cast<std::uint64_t>(count) > limit / (length + separator) + 1) {
    raise_kill(state, fmt::format("the script needs more than its {} MiB of memory", limit >> 20));
  }
  charge(state, static_cast<std::uint64_t>(count) / 4 + static_cast<std::uint64_t>(count) * (length + separator) / 16);
  return call_original(state);
}

int pattern_function(lua_State* state) {
  std::size_t length = 0, pattern_length = 0;
  luaL_checklstring(state, 1, &length);
  const char* pattern = luaL_checklstring(state, 2, &pattern_length);
  charge_text(state);
  const bool is_plain = lua_toboolean(state, lua_upvalueindex(2)) && lua_toboolean(state, 4);  // find(s, p, i, true)
  const double steps = is_plain ? static_cast<double>(length) * static_cast<double>(pattern_length) / 64.0
                                : pattern_cost(std::string_view(pattern, pattern_length), length);
  const double cost = steps / 4.0;  // a step is shorter than an instruction
  if (cost > static_cast<double>(sandbox_of(state).budget)) {
    raise(state, fmt::format("pattern \"{}\" may need {:.2g} steps on a text of {} bytes; use fewer *, + and -, an anchor ^, "
                             "or a shorter text",
                             std::string_view(pattern, std::min<std::size_t>(pattern_length, 60)), steps, length));
  }
  charge(state, static_cast<std::uint64_t>(cost));
  return call_original(state);
}

// Lengths must be real: a __len that says 10^15 makes a loop in C that never ends.
void check_plain(lua_State* state) {
  luaL_checktype(state, 1, LUA_TTABLE);
  if (luaL_getmetafield(state, 1, "__len") != LUA_TNIL) luaL_error(state, "table functions need a table without __len");
}

// insert(t, position, value) and remove(t, position) move what follows; without a position they are cheap.
int insert_in_list(lua_State* state) {
  check_plain(state);
  if (lua_gettop(state) >= 3) charge(state, lua_rawlen(state, 1) / 8);
  return call_original(state);
}

int remove_from_list(lua_State* state) {
  check_plain(state);
  if (lua_gettop(state) >= 2) charge(state, lua_rawlen(state, 1) / 8);
  return call_original(state);
}

int sort_list(lua_State* state) {
  check_plain(state);
  const double count = static_cast<double>(lua_rawlen(state, 1));
  charge(state, static_cast<std::uint64_t>(4.0 * count * std::log2(count + 1.0)));
  return call_original(state);
}

// concat(t, separator, i, j), unpack(t, i, j), move(a, first, last, to): the range is charged.
void charge_range(lua_State* state, lua_Integer first, lua_Integer last) {
  if (last < first) return;
  const std::uint64_t steps = static_cast<std::uint64_t>(last) - static_cast<std::uint64_t>(first);
  charge(state, std::min(steps, std::uint64_t{1} << 62) + 1);
}

int concat_list(lua_State* state) {
  check_plain(state);
  charge_text(state);
  charge_range(state, luaL_optinteger(state, 3, 1), luaL_optinteger(state, 4, static_cast<lua_Integer>(lua_rawlen(state, 1))));
  lua_settop(state, 4);
  return call_original(state);
}

int unpack_list(lua_State* state) {
  check_plain(state);
  charge_range(state, luaL_optinteger(state, 2, 1), luaL_optinteger(state, 3, static_cast<lua_Integer>(lua_rawlen(state, 1))));
  lua_settop(state, 3);
  return call_original(state);
}

int move_list(lua_State* state) {
  charge_range(state, luaL_checkinteger(state, 2), luaL_checkinteger(state, 3));
  return call_original(state);
}

// ---- math -------------------------------------------------------------------------------------------------

__extension__ using Wide = unsigned __int128;

std::uint64_t random_word(Sandbox& sandbox) {
  const std::uint64_t index = sandbox.random_index++;
  const glm::uvec4 bits = random_bits4(glm::uvec4(static_cast<std::uint32_t>(sandbox.seed), static_cast<std::uint32_t>(sandbox.seed >> 32),
                                                  static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32)));
  return (static_cast<std::uint64_t>(bits.x) << 32) | bits.y;
}

// As Lua's math.random, but counted from the run's seed.
int random_number(lua_State* state) {
  Sandbox& sandbox = sandbox_of(state);
  lua_Integer low = 1, high = 0;
  switch (lua_gettop(state)) {
    case 0: lua_pushnumber(state, static_cast<double>(random_word(sandbox) >> 11) * 0x1p-53); return 1;
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
    default: return luaL_error(state, "math.random takes no, one or two arguments");
  }
  luaL_argcheck(state, low <= high, lua_gettop(state), "interval is empty");
  const std::uint64_t span = static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low);
  std::uint64_t offset = random_word(sandbox);
  // By multiplication (Lemire 2019); the bias is below span / 2^64.
  if (span != ~std::uint64_t{0}) offset = static_cast<std::uint64_t>((static_cast<Wide>(offset) * (span + 1)) >> 64);
  lua_pushinteger(state, static_cast<lua_Integer>(static_cast<std::uint64_t>(low) + offset));
  return 1;
}

// ---- assembly ---------------------------------------------------------------------------------------------

// Removes from the table on top whatever the list does not name.
void prune(lua_State* state, const std::vector<const char*>& keep) {
  std::set<std::string_view> names(keep.begin(), keep.end());
  std::vector<std::string> gone;
  lua_pushnil(state);
  while (lua_next(state, -2)) {
    lua_pop(state, 1);
    if (lua_type(state, -1) == LUA_TSTRING && !names.contains(lua_tostring(state, -1))) gone.emplace_back(lua_tostring(state, -1));
  }
  for (const auto& name : gone) {
    lua_pushnil(state);
    lua_setfield(state, -2, name.c_str());
  }
}

void set(lua_State* state, const char* name, LuaFunction function) {
  lua_pushcfunction(state, function);
  lua_setfield(state, -2, name);
}

// Puts `guard` in front of a function of the table on top; `flag` becomes its second upvalue.
void wrap(lua_State* state, const char* name, LuaFunction guard, bool flag = false) {
  lua_getfield(state, -1, name);
  lua_pushboolean(state, flag);
  lua_pushcclosure(state, guard, 2);
  lua_setfield(state, -2, name);
}

}  // namespace

double pattern_cost(std::string_view pattern, std::size_t length) {
  // k repetitions can split n characters in C(n + k, k) ways; %b, and a back reference, scan the text too.
  int repetitions = 0;
  double factor = 1.0 + static_cast<double>(pattern.size()) / 32.0;
  const bool anchored = pattern.starts_with('^');
  for (std::size_t i = anchored ? 1 : 0; i < pattern.size(); ++i) {
    const char c = pattern[i];
    if (c == '%' && i + 1 < pattern.size()) {
      const char next = pattern[++i];
      if (next == 'b') ++repetitions, i += 2;
      else if (next >= '0' && next <= '9') ++repetitions;
    } else if (c == '[') {  // inside a set, signs of repetition are letters
      if (i + 1 < pattern.size() && pattern[i + 1] == '^') ++i;
      do {
        ++i;
        if (i < pattern.size() && pattern[i] == '%') i += 2;
      } while (i < pattern.size() && pattern[i] != ']');
    } else if (c == '*' || c == '+' || c == '-') {
      ++repetitions;
    } else if (c == '?') {
      factor *= 2.0;
    }
  }
  const double n = static_cast<double>(length);
  double ways = anchored ? 1.0 : n + 1.0;
  for (int k = 1; k <= repetitions; ++k) ways *= (n + k) / k;
  return ways * factor;
}

const std::vector<LibraryNames>& library_names() {
  static const std::vector<LibraryNames> names{
      {"", {"_G", "_VERSION", "assert", "collectgarbage", "error", "getmetatable", "ipairs", "next", "pairs", "pcall", "print",
            "rawequal", "rawget", "rawlen", "rawset", "require", "select", "setmetatable", "tonumber", "tostring", "type", "xpcall"}},
      {"coroutine", {"close", "create", "isyieldable", "resume", "running", "status", "wrap", "yield"}},
      {"math", {"abs", "acos", "asin", "atan", "ceil", "cos", "deg", "exp", "floor", "fmod", "huge", "log", "max", "maxinteger", "min",
                "mininteger", "modf", "pi", "rad", "random", "sin", "sqrt", "tan", "tointeger", "type", "ult"}},
      {"string", {"byte", "char", "find", "format", "gmatch", "gsub", "len", "lower", "match", "pack", "packsize", "rep", "reverse", "sub",
                  "unpack", "upper"}},
      {"table", {"concat", "insert", "move", "pack", "remove", "sort", "unpack"}},
      {"utf8", {"char", "charpattern", "codepoint", "codes", "len", "offset"}},
  };
  return names;
}

void open_libraries(lua_State* state) {
  for (const auto& [name, open] : std::initializer_list<std::pair<const char*, LuaFunction>>{{LUA_GNAME, luaopen_base},
                                                                                             {LUA_COLIBNAME, luaopen_coroutine},
                                                                                             {LUA_MATHLIBNAME, luaopen_math},
                                                                                             {LUA_STRLIBNAME, luaopen_string},
                                                                                             {LUA_TABLIBNAME, luaopen_table},
                                                                                             {LUA_UTF8LIBNAME, luaopen_utf8}}) {
    luaL_requiref(state, name, open, 1);
    for (const auto& library : library_names()) {
      const std::string_view wanted = *library.library ? library.library : LUA_GNAME;
      if (wanted == name) prune(state, library.functions);
    }
    lua_pop(state, 1);
  }

  lua_pushglobaltable(state);
  set(state, "pcall", guarded<protected_call>);
  set(state, "xpcall", guarded<protected_call_with_handler>);
  set(state, "setmetatable", guarded<set_metatable>);
  set(state, "collectgarbage", guarded<collect_garbage>);
  set(state, "print", guarded<print>);
  set(state, "pairs", guarded<pairs>);
  set(state, "next", guarded<next_key>);
  set(state, "require", guarded<require_module>);

  lua_getfield(state, -1, "coroutine");
  set(state, "create", guarded<create_coroutine>);
  set(state, "resume", guarded<resume_coroutine>);
  set(state, "wrap", guarded<wrap_coroutine>);
  set(state, "close", guarded<close_coroutine>);
  lua_pop(state, 1);

  lua_getfield(state, -1, "math");
  set(state, "random", guarded<random_number>);
  lua_pop(state, 1);

  lua_getfield(state, -1, "string");
  for (const char* name : {"byte", "format", "len", "lower", "pack", "packsize", "reverse", "sub", "unpack", "upper"}) {
    wrap(state, name, guarded<text_function>);
  }
  wrap(state, "rep", guarded<repeat_text>);
  wrap(state, "find", guarded<pattern_function>, true);
  for (const char* name : {"match", "gmatch", "gsub"}) wrap(state, name, guarded<pattern_function>);
  lua_pop(state, 1);

  lua_getfield(state, -1, "utf8");
  for (const char* name : {"codepoint", "len", "offset"}) wrap(state, name, guarded<text_function>);
  lua_pop(state, 1);

  lua_getfield(state, -1, "table");
  wrap(state, "insert", guarded<insert_in_list>);
  wrap(state, "remove", guarded<remove_from_list>);
  wrap(state, "sort", guarded<sort_list>);
  wrap(state, "concat", guarded<concat_list>);
  wrap(state, "unpack", guarded<unpack_list>);
  wrap(state, "move", guarded<move_list>);
  lua_pop(state, 2);

  // All strings share one metatable: scripts must not get at it.
  lua_pushliteral(state, "");
  lua_getmetatable(state, -1);
  lua_pushliteral(state, "string");
  lua_setfield(state, -2, "__metatable");
  lua_pop(state, 2);
}

}  // namespace petrichor::script
