// require: text files under the script roots.

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <lua.hpp>

#include "engine/script/library.hpp"

namespace petrichor::script {
namespace {

constexpr const char* modules_key = "petrichor.modules";

// "scenes.city" or "scenes/city": folders and names of letters, digits, '_' and '-', under a root.
std::string module_path(lua_State* state, std::string_view name) {
  std::string path(name);
  std::replace(path.begin(), path.end(), '.', '/');
  const auto is_ok = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == '/';
  };
  if (path.empty() || path.size() > 200 || path.front() == '/' || path.back() == '/' ||
      path.find("//") != std::string::npos || !std::all_of(path.begin(), path.end(), is_ok)) {
    raise(state,
          fmt::format("require(\"{}\"): give a name under scripts/, such as \"scenes.city\"", name.substr(0, 200)));
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
        raise_memory_kill(state);
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
  raise(state, fmt::format("require(\"{}\"): no such script; looked for {}", text,
                           looked_in.empty() ? "it nowhere" : looked_in));
}

constexpr LibraryFunction functions[] = {{"", "require", guarded<require_module>}};

}  // namespace

std::span<const LibraryFunction> require_library() {
  return functions;
}

}  // namespace petrichor::script
