// The world, models and rotations as scripts see them.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <lua.hpp>
#include <nlohmann/json.hpp>

#include "engine/script/bindings.hpp"
#include "engine/script/host.hpp"
#include "engine/script/path.hpp"
#include "engine/script/values.hpp"

namespace petrichor::script {
namespace {

constexpr const char* model_metatable = "petrichor.model";

int spawn(lua_State* state) {
  auto& host = host_of(state);
  luaL_checktype(state, 1, LUA_TTABLE);
  lua_settop(state, 1);
  Entity parent = null_entity;
  std::vector<const Schema*> wanted;
  lua_pushnil(state);
  while (lua_next(state, 1)) {
    if (lua_type(state, -2) != LUA_TSTRING) {
      raise(state,
            fmt::format("world.spawn: {} is no component name; write component={{field=value}}", describe(state, -2)));
    }
    const std::string_view key = text_argument(state, -2);
    if (key == "parent")
      parent = check_entity(state, -1);
    else
      wanted.push_back(&check_schema(state, key));
    lua_pop(state, 1);
  }
  if (parent != null_entity && !host.options.services.set_parent)
    raise(state, "world.spawn: entities cannot have a parent here");
  std::sort(wanted.begin(), wanted.end());
  charge(state, 100);
  if (host.registry.size() >= host.options.limits.entities) {
    raise(state, fmt::format("world.spawn: there are {} entities already, as many as a script may make",
                             host.registry.size()));
  }
  const Entity entity = host.registry.create();
  try {
    for (const Schema* schema : wanted) {
      lua_pushlstring(state, schema->name.data(), schema->name.size());
      lua_rawget(state, 1);
      set_component(state, entity, *schema, -1);
      lua_pop(state, 1);
    }
    if (parent != null_entity) {
      if (const auto set = host.options.services.set_parent(entity, parent); !set) raise(state, set.error().message);
    }
    push_entity(state, entity);
  } catch (...) {  // Lua's error as well: nothing half made stays behind
    host.registry.destroy(entity);
    throw;
  }
  return 1;
}

int load_model(lua_State* state) {
  auto& host = host_of(state);
  const std::string path(text_argument(state, 1));
  if (!host.options.services.load_model) raise(state, "world.model: models cannot be loaded here");
  if (host.models_loaded >= host.options.limits.models) {
    raise(state,
          fmt::format("world.model: {} models were loaded already, as many as a script may", host.models_loaded));
  }
  const auto loaded = host.options.services.load_model(path);
  if (!loaded) raise(state, loaded.error().message);
  ++host.models_loaded;
  for (const Entity entity : *loaded) apply_pins(host, entity);
  charge(state, 10 * loaded->size());
  lua_createtable(state, static_cast<int>(loaded->size()), 0);
  for (std::size_t i = 0; i < loaded->size(); ++i) {
    push_entity(state, (*loaded)[i]);
    lua_rawseti(state, -2, static_cast<lua_Integer>(i) + 1);
  }
  luaL_setmetatable(state, model_metatable);
  return 1;
}

bool is_named(ScriptHost::Impl& host, Entity entity, std::string_view name) {
  if (!host.registry.alive(entity)) return false;
  const void* component = host.name.schema->find(host.registry, entity);
  return component && read_field(*host.name.field, component).get_ref<const std::string&>() == name;
}

void check_names_known(lua_State* state) {
  if (!host_of(state).name.schema) raise(state, "find: entities have no names here");
}

int find_in_world(lua_State* state) {
  auto& host = host_of(state);
  const std::string_view name = text_argument(state, 1);
  check_names_known(state);
  const auto named = host.name.schema->entities(host.registry);
  charge(state, named.size() * 10);
  for (const Entity entity : named) {
    if (!is_named(host, entity, name)) continue;
    push_entity(state, entity);
    return 1;
  }
  lua_pushnil(state);
  return 1;
}

int each_in_world(lua_State* state) {
  auto& host = host_of(state);
  const Schema& schema = check_schema(state, text_argument(state, 1));
  luaL_checktype(state, 2, LUA_TFUNCTION);
  lua_settop(state, 2);
  // A list of its own: the function may spawn and destroy.
  const auto entities = schema.entities(host.registry);
  charge(state, entities.size());
  for (const Entity entity : entities) {
    if (!schema.find(host.registry, entity)) continue;
    lua_pushvalue(state, 2);
    push_entity(state, entity);
    lua_call(state, 1, 0);
  }
  return 0;
}

int count_in_world(lua_State* state) {
  auto& host = host_of(state);
  const Schema& schema = check_schema(state, text_argument(state, 1));
  const auto entities = schema.entities(host.registry);
  charge(state, entities.size());
  lua_pushinteger(state, static_cast<lua_Integer>(entities.size()));
  return 1;
}

int world_time(lua_State* state) {
  lua_pushnumber(state, host_of(state).timeline.now_s());
  return 1;
}

std::vector<Entity> check_entities(lua_State* state, int index) {
  luaL_checktype(state, index, LUA_TTABLE);
  std::vector<Entity> entities;
  for (lua_Integer i = 1;; ++i) {
    const bool is_end = lua_rawgeti(state, index, i) == LUA_TNIL;
    if (!is_end) {
      const Entity* entity = test_entity(state, -1);
      if (!entity) raise(state, fmt::format("got {}, expected a list of entities", describe(state, -1)));
      if (host_of(state).registry.alive(*entity)) entities.push_back(*entity);
    }
    lua_pop(state, 1);
    if (is_end) break;
  }
  charge(state, entities.size());
  return entities;
}

int model_find(lua_State* state) {
  const std::string_view name = text_argument(state, 2);
  check_names_known(state);
  for (const Entity entity : check_entities(state, 1)) {
    if (!is_named(host_of(state), entity, name)) continue;
    push_entity(state, entity);
    return 1;
  }
  lua_pushnil(state);
  return 1;
}

int model_each(lua_State* state) {
  const Schema& schema = check_schema(state, text_argument(state, 2));
  luaL_checktype(state, 3, LUA_TFUNCTION);
  for (const Entity entity : check_entities(state, 1)) {
    if (!schema.find(host_of(state).registry, entity)) continue;
    lua_pushvalue(state, 3);
    push_entity(state, entity);
    lua_call(state, 1, 0);
  }
  return 0;
}

int model_count(lua_State* state) {
  const Schema& schema = check_schema(state, text_argument(state, 2));
  lua_Integer count = 0;
  for (const Entity entity : check_entities(state, 1)) count += schema.find(host_of(state).registry, entity) ? 1 : 0;
  lua_pushinteger(state, count);
  return 1;
}

int model_bounds(lua_State* state) {
  auto& host = host_of(state);
  const auto entities = check_entities(state, 1);
  if (!host.options.services.bounds) raise(state, "bounds: sizes are not known here");
  const auto box = host.options.services.bounds(entities);
  if (!box) raise(state, box.error().message);
  for (const glm::vec3& corner : {box->first, box->second}) {
    push_vector(state, std::array<double, 3>{corner.x, corner.y, corner.z});
  }
  return 2;
}

int look_at(lua_State* state) {
  std::array<double, 3> from{}, to{};
  check_vector(state, 1, from, "look_at, from");
  check_vector(state, 2, to, "look_at, to");
  const glm::dvec3 direction = glm::dvec3(to[0], to[1], to[2]) - glm::dvec3(from[0], from[1], from[2]);
  const double length = glm::length(direction);
  if (!(length > 1e-9) || !std::isfinite(length)) raise(state, "look_at: from and to are the same point");
  const glm::dquat q = look_along(direction);
  push_vector(state, std::array<double, 4>{q.x, q.y, q.z, q.w});
  return 1;
}

int euler(lua_State* state) {
  const double yaw = glm::radians(luaL_checknumber(state, 1));
  const double pitch = glm::radians(luaL_optnumber(state, 2, 0.0));
  const double roll = glm::radians(luaL_optnumber(state, 3, 0.0));
  const glm::dquat q = glm::angleAxis(yaw, glm::dvec3(0, 1, 0)) * glm::angleAxis(pitch, glm::dvec3(1, 0, 0)) *
                       glm::angleAxis(roll, glm::dvec3(0, 0, 1));
  push_vector(state, std::array<double, 4>{q.x, q.y, q.z, q.w});
  return 1;
}

constexpr Binding bindings[] = {
    {"", "vec3", "vec3(x, y, z) -> vector",
     "A vector: `v.x`, `v + w`, `v * 2`. Plain tables `{1, 2, 3}` and `{x=1, y=2, z=3}` do as well wherever a vector "
     "is wanted.",
     guarded<make_vector>},
    {"", "look_at", "look_at(from, to) -> rotation",
     "The rotation of something at `from` (a camera, a spot) that looks at `to`.", guarded<look_at>},
    {"", "euler", "euler(yaw, pitch, roll) -> rotation",
     "Degrees: yaw turns left about y, pitch tilts up, roll leans left, in this order.", guarded<euler>},
    {"world", "spawn", "world.spawn{component={field=value}, ...} -> entity",
     "Makes an entity with these components; fields that are not given keep their defaults. `name=\"...\"` names it, "
     "`parent=entity` hangs it on another.",
     guarded<spawn>},
    {"world", "model", "world.model(path) -> model", "Loads a .gltf or .glb and spawns its nodes.",
     guarded<load_model>},
    {"world", "find", "world.find(name) -> entity or nil", "The first entity of this name.", guarded<find_in_world>},
    {"world", "each", "world.each(component, function(entity) ... end)",
     "Calls the function for every entity that has the component.", guarded<each_in_world>},
    {"world", "count", "world.count(component) -> number", "How many entities have the component.",
     guarded<count_in_world>},
    {"world", "time", "world.time() -> seconds",
     "Simulation time; in a timeline the very time it asked to be woken at.", guarded<world_time>},
    {"model", "find", "model:find(name) -> entity or nil", "The first of the model's entities of this name.",
     guarded<model_find>},
    {"model", "each", "model:each(component, function(entity) ... end)",
     "Calls the function for those of the model's entities that have the component.", guarded<model_each>},
    {"model", "count", "model:count(component) -> number", "How many of the model's entities have the component.",
     guarded<model_count>},
    {"model", "bounds", "model:bounds() -> minimum, maximum",
     "Two vectors: the corners of the box round what the model draws, in metres.", guarded<model_bounds>}};

}  // namespace

std::span<const Binding> world_bindings() {
  return bindings;
}

void open_models(lua_State* state) {
  open_object(state, model_metatable);
  push_functions(state, "model");
  lua_setfield(state, -2, "__index");
  lua_pop(state, 1);
}

}  // namespace petrichor::script
