// Guards before library functions that loop in C, where no hook runs: what they may cost is charged first.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <lua.hpp>

#include "engine/script/library.hpp"

namespace petrichor::script {
namespace {

// Calls the library's function in this very frame: same arguments, same name in its errors.
int call_original(lua_State* state) {
  return lua_tocfunction(state, lua_upvalueindex(1))(state);
}

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
    raise_memory_kill(state);
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
    raise(state,
          fmt::format("pattern \"{}\" may need {:.2g} steps on a text of {} bytes; use fewer *, + and -, an anchor ^, "
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
  charge_range(state, luaL_optinteger(state, 3, 1),
               luaL_optinteger(state, 4, static_cast<lua_Integer>(lua_rawlen(state, 1))));
  lua_settop(state, 4);
  return call_original(state);
}

int unpack_list(lua_State* state) {
  check_plain(state);
  charge_range(state, luaL_optinteger(state, 2, 1),
               luaL_optinteger(state, 3, static_cast<lua_Integer>(lua_rawlen(state, 1))));
  lua_settop(state, 3);
  return call_original(state);
}

int move_list(lua_State* state) {
  charge_range(state, luaL_checkinteger(state, 2), luaL_checkinteger(state, 3));
  return call_original(state);
}

constexpr LibraryFunction functions[] = {
    {"string", "byte", guarded<text_function>, true},     {"string", "format", guarded<text_function>, true},
    {"string", "len", guarded<text_function>, true},      {"string", "lower", guarded<text_function>, true},
    {"string", "pack", guarded<text_function>, true},     {"string", "packsize", guarded<text_function>, true},
    {"string", "reverse", guarded<text_function>, true},  {"string", "sub", guarded<text_function>, true},
    {"string", "unpack", guarded<text_function>, true},   {"string", "upper", guarded<text_function>, true},
    {"string", "rep", guarded<repeat_text>, true},        {"string", "find", guarded<pattern_function>, true, true},
    {"string", "match", guarded<pattern_function>, true}, {"string", "gmatch", guarded<pattern_function>, true},
    {"string", "gsub", guarded<pattern_function>, true},  {"utf8", "codepoint", guarded<text_function>, true},
    {"utf8", "len", guarded<text_function>, true},        {"utf8", "offset", guarded<text_function>, true},
    {"table", "insert", guarded<insert_in_list>, true},   {"table", "remove", guarded<remove_from_list>, true},
    {"table", "sort", guarded<sort_list>, true},          {"table", "concat", guarded<concat_list>, true},
    {"table", "unpack", guarded<unpack_list>, true},      {"table", "move", guarded<move_list>, true}};

}  // namespace

std::span<const LibraryFunction> guard_library() {
  return functions;
}

double pattern_cost(std::string_view pattern, std::size_t length) {
  // k repetitions can split n characters in C(n + k, k) ways; %b, and a back reference, scan the text too.
  int repetitions = 0;
  double factor = 1.0 + static_cast<double>(pattern.size()) / 32.0;
  const bool anchored = pattern.starts_with('^');
  for (std::size_t i = anchored ? 1 : 0; i < pattern.size(); ++i) {
    const char c = pattern[i];
    if (c == '%' && i + 1 < pattern.size()) {
      const char next = pattern[++i];
      if (next == 'b')
        ++repetitions, i += 2;
      else if (next >= '0' && next <= '9')
        ++repetitions;
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

}  // namespace petrichor::script
