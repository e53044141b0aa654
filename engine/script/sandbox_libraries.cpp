// The part of Lua's library that scripts have. What can load code, reach outside or hang in C is left out or
// stands behind a guard (library_*.cpp).

#include <lua.hpp>
#include <set>

#include "engine/script/library.hpp"

namespace petrichor::script {
namespace {

// Removes from the table on top whatever the list does not name.
void prune(lua_State* state, const std::vector<const char*>& keep) {
  std::set<std::string_view> names(keep.begin(), keep.end());
  std::vector<std::string> gone;
  lua_pushnil(state);
  while (lua_next(state, -2)) {
    lua_pop(state, 1);
    if (lua_type(state, -1) == LUA_TSTRING && !names.contains(lua_tostring(state, -1)))
      gone.emplace_back(lua_tostring(state, -1));
  }
  for (const auto& name : gone) {
    lua_pushnil(state);
    lua_setfield(state, -2, name.c_str());
  }
}

}  // namespace

const std::vector<LibraryNames>& library_names() {
  static const std::vector<LibraryNames> names{
      {"", {"_G",     "_VERSION",     "assert",   "collectgarbage", "error",  "getmetatable", "ipairs", "next",
            "pairs",  "pcall",        "print",    "rawequal",       "rawget", "rawlen",       "rawset", "require",
            "select", "setmetatable", "tonumber", "tostring",       "type",   "xpcall"}},
      {"coroutine", {"close", "create", "isyieldable", "resume", "running", "status", "wrap", "yield"}},
      {"math", {"abs",  "acos",   "asin", "atan", "ceil",       "cos",       "deg",        "exp",  "floor",
                "fmod", "huge",   "log",  "max",  "maxinteger", "min",       "mininteger", "modf", "pi",
                "rad",  "random", "sin",  "sqrt", "tan",        "tointeger", "type",       "ult"}},
      {"string",
       {"byte", "char", "find", "format", "gmatch", "gsub", "len", "lower", "match", "pack", "packsize", "rep",
        "reverse", "sub", "unpack", "upper"}},
      {"table", {"concat", "insert", "move", "pack", "remove", "sort", "unpack"}},
      {"utf8", {"char", "charpattern", "codepoint", "codes", "len", "offset"}},
  };
  return names;
}

void open_libraries(lua_State* state) {
  for (const auto& [name, open] :
       std::initializer_list<std::pair<const char*, LuaFunction>>{{LUA_GNAME, luaopen_base},
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

  for (const auto list : {base_library(), order_library(), require_library(), coroutine_library(), guard_library()}) {
    for (const LibraryFunction& f : list) {
      if (*f.library)
        lua_getglobal(state, f.library);
      else
        lua_pushglobaltable(state);
      if (f.is_guard) {
        lua_getfield(state, -1, f.name);
        lua_pushboolean(state, f.flag);
        lua_pushcclosure(state, f.function, 2);
      } else {
        lua_pushcfunction(state, f.function);
      }
      lua_setfield(state, -2, f.name);
      lua_pop(state, 1);
    }
  }

  // All strings share one metatable: scripts must not get at it.
  lua_pushliteral(state, "");
  lua_getmetatable(state, -1);
  lua_pushliteral(state, "string");
  lua_setfield(state, -2, "__metatable");
  lua_pop(state, 2);
}

}  // namespace petrichor::script
