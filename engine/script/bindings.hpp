#pragma once
// Inside engine/script: one list holds every function that scripts can call, with the line that documents it;
// the state and docs/reference.md are both made from it, so the page cannot drift.

#include <span>
#include <string_view>

#include "engine/script/host.hpp"

namespace petrichor::script {

struct Binding {
  std::string_view owner;  // "" for a global, a table ("world", "camera"), or an object ("entity", "model")
  const char* name;
  std::string_view signature;  // "world.find(name) -> entity or nil"
  std::string_view meaning;
  LuaFunction function;
};

std::span<const Binding> timeline_bindings();  // timeline, waits, tweens, events
std::span<const Binding> camera_bindings();    // camera, cinematic
std::span<const Binding> world_bindings();     // world, models, vectors and rotations
std::span<const Binding> entity_bindings();
std::span<const std::span<const Binding>> all_bindings();

void open_bindings(lua_State*);
void open_entities(lua_State*);
void open_models(lua_State*);
void open_handlers(lua_State*);
// Pushes a table of the owner's functions.
void push_functions(lua_State*, std::string_view owner);
// Pushes a new metatable that scripts cannot get at; "petrichor.entity" is shown as "entity".
void open_object(lua_State*, const char* name);

// What bindings ask of their arguments; each raises a Lua error that says what is wrong.
std::string_view text_argument(lua_State*, int index);
const Schema& check_schema(lua_State*, std::string_view name);
Entity check_entity(lua_State*, int index);        // a living one
const Entity* test_entity(lua_State*, int index);  // nullptr where the value is none; may be dead
// The timeline, for a function that waits: `function` must be running in a story that can.
Timeline& check_can_wait(lua_State*, const char* function);
inline constexpr double longest_s = 1e7;  // four months; a time beyond it is a mistake

void push_entity(lua_State*, Entity);
// Sets the fields in the table at `index`, adding the component where it is missing.
void set_component(lua_State*, Entity, const Schema&, int index);
// What tracks write with, long after the call that made them.
Result<void> write_target(ScriptHost::Impl&, const Schema&, const Target&, const nlohmann::json& value);

// What a component proxy (rain.emitter) stands for; schema is nullptr where the value is none.
struct ComponentBox {
  Entity entity;
  const Schema* schema = nullptr;
};
ComponentBox test_component(lua_State*, int index);

}  // namespace petrichor::script
