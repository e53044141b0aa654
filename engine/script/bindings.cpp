#include "engine/script/bindings.hpp"

#include <array>
#include <lua.hpp>
#include <string>

#include "engine/script/values.hpp"

namespace petrichor::script {

std::span<const std::span<const Binding>> all_bindings() {
  static const std::array lists{timeline_bindings(), camera_bindings(), world_bindings(), entity_bindings()};
  return lists;
}

void push_functions(lua_State* state, std::string_view owner) {
  lua_newtable(state);
  for (const auto list : all_bindings()) {
    for (const Binding& binding : list) {
      if (binding.owner != owner) continue;
      lua_pushcfunction(state, binding.function);
      lua_setfield(state, -2, binding.name);
    }
  }
}

void open_object(lua_State* state, const char* name) {
  luaL_newmetatable(state, name);
  const std::string shown(std::string_view(name).substr(std::string_view("petrichor.").size()));
  for (const char* field : {"__metatable", "__name"}) {
    lua_pushlstring(state, shown.data(), shown.size());
    lua_setfield(state, -2, field);
  }
}

void open_bindings(lua_State* state) {
  open_vectors(state);
  open_entities(state);
  open_models(state);
  open_handlers(state);
  for (const char* owner : {"world", "camera"}) {
    push_functions(state, owner);
    lua_setglobal(state, owner);
  }
  for (const auto list : all_bindings()) {
    for (const Binding& binding : list) {
      if (binding.owner.empty()) lua_register(state, binding.name, binding.function);
    }
  }
}

}  // namespace petrichor::script
