// Entities and their components as scripts see them. Everything here walks schemas; no component is named.

#include <fmt/format.h>

#include <algorithm>
#include <lua.hpp>
#include <nlohmann/json.hpp>

#include "engine/core/names.hpp"
#include "engine/script/bindings.hpp"
#include "engine/script/host.hpp"
#include "engine/script/values.hpp"

namespace petrichor::script {

using nlohmann::json;

namespace {

constexpr const char* entity_metatable = "petrichor.entity";
constexpr const char* component_metatable = "petrichor.component";
constexpr const char* entity_cache = "petrichor.entities";

const Field& check_field(lua_State* state, const Schema& schema, std::string_view name) {
  if (const Field* field = find_field(schema, name)) return *field;
  std::vector<std::string_view> known;
  for (const Field& field : schema.fields) known.push_back(field.name);
  raise(state, fmt::format("{} has no field \"{}\"{}", schema.name, name, name_hint(name, known)));
}

// A component that is one text (a name) is written and read as that text.
bool is_plain_text(const Schema& schema) {
  return schema.fields.size() == 1 && schema.fields[0].type == FieldType::text;
}

std::string entity_words(ScriptHost::Impl& host, Entity entity) {
  std::string words = fmt::format("entity {}", entity.bits);
  if (host.name.schema && host.registry.alive(entity)) {
    if (const void* name = host.name.schema->find(host.registry, entity)) {
      words = fmt::format("entity \"{}\"", read_field(*host.name.field, name).get<std::string>());
    }
  }
  return words;
}

}  // namespace

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
    raise(state, fmt::format("{}: got {}, expected a table of fields, such as {}={{{}=...}}", schema.name,
                             describe(state, index), schema.name, schema.fields.empty() ? "" : schema.fields[0].name));
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

namespace {

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
  if (lua_isnoneornil(state, 3))
    add_component(host_of(state), schema, entity);
  else
    set_component(state, entity, schema, 3);
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
    raise(state, fmt::format("{} has no {}; ask with :has(\"{}\") or add it with :add(\"{}\")",
                             entity_words(host, entity), name, name, name));
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
  if (lua_isnil(state, 3))
    schema.remove(host_of(state).registry, entity);
  else
    set_component(state, entity, schema, 3);
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

// The living component behind a proxy; raises where the entity or the component is gone.
std::pair<const ComponentBox*, void*> check_component(lua_State* state, int index) {
  const auto* box = static_cast<const ComponentBox*>(luaL_checkudata(state, index, component_metatable));
  auto& host = host_of(state);
  if (!host.registry.alive(box->entity))
    raise(state, fmt::format("this {} belongs to an entity that was destroyed", box->schema->name));
  void* component = box->schema->find(host.registry, box->entity);
  if (!component)
    raise(state, fmt::format("{} has no {} any more", entity_words(host, box->entity), box->schema->name));
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

constexpr Binding bindings[] = {
    {"entity", "destroy", "entity:destroy()", "Removes the entity; using it afterwards is an error.",
     guarded<destroy_entity>},
    {"entity", "alive", "entity:alive() -> boolean", "Whether it has not been destroyed.", guarded<entity_is_alive>},
    {"entity", "has", "entity:has(component) -> boolean", "Whether it has the component.", guarded<entity_has>},
    {"entity", "add", "entity:add(component, {field=value}) -> entity",
     "Adds the component, or sets these fields of the one that is there. The same as `entity.component = {...}`.",
     guarded<entity_add>},
    {"entity", "remove", "entity:remove(component) -> entity",
     "Takes the component away. The same as `entity.component = nil`.", guarded<entity_remove>}};

}  // namespace

std::span<const Binding> entity_bindings() {
  return bindings;
}

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

const Entity* test_entity(lua_State* state, int index) {
  return static_cast<const Entity*>(luaL_testudata(state, index, entity_metatable));
}

Entity check_entity(lua_State* state, int index) {
  const Entity* entity = test_entity(state, index);
  if (!entity) raise(state, fmt::format("got {}, expected an entity", describe(state, index)));
  if (!host_of(state).registry.alive(*entity)) raise(state, "this entity was destroyed");
  return *entity;
}

ComponentBox test_component(lua_State* state, int index) {
  if (!luaL_testudata(state, index, component_metatable)) return {};
  return *check_component(state, index).first;
}

void open_entities(lua_State* state) {
  lua_newtable(state);  // a weak cache: values may go
  lua_newtable(state);
  lua_pushliteral(state, "v");
  lua_setfield(state, -2, "__mode");
  lua_setmetatable(state, -2);
  lua_setfield(state, LUA_REGISTRYINDEX, entity_cache);

  open_object(state, entity_metatable);
  push_functions(state, "entity");
  lua_pushcclosure(state, guarded<entity_index>, 1);
  lua_setfield(state, -2, "__index");
  const luaL_Reg of_entities[] = {{"__newindex", guarded<entity_newindex>},
                                  {"__eq", guarded<entity_equal>},
                                  {"__tostring", guarded<entity_text>},
                                  {nullptr, nullptr}};
  luaL_setfuncs(state, of_entities, 0);
  lua_pushboolean(state, 1);  // entities have a place in the order of pairs
  lua_setfield(state, -2, "__order");
  lua_pop(state, 1);

  open_object(state, component_metatable);
  const luaL_Reg of_components[] = {{"__index", guarded<component_index>},
                                    {"__newindex", guarded<component_newindex>},
                                    {"__tostring", guarded<component_text>},
                                    {"__pairs", guarded<component_pairs>},
                                    {nullptr, nullptr}};
  luaL_setfuncs(state, of_components, 0);
  lua_pop(state, 1);
}

}  // namespace petrichor::script
