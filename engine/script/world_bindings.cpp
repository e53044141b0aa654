// Entities and components as scripts see them. Everything here walks schemas; no component is named.

#include <fmt/format.h>

#include <array>
#include <glm/gtc/quaternion.hpp>
#include <lua.hpp>
#include <nlohmann/json.hpp>

#include "engine/core/names.hpp"
#include "engine/script/bindings.hpp"
#include "engine/script/host.hpp"
#include "engine/script/path.hpp"
#include "engine/script/values.hpp"

namespace petrichor::script {
namespace {

using nlohmann::json;

constexpr const char* entity_metatable = "petrichor.entity";
constexpr const char* component_metatable = "petrichor.component";
constexpr const char* model_metatable = "petrichor.model";
constexpr const char* entity_cache = "petrichor.entities";

std::string_view text_argument(lua_State* state, int index) {
  std::size_t length = 0;
  const char* text = luaL_checklstring(state, index, &length);
  return {text, length};
}

const Schema& check_schema(lua_State* state, std::string_view name) {
  const auto& host = host_of(state);
  if (const Schema* schema = find_schema(host.schemas, name)) return *schema;
  std::vector<std::string_view> known;
  for (const Schema& schema : host.schemas) known.push_back(schema.name);
  raise(state, fmt::format("no component is called \"{}\"{}", name, name_hint(name, known)));
}

const Field& check_field(lua_State* state, const Schema& schema, std::string_view name) {
  if (const Field* field = find_field(schema, name)) return *field;
  std::vector<std::string_view> known;
  for (const Field& field : schema.fields) known.push_back(field.name);
  raise(state, fmt::format("{} has no field \"{}\"{}", schema.name, name, name_hint(name, known)));
}

// A component that is one text (a name) is written and read as that text.
bool is_plain_text(const Schema& schema) { return schema.fields.size() == 1 && schema.fields[0].type == FieldType::text; }

std::string entity_words(ScriptHost::Impl& host, Entity entity) {
  std::string words = fmt::format("entity {}", entity.bits);
  if (host.name.schema && host.registry.alive(entity)) {
    if (const void* name = host.name.schema->find(host.registry, entity)) {
      words = fmt::format("entity \"{}\"", read_field(*host.name.field, name).get<std::string>());
    }
  }
  return words;
}

void set_component(lua_State* state, Entity entity, const Schema& schema, int index) {
  auto& host = host_of(state);
  index = lua_absindex(state, index);
  if (is_plain_text(schema) && lua_type(state, index) == LUA_TSTRING) {
    const json value = check_field_value(state, index, schema, schema.fields[0]);
    const auto written = set_field(host, schema, schema.fields[0], add_component(host, schema, entity), value);
    if (!written) raise(state, written.error().message);
    return;
  }
  if (!lua_istable(state, index)) {
    raise(state, fmt::format("{}: got {}, expected a table of fields, such as {}={{{}=...}}", schema.name, describe(state, index), schema.name,
                             schema.fields.empty() ? "" : schema.fields[0].name));
  }
  std::vector<std::pair<const Field*, json>> values;
  lua_pushnil(state);
  while (lua_next(state, index)) {
    if (lua_type(state, -2) != LUA_TSTRING) {
      raise(state, fmt::format("{}: {} is no field name; write field=value", schema.name, describe(state, -2)));
    }
    const Field& field = check_field(state, schema, text_argument(state, -2));
    values.emplace_back(&field, check_field_value(state, -1, schema, field));
    lua_pop(state, 1);
  }
  // In the schema's order, so that of two mistakes the same one is always told.
  std::sort(values.begin(), values.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  void* component = add_component(host, schema, entity);
  for (const auto& [field, value] : values) {
    const auto written = set_field(host, schema, *field, component, value);
    if (!written) raise(state, written.error().message);
  }
}

// ---- world ------------------------------------------------------------------------------------------------

int spawn(lua_State* state) {
  auto& host = host_of(state);
  luaL_checktype(state, 1, LUA_TTABLE);
  lua_settop(state, 1);
  Entity parent = null_entity;
  std::vector<const Schema*> wanted;
  lua_pushnil(state);
  while (lua_next(state, 1)) {
    if (lua_type(state, -2) != LUA_TSTRING) {
      raise(state, fmt::format("world.spawn: {} is no component name; write component={{field=value}}", describe(state, -2)));
    }
    const std::string_view key = text_argument(state, -2);
    if (key == "parent") parent = check_entity(state, -1);
    else wanted.push_back(&check_schema(state, key));
    lua_pop(state, 1);
  }
  if (parent != null_entity && !host.options.services.set_parent) raise(state, "world.spawn: entities cannot have a parent here");
  std::sort(wanted.begin(), wanted.end());
  charge(state, 100);
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
  const auto loaded = host.options.services.load_model(path);
  if (!loaded) raise(state, loaded.error().message);
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
  lua_pushinteger(state, static_cast<lua_Integer>(schema.entities(host.registry).size()));
  return 1;
}

int world_time(lua_State* state) {
  lua_pushnumber(state, host_of(state).timeline.now_s());
  return 1;
}

// ---- entity -----------------------------------------------------------------------------------------------

int destroy_entity(lua_State* state) {
  host_of(state).registry.destroy(check_entity(state, 1));
  return 0;
}

int entity_is_alive(lua_State* state) {
  const auto* entity = static_cast<const Entity*>(luaL_checkudata(state, 1, entity_metatable));
  lua_pushboolean(state, host_of(state).registry.alive(*entity));
  return 1;
}

int entity_has(lua_State* state) {
  const Entity entity = check_entity(state, 1);
  lua_pushboolean(state, check_schema(state, text_argument(state, 2)).find(host_of(state).registry, entity) != nullptr);
  return 1;
}

int entity_add(lua_State* state) {
  const Entity entity = check_entity(state, 1);
  const Schema& schema = check_schema(state, text_argument(state, 2));
  if (lua_isnoneornil(state, 3)) add_component(host_of(state), schema, entity);
  else set_component(state, entity, schema, 3);
  lua_settop(state, 1);
  return 1;
}

int entity_remove(lua_State* state) {
  const Entity entity = check_entity(state, 1);
  check_schema(state, text_argument(state, 2)).remove(host_of(state).registry, entity);
  lua_settop(state, 1);
  return 1;
}

// Upvalue 1: the methods.
int entity_index(lua_State* state) {
  const Entity entity = *static_cast<const Entity*>(luaL_checkudata(state, 1, entity_metatable));
  lua_pushvalue(state, 2);
  if (lua_rawget(state, lua_upvalueindex(1)) != LUA_TNIL) return 1;
  const std::string_view name = text_argument(state, 2);
  auto& host = host_of(state);
  const Schema& schema = check_schema(state, name);
  check_entity(state, 1);
  const void* component = schema.find(host.registry, entity);
  if (!component) {
    raise(state, fmt::format("{} has no {}; ask with :has(\"{}\") or add it with :add(\"{}\")", entity_words(host, entity), name, name, name));
  }
  if (is_plain_text(schema)) {
    push_json(state, read_field(schema.fields[0], component));
    return 1;
  }
  auto* box = static_cast<ComponentBox*>(lua_newuserdatauv(state, sizeof(ComponentBox), 0));
  *box = ComponentBox{entity, &schema};
  luaL_setmetatable(state, component_metatable);
  return 1;
}

int entity_newindex(lua_State* state) {
  const Entity entity = check_entity(state, 1);
  const Schema& schema = check_schema(state, text_argument(state, 2));
  if (lua_isnil(state, 3)) schema.remove(host_of(state).registry, entity);
  else set_component(state, entity, schema, 3);
  return 0;
}

int entity_equal(lua_State* state) {
  const auto* a = static_cast<const Entity*>(luaL_testudata(state, 1, entity_metatable));
  const auto* b = static_cast<const Entity*>(luaL_testudata(state, 2, entity_metatable));
  lua_pushboolean(state, a && b && *a == *b);
  return 1;
}

int entity_text(lua_State* state) {
  const auto* entity = static_cast<const Entity*>(luaL_checkudata(state, 1, entity_metatable));
  const std::string words = entity_words(host_of(state), *entity);
  lua_pushlstring(state, words.data(), words.size());
  return 1;
}

// ---- component --------------------------------------------------------------------------------------------

// The living component behind a proxy; raises where the entity or the component is gone.
std::pair<const ComponentBox*, void*> check_component(lua_State* state, int index) {
  const auto* box = static_cast<const ComponentBox*>(luaL_checkudata(state, index, component_metatable));
  auto& host = host_of(state);
  if (!host.registry.alive(box->entity)) raise(state, fmt::format("this {} belongs to an entity that was destroyed", box->schema->name));
  void* component = box->schema->find(host.registry, box->entity);
  if (!component) raise(state, fmt::format("{} has no {} any more", entity_words(host, box->entity), box->schema->name));
  return {box, component};
}

int component_index(lua_State* state) {
  const auto [box, component] = check_component(state, 1);
  push_json(state, read_field(check_field(state, *box->schema, text_argument(state, 2)), component));
  return 1;
}

int component_newindex(lua_State* state) {
  const auto [box, component] = check_component(state, 1);
  const Field& field = check_field(state, *box->schema, text_argument(state, 2));
  const json value = check_field_value(state, 3, *box->schema, field);
  const auto written = set_field(host_of(state), *box->schema, field, component, value);
  if (!written) raise(state, written.error().message);
  return 0;
}

int component_text(lua_State* state) {
  const auto* box = static_cast<const ComponentBox*>(luaL_checkudata(state, 1, component_metatable));
  const std::string words = fmt::format("{} of {}", box->schema->name, entity_words(host_of(state), box->entity));
  lua_pushlstring(state, words.data(), words.size());
  return 1;
}

// for field, value in pairs(rain.emitter): in the schema's order.
int next_field(lua_State* state) {
  const auto [box, component] = check_component(state, 1);
  const auto at = static_cast<std::size_t>(lua_tointeger(state, lua_upvalueindex(1)));
  if (at >= box->schema->fields.size()) return 0;
  lua_pushinteger(state, static_cast<lua_Integer>(at) + 1);
  lua_replace(state, lua_upvalueindex(1));
  const Field& field = box->schema->fields[at];
  lua_pushlstring(state, field.name.data(), field.name.size());
  push_json(state, read_field(field, component));
  return 2;
}

int component_pairs(lua_State* state) {
  check_component(state, 1);
  lua_pushinteger(state, 0);
  lua_pushcclosure(state, guarded<next_field>, 1);
  lua_pushvalue(state, 1);
  lua_pushnil(state);
  return 3;
}

// ---- model: a list of entities -----------------------------------------------------------------------------

std::vector<Entity> check_entities(lua_State* state, int index) {
  luaL_checktype(state, index, LUA_TTABLE);
  std::vector<Entity> entities;
  for (lua_Integer i = 1;; ++i) {
    const bool is_end = lua_rawgeti(state, index, i) == LUA_TNIL;
    if (!is_end) {
      const auto* entity = static_cast<const Entity*>(luaL_testudata(state, -1, entity_metatable));
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

// ---- rotations --------------------------------------------------------------------------------------------

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
    {"", "vec3", "vec3(x, y, z) -> vector", "A vector: `v.x`, `v + w`, `v * 2`. Plain tables `{1, 2, 3}` and `{x=1, y=2, z=3}` do as well wherever a vector is wanted.", guarded<make_vector>},
    {"", "look_at", "look_at(from, to) -> rotation", "The rotation of something at `from` (a camera, a spot) that looks at `to`.", guarded<look_at>},
    {"", "euler", "euler(yaw, pitch, roll) -> rotation", "Degrees: yaw turns left about y, pitch tilts up, roll leans left, in this order.", guarded<euler>},
    {"world", "spawn", "world.spawn{component={field=value}, ...} -> entity", "Makes an entity with these components; fields that are not given keep their defaults. `name=\"...\"` names it, `parent=entity` hangs it on another.", guarded<spawn>},
    {"world", "model", "world.model(path) -> model", "Loads a .gltf or .glb and spawns its nodes.", guarded<load_model>},
    {"world", "find", "world.find(name) -> entity or nil", "The first entity of this name.", guarded<find_in_world>},
    {"world", "each", "world.each(component, function(entity) ... end)", "Calls the function for every entity that has the component.", guarded<each_in_world>},
    {"world", "count", "world.count(component) -> number", "How many entities have the component.", guarded<count_in_world>},
    {"world", "time", "world.time() -> seconds", "Simulation time; in a timeline the very time it asked to be woken at.", guarded<world_time>},
    {"entity", "destroy", "entity:destroy()", "Removes the entity; using it afterwards is an error.", guarded<destroy_entity>},
    {"entity", "alive", "entity:alive() -> boolean", "Whether it has not been destroyed.", guarded<entity_is_alive>},
    {"entity", "has", "entity:has(component) -> boolean", "Whether it has the component.", guarded<entity_has>},
    {"entity", "add", "entity:add(component, {field=value}) -> entity", "Adds the component, or sets these fields of the one that is there. The same as `entity.component = {...}`.", guarded<entity_add>},
    {"entity", "remove", "entity:remove(component) -> entity", "Takes the component away. The same as `entity.component = nil`.", guarded<entity_remove>},
    {"model", "find", "model:find(name) -> entity or nil", "The first of the model's entities of this name.", guarded<model_find>},
    {"model", "each", "model:each(component, function(entity) ... end)", "Calls the function for those of the model's entities that have the component.", guarded<model_each>},
    {"model", "count", "model:count(component) -> number", "How many of the model's entities have the component.", guarded<model_count>},
    {"model", "bounds", "model:bounds() -> minimum, maximum", "Two vectors: the corners of the box round what the model draws, in metres.", guarded<model_bounds>},
};

}  // namespace

std::span<const Binding> world_bindings() { return bindings; }

void push_entity(lua_State* state, Entity entity) {
  // One userdata per entity while it is in use, so that entities work as keys of a table.
  luaL_checkstack(state, 4, "too many values");
  luaL_getsubtable(state, LUA_REGISTRYINDEX, entity_cache);
  if (lua_rawgeti(state, -1, entity.bits) == LUA_TNIL) {
    lua_pop(state, 1);
    auto* box = static_cast<Entity*>(lua_newuserdatauv(state, sizeof(Entity), 0));
    *box = entity;
    luaL_setmetatable(state, entity_metatable);
    lua_pushvalue(state, -1);
    lua_rawseti(state, -3, entity.bits);
  }
  lua_remove(state, -2);
}

Entity check_entity(lua_State* state, int index) {
  const auto* entity = static_cast<const Entity*>(luaL_testudata(state, index, entity_metatable));
  if (!entity) raise(state, fmt::format("got {}, expected an entity", describe(state, index)));
  if (!host_of(state).registry.alive(*entity)) raise(state, "this entity was destroyed");
  return *entity;
}

ComponentBox test_component(lua_State* state, int index) {
  if (!luaL_testudata(state, index, component_metatable)) return {};
  return *check_component(state, index).first;
}

void open_bindings(lua_State* state) {
  open_vectors(state);

  lua_newtable(state);  // a weak cache: values may go
  lua_newtable(state);
  lua_pushliteral(state, "v");
  lua_setfield(state, -2, "__mode");
  lua_setmetatable(state, -2);
  lua_setfield(state, LUA_REGISTRYINDEX, entity_cache);

  const auto methods_of = [&](std::string_view owner) {
    lua_newtable(state);
    for (const auto list : {world_bindings(), timeline_bindings()}) {
      for (const Binding& binding : list) {
        if (binding.owner != owner) continue;
        lua_pushcfunction(state, binding.function);
        lua_setfield(state, -2, binding.name);
      }
    }
  };
  const auto metatable = [&](const char* name, std::initializer_list<luaL_Reg> functions) {
    luaL_newmetatable(state, name);
    for (const luaL_Reg& f : functions) {
      lua_pushcfunction(state, f.func);
      lua_setfield(state, -2, f.name);
    }
    lua_pushstring(state, name + sizeof("petrichor.") - 1);
    lua_setfield(state, -2, "__metatable");
    lua_pushstring(state, name + sizeof("petrichor.") - 1);
    lua_setfield(state, -2, "__name");
  };

  metatable(entity_metatable, {{"__newindex", guarded<entity_newindex>}, {"__eq", guarded<entity_equal>}, {"__tostring", guarded<entity_text>}});
  methods_of("entity");
  lua_pushcclosure(state, guarded<entity_index>, 1);
  lua_setfield(state, -2, "__index");
  lua_pushboolean(state, 1);
  lua_setfield(state, -2, "__order");
  lua_pop(state, 1);

  metatable(component_metatable, {{"__index", guarded<component_index>},
                                  {"__newindex", guarded<component_newindex>},
                                  {"__tostring", guarded<component_text>},
                                  {"__pairs", guarded<component_pairs>}});
  lua_pop(state, 1);

  for (const char* name : {"model", "handler"}) {
    metatable(std::string_view(name) == "model" ? model_metatable : "petrichor.handler", {});
    methods_of(name);
    lua_setfield(state, -2, "__index");
    lua_pop(state, 1);
  }

  for (const char* owner : {"world", "camera"}) {
    methods_of(owner);
    lua_setglobal(state, owner);
  }
  for (const auto list : {world_bindings(), timeline_bindings()}) {
    for (const Binding& binding : list) {
      if (binding.owner.empty()) lua_register(state, binding.name, binding.function);
    }
  }
}

}  // namespace petrichor::script
