// What scripts can say about time: coroutines, tweens, events.

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <lua.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "engine/core/names.hpp"
#include "engine/script/bindings.hpp"
#include "engine/script/host.hpp"
#include "engine/script/path.hpp"
#include "engine/script/values.hpp"

namespace petrichor::script {

using nlohmann::json;

// The timeline, for a function that waits; raises where nothing can wait.
Timeline& check_can_wait(lua_State* state, const char* function) {
  Timeline& timeline = host_of(state).timeline;
  if (!timeline.is_current(state)) {
    raise(state, fmt::format("{} must be called from the script itself or from timeline(), go() or on(), not from a "
                             "coroutine of your own",
                             function));
  }
  if (!lua_isyieldable(state)) {
    raise(state, fmt::format("{} cannot be called inside a function that the library calls (each, sort, gsub, require)",
                             function));
  }
  return timeline;
}

Result<void> write_target(ScriptHost::Impl& host, const Schema& schema, const Target& target, const json& value) {
  if (!host.registry.alive(target.entity))
    return failure(fmt::format("the entity whose {}.{} moves was destroyed", schema.name, target.field->name));
  void* component = schema.find(host.registry, target.entity);
  if (!component) return failure(fmt::format("the {} whose {} moves was removed", schema.name, target.field->name));
  return set_field(host, schema, *target.field, component, value);
}

namespace {

constexpr const char* handler_metatable = "petrichor.handler";

Timeline& timeline_of(lua_State* state) {
  return host_of(state).timeline;
}

double check_seconds(lua_State* state, int index, const char* function) {
  const double seconds = luaL_checknumber(state, index);
  if (!(seconds >= 0.0) || seconds > longest_s)
    raise(state, fmt::format("{}: got {} s, expected 0 to {:g} s", function, seconds, longest_s));
  return seconds;
}

std::string check_event(lua_State* state, int index) {
  std::size_t length = 0;
  const char* text = luaL_checklstring(state, index, &length);
  luaL_argcheck(state, length <= 256, index, "the name of an event has at most 256 bytes");
  return std::string(text, length);
}

int start_task(lua_State* state) {
  luaL_checktype(state, 1, LUA_TFUNCTION);
  timeline_of(state).start(state, lua_gettop(state) - 1);
  return 0;
}

int wait(lua_State* state) {
  const double seconds = lua_isnoneornil(state, 1) ? 0.0 : check_seconds(state, 1, "wait");
  Timeline& timeline = check_can_wait(state, "wait");
  if (seconds == 0.0) return timeline.wait_next_step(state);
  return timeline.wait_until(state, timeline.now_s() + seconds);
}

int wait_until(lua_State* state) {
  const double time_s = check_seconds(state, 1, "wait_until");
  Timeline& timeline = check_can_wait(state, "wait_until");
  if (time_s <= timeline.now_s()) return 0;
  return timeline.wait_until(state, time_s);
}

int wait_for(lua_State* state) {
  const std::string event = check_event(state, 1);
  return check_can_wait(state, "wait_for").wait_for_event(state, event);
}

int on_event(lua_State* state) {
  const std::string event = check_event(state, 1);
  luaL_checktype(state, 2, LUA_TFUNCTION);
  lua_settop(state, 2);
  charge(state, 100);
  if (timeline_of(state).handlers() >= host_of(state).options.limits.handlers) {
    raise(state, fmt::format("on: there are {} handlers already; end those that are done with :off()",
                             timeline_of(state).handlers()));
  }
  const std::uint64_t id = timeline_of(state).add_handler(state, event);
  lua_createtable(state, 1, 0);
  lua_pushinteger(state, static_cast<lua_Integer>(id));
  lua_rawseti(state, -2, 1);
  luaL_setmetatable(state, handler_metatable);
  return 1;
}

int handler_off(lua_State* state) {
  luaL_checktype(state, 1, LUA_TTABLE);
  lua_rawgeti(state, 1, 1);
  timeline_of(state).remove_handler(state, static_cast<std::uint64_t>(lua_tointeger(state, -1)));
  return 0;
}

int emit_event(lua_State* state) {
  const std::string event = check_event(state, 1);
  charge(state, 100);
  lua_pushinteger(state, timeline_of(state).emit(state, event, lua_gettop(state) - 1));
  return 1;
}

// ---- tween ------------------------------------------------------------------------------------------------

bool is_tweened(FieldType type) {
  return type != FieldType::boolean && type != FieldType::text && type != FieldType::choice;
}

std::array<double, 4> numbers_of(const json& value) {
  std::array<double, 4> out{};
  if (value.is_number())
    out[0] = value.get<double>();
  else
    for (std::size_t i = 0; i < std::min<std::size_t>(value.size(), 4); ++i) out[i] = value[i].get<double>();
  return out;
}

// Between two values of a field; exactly `to` at progress 1.
json blend(const Field& field, const json& from, const json& to, double progress) {
  if (progress >= 1.0) return to;
  const auto a = numbers_of(from);
  const auto b = numbers_of(to);
  if (field.type == FieldType::rotation) {
    const glm::dquat q =
        glm::slerp(glm::dquat(a[3], a[0], a[1], a[2]), glm::normalize(glm::dquat(b[3], b[0], b[1], b[2])), progress);
    return json::array({q.x, q.y, q.z, q.w});
  }
  if (field.type == FieldType::integer) return static_cast<std::int64_t>(std::llround(a[0] + (b[0] - a[0]) * progress));
  if (to.is_number()) return a[0] + (b[0] - a[0]) * progress;
  json out = json::array();
  for (std::size_t i = 0; i < to.size(); ++i) out.push_back(a[i] + (b[i] - a[i]) * progress);
  return out;
}

int tween(lua_State* state) {
  auto& host = host_of(state);
  const ComponentBox box = test_component(state, 1);
  if (!box.schema)
    raise(state, fmt::format("tween: got {}, expected a component such as rain.emitter", describe(state, 1)));
  std::size_t length = 0;
  const char* name = luaL_checklstring(state, 2, &length);
  const Schema& schema = *box.schema;
  const Field* field = find_field(schema, std::string_view(name, length));
  if (!field) {
    std::vector<std::string_view> known;
    for (const Field& f : schema.fields) known.push_back(f.name);
    raise(state, fmt::format("tween: {} has no field \"{}\"{}", schema.name, name, name_hint(name, known)));
  }
  if (!is_tweened(field->type))
    raise(state, fmt::format("tween: {}.{} has no values in between; set it instead", schema.name, field->name));
  const json to = check_field_value(state, 3, schema, *field);
  const double duration_s = check_seconds(state, 4, "tween");
  std::size_t easing_length = 0;
  const char* easing_text = luaL_optlstring(state, 5, "linear", &easing_length);
  const auto easing = easing_named(std::string_view(easing_text, easing_length));
  if (!easing) {
    static constexpr std::array<std::string_view, 4> known{"linear", "smooth", "in", "out"};
    raise(state, fmt::format("tween: no easing is called \"{}\"{}", easing_text, name_hint(easing_text, known)));
  }
  Timeline& timeline = check_can_wait(state, "tween");

  // Writing the end and then the start again finds a bad end value here, at the script's line.
  void* component = schema.find(host.registry, box.entity);
  const json from = read_field(*field, component);
  auto checked = write_field(schema, *field, component, to);
  if (!checked) raise(state, checked.error().message);
  if (const auto restored = write_field(schema, *field, component, from); !restored)
    raise(state, restored.error().message);

  const double start_s = timeline.now_s();
  if (duration_s == 0.0) {
    if (const auto set = set_field(host, schema, *field, component, to); !set) raise(state, set.error().message);
    return 0;
  }
  Track track;
  track.end_s = start_s + duration_s;
  track.targets = {Target{box.entity, field}};
  track.apply = [&host, &schema, field, from, to, start_s, end_s = track.end_s, duration_s, curve = *easing](
                    double time_s, const std::vector<Target>& targets) -> Result<void> {
    const double progress = time_s >= end_s ? 1.0 : (time_s - start_s) / duration_s;
    return write_target(host, schema, targets[0], blend(*field, from, to, ease(curve, progress)));
  };
  return timeline.run_track(state, std::move(track));
}

constexpr Binding bindings[] = {
    {"", "timeline", "timeline(function() ... end)",
     "Starts a story: the function runs beside everything else and may wait. The script itself is one too.",
     guarded<start_task>},
    {"", "go", "go(function(...) ... end, ...)", "The same, from inside a story: what follows does not wait for it.",
     guarded<start_task>},
    {"", "wait", "wait(seconds)", "Goes on so much later. `wait()` goes on in the next step of the simulation.",
     guarded<wait>},
    {"", "wait_until", "wait_until(seconds)", "Goes on when world.time() is there.", guarded<wait_until>},
    {"", "tween", "tween(component, field, value, seconds, easing)",
     "Moves a number, vector, colour or rotation from what it is to `value`, and goes on when it is there. Easing: "
     "\"linear\", \"smooth\", \"in\" or \"out\". A later tween of the same field takes it over.",
     guarded<tween>},
    {"", "on", "on(event, function(...) ... end) -> handler",
     "Calls the function, as a story of its own, whenever the event is emitted. The sandbox emits \"key:1\" and its "
     "like.",
     guarded<on_event>},
    {"", "emit", "emit(event, ...) -> number",
     "Tells everyone who listens, with these values; gives how many they are.", guarded<emit_event>},
    {"", "wait_for", "wait_for(event) -> ...", "Goes on when the event is emitted, with the values it brings.",
     guarded<wait_for>},
    {"handler", "off", "handler:off()", "Stops listening.", guarded<handler_off>}};

}  // namespace

std::span<const Binding> timeline_bindings() {
  return bindings;
}

void open_handlers(lua_State* state) {
  open_object(state, handler_metatable);
  push_functions(state, "handler");
  lua_setfield(state, -2, "__index");
  lua_pop(state, 1);
}

}  // namespace petrichor::script
