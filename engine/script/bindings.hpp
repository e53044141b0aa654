#pragma once
// Inside engine/script: one list holds every function that scripts can call, with the line that documents it;
// the state and docs/reference.md are both made from it, so the page cannot drift.

#include <span>
#include <string_view>

#include "engine/core/result.hpp"
#include "engine/ecs/entity.hpp"
#include "engine/script/sandbox.hpp"

namespace petrichor::script {

struct Binding {
  std::string_view owner;      // "" for a global, a table ("world", "camera"), or an object ("entity", "model")
  const char* name;
  std::string_view signature;  // "world.find(name) -> entity or nil"
  std::string_view meaning;
  LuaFunction function;
};

std::span<const Binding> world_bindings();     // world, entity, model, vectors and rotations
std::span<const Binding> timeline_bindings();  // timeline, waits, tweens, events, camera, cinematic

void open_bindings(lua_State*);
void push_entity(lua_State*, Entity);
// The living entity at `index`; raises where there is none.
Entity check_entity(lua_State*, int index);

// What a component proxy (rain.emitter) stands for; schema is nullptr where the value is none.
struct ComponentBox {
  Entity entity;
  const Schema* schema = nullptr;
};
ComponentBox test_component(lua_State*, int index);

}  // namespace petrichor::script
