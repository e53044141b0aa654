// What scripts can say about time: coroutines, tweens, events, camera paths.

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
namespace {

using nlohmann::json;

constexpr const char* handler_metatable = "petrichor.handler";
constexpr double longest_s = 1e7;  // four months; a time beyond it is a mistake

Timeline& timeline_of(lua_State* state) { return host_of(state).timeline; }

// The timeline, for a function that waits; raises where nothing can wait.
Timeline& check_can_wait(lua_State* state, const char* function) {
  Timeline& timeline = timeline_of(state);
  if (!timeline.is_current(state)) {
    raise(state, fmt::format("{} must be called from the script itself or from timeline(), go() or on(), not from a coroutine of your own", function));
  }
  if (!lua_isyieldable(state)) {
    raise(state, fmt::format("{} cannot be called inside a function that the library calls (each, sort, gsub, require)", function));
  }
  return timeline;
}

double check_seconds(lua_State* state, int index, const char* function) {
  const double seconds = luaL_checknumber(state, index);
  if (!(seconds >= 0.0) || seconds > longest_s) raise(state, fmt::format("{}: got {} s, expected 0 to {:g} s", function, seconds, longest_s));
  return seconds;
}

std::string check_event(lua_State* state, int index) {
  std::size_t length = 0;
  const char* text = luaL_checklstring(state, index, &length);
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

bool is_tweened(FieldType type) { return type != FieldType::boolean && type != FieldType::text && type != FieldType::choice; }

Result<void> write_target(ScriptHost::Impl& host, const Schema& schema, const Target& target, const json& value) {
  if (!host.registry.alive(target.entity)) return failure(fmt::format("the entity whose {}.{} moves was destroyed", schema.name, target.field->name));
  void* component = schema.find(host.registry, target.entity);
  if (!component) return failure(fmt::format("the {} whose {} moves was removed", schema.name, target.field->name));
  return set_field(host, schema, *target.field, component, value);
}

std::array<double, 4> numbers_of(const json& value) {
  std::array<double, 4> out{};
  if (value.is_number()) out[0] = value.get<double>();
  else for (std::size_t i = 0; i < std::min<std::size_t>(value.size(), 4); ++i) out[i] = value[i].get<double>();
  return out;
}

// Between two values of a field; exactly `to` at progress 1.
json blend(const Field& field, const json& from, const json& to, double progress) {
  if (progress >= 1.0) return to;
  const auto a = numbers_of(from);
  const auto b = numbers_of(to);
  if (field.type == FieldType::rotation) {
    const glm::dquat q = glm::slerp(glm::dquat(a[3], a[0], a[1], a[2]), glm::normalize(glm::dquat(b[3], b[0], b[1], b[2])), progress);
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
  if (!box.schema) raise(state, fmt::format("tween: got {}, expected a component such as rain.emitter", describe(state, 1)));
  std::size_t length = 0;
  const char* name = luaL_checklstring(state, 2, &length);
  const Schema& schema = *box.schema;
  const Field* field = find_field(schema, std::string_view(name, length));
  if (!field) {
    std::vector<std::string_view> known;
    for (const Field& f : schema.fields) known.push_back(f.name);
    raise(state, fmt::format("tween: {} has no field \"{}\"{}", schema.name, name, name_hint(name, known)));
  }
  if (!is_tweened(field->type)) raise(state, fmt::format("tween: {}.{} has no values in between; set it instead", schema.name, field->name));
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
  if (const auto restored = write_field(schema, *field, component, from); !restored) raise(state, restored.error().message);

  const double start_s = timeline.now_s();
  if (duration_s == 0.0) {
    if (const auto set = set_field(host, schema, *field, component, to); !set) raise(state, set.error().message);
    return 0;
  }
  Track track;
  track.end_s = start_s + duration_s;
  track.targets = {Target{box.entity, field}};
  track.apply = [&host, &schema, field, from, to, start_s, end_s = track.end_s, duration_s, curve = *easing](double time_s, const std::vector<Target>& targets) -> Result<void> {
    if (targets.empty()) return {};  // another tween has taken the field over
    const double progress = time_s >= end_s ? 1.0 : (time_s - start_s) / duration_s;
    return write_target(host, schema, targets[0], blend(*field, from, to, ease(curve, progress)));
  };
  return timeline.run_track(state, std::move(track));
}

// ---- camera.path ------------------------------------------------------------------------------------------

struct CameraPath {
  Spline position, target, field_of_view;
};

double get_number(lua_State* state, int table, const char* key, const std::string& place, bool& found) {
  lua_getfield(state, table, key);
  found = !lua_isnil(state, -1);
  if (found && lua_type(state, -1) != LUA_TNUMBER) raise(state, fmt::format("{}.{}: got {}, expected a number", place, key, describe(state, -1)));
  const double number = lua_tonumber(state, -1);
  lua_pop(state, 1);
  if (found && !std::isfinite(number)) raise(state, fmt::format("{}.{}: {} is no finite number", place, key, number));
  return number;
}

void get_point(lua_State* state, int table, const char* key, const std::string& place, double time_s, Spline& spline) {
  lua_getfield(state, table, key);
  if (!lua_isnil(state, -1)) {
    std::array<double, 3> p{};
    check_vector(state, -1, p, place + "." + key);
    if (!std::isfinite(p[0] + p[1] + p[2])) raise(state, fmt::format("{}.{}: not finite", place, key));
    spline.times_s.push_back(time_s);
    spline.points.emplace_back(p[0], p[1], p[2]);
  }
  lua_pop(state, 1);
}

CameraPath check_path(lua_State* state, int index, double start_s) {
  CameraPath path;
  const auto count = static_cast<lua_Integer>(lua_rawlen(state, index));
  if (count < 1) raise(state, "camera.path: give keys, {time_s=0, position={...}, target={...}}");
  charge(state, static_cast<std::uint64_t>(count) * 20);
  double last_s = -1.0;
  for (lua_Integer i = 1; i <= count; ++i) {
    const std::string place = fmt::format("camera.path, key {}", i);
    lua_rawgeti(state, index, i);
    const int key = lua_gettop(state);
    if (!lua_istable(state, key)) raise(state, fmt::format("{}: got {}, expected a table", place, describe(state, key)));
    static constexpr std::array<std::string_view, 4> known{"time_s", "position", "target", "fov"};
    lua_pushnil(state);
    while (lua_next(state, key)) {
      lua_pop(state, 1);
      const std::string_view name = lua_type(state, -1) == LUA_TSTRING ? lua_tostring(state, -1) : "";
      if (std::find(known.begin(), known.end(), name) == known.end()) {
        raise(state, fmt::format("{}: {} is not known{}", place, describe(state, -1), name_hint(name, known)));
      }
    }
    bool found = false;
    const double time_s = get_number(state, key, "time_s", place, found);
    if (!found) raise(state, place + ": time_s is missing");
    if (time_s < 0.0 || time_s <= last_s || time_s > longest_s) raise(state, place + ": times start at 0 or later and rise from key to key");
    last_s = time_s;
    get_point(state, key, "position", place, start_s + time_s, path.position);
    get_point(state, key, "target", place, start_s + time_s, path.target);
    const double fov = get_number(state, key, "fov", place, found);
    if (found) {
      path.field_of_view.times_s.push_back(start_s + time_s);
      path.field_of_view.points.emplace_back(fov, 0.0, 0.0);
    }
    lua_pop(state, 1);
  }
  return path;
}

int camera_path(lua_State* state) {
  auto& host = host_of(state);
  luaL_checktype(state, 1, LUA_TTABLE);
  lua_settop(state, 1);
  for (const FieldPlace& place : {host.position, host.orientation, host.field_of_view}) {
    if (!place.schema) raise(state, "camera.path: there are no cameras here");
  }
  lua_getfield(state, 1, "camera");
  Entity camera = null_entity;
  if (!lua_isnil(state, -1)) {
    camera = check_entity(state, -1);
  } else {
    const auto cameras = host.field_of_view.schema->entities(host.registry);
    if (cameras.empty()) raise(state, "camera.path: there is no camera; world.spawn{camera={}} makes one");
    const auto is_active = [&](Entity e) {
      const void* component = host.camera_active.schema ? host.camera_active.schema->find(host.registry, e) : nullptr;
      return component && read_field(*host.camera_active.field, component) == json(true);
    };
    const auto active = std::find_if(cameras.begin(), cameras.end(), is_active);
    camera = active == cameras.end() ? cameras.front() : *active;
  }
  lua_pop(state, 1);
  Timeline& timeline = check_can_wait(state, "camera.path");
  auto path = std::make_shared<CameraPath>(check_path(state, 1, timeline.now_s()));
  if (!path->target.points.empty() && path->position.points.empty()) raise(state, "camera.path: keys with a target need a position too");

  Track track;
  const auto use = [&](const Spline& spline, const FieldPlace& place) {
    if (spline.points.empty()) return;
    track.end_s = std::max(track.end_s, spline.times_s.back());
    track.targets.push_back(Target{camera, place.field});
    add_component(host, *place.schema, camera);
  };
  use(path->position, host.position);
  use(path->target, host.orientation);
  use(path->field_of_view, host.field_of_view);
  if (track.targets.empty()) raise(state, "camera.path: the keys hold neither position nor fov");

  track.apply = [&host, path](double time_s, const std::vector<Target>& targets) -> Result<void> {
    for (const Target& t : targets) {
      Result<void> written;
      if (t.field == host.position.field) {
        const glm::dvec3 p = path->position.at(time_s);
        written = write_target(host, *host.position.schema, t, json::array({p.x, p.y, p.z}));
      } else if (t.field == host.orientation.field) {
        const glm::dvec3 direction = path->target.at(time_s) - path->position.at(time_s);
        if (glm::length(direction) < 1e-9) continue;  // standing on the target: keep looking as before
        const glm::dquat q = look_along(direction);
        written = write_target(host, *host.orientation.schema, t, json::array({q.x, q.y, q.z, q.w}));
      } else {
        const Field& field = *host.field_of_view.field;
        written = write_target(host, *host.field_of_view.schema, t, std::clamp(path->field_of_view.at(time_s).x, field.minimum, field.maximum));
      }
      if (!written) return written;
    }
    return {};
  };
  // The first picture of the path is there at once, and a bad value is told at this line.
  if (const auto applied = track.apply(timeline.now_s(), track.targets); !applied) raise(state, applied.error().message);
  if (track.end_s <= timeline.now_s()) return 0;
  return timeline.run_track(state, std::move(track));
}

// ---- cinematic --------------------------------------------------------------------------------------------

int cinematic(lua_State* state) {
  luaL_checktype(state, 1, LUA_TTABLE);
  lua_settop(state, 1);
  Cinematic declared;
  static constexpr std::array<std::string_view, 4> known{"duration_s", "fps", "size", "render"};
  lua_pushnil(state);
  while (lua_next(state, 1)) {
    const std::string_view key = lua_type(state, 2) == LUA_TSTRING ? lua_tostring(state, 2) : "";
    const auto number = [&](double minimum, double maximum) {
      const double value = lua_type(state, 3) == LUA_TNUMBER ? lua_tonumber(state, 3) : std::nan("");
      if (!(value >= minimum && value <= maximum)) {
        raise(state, fmt::format("cinematic: {}: got {}, expected a number from {:g} to {:g}", key, describe(state, 3), minimum, maximum));
      }
      return value;
    };
    if (key == "duration_s") {
      declared.duration_s = number(0.001, 86400.0);
    } else if (key == "fps") {
      declared.fps = number(0.01, 1000.0);
    } else if (key == "size") {
      std::array<double, 2> size{};
      check_vector(state, 3, size, "cinematic: size");
      for (const double s : size) {
        if (!(s >= 1.0 && s <= 16384.0) || s != std::floor(s)) raise(state, "cinematic: size: expected {width, height}, whole pixels from 1 to 16384");
      }
      declared.size_px = glm::ivec2(static_cast<int>(size[0]), static_cast<int>(size[1]));
    } else if (key == "render") {
      if (lua_type(state, 3) != LUA_TSTRING) raise(state, fmt::format("cinematic: render: got {}, expected the path of a script", describe(state, 3)));
      declared.render = lua_tostring(state, 3);
    } else {
      raise(state, fmt::format("cinematic: {} is not known{}", describe(state, 2), name_hint(key, known)));
    }
    lua_pop(state, 1);
  }
  host_of(state).cinematic = std::move(declared);
  return 0;
}

constexpr Binding bindings[] = {
    {"", "timeline", "timeline(function() ... end)", "Starts a story: the function runs beside everything else and may wait. The script itself is one too.", guarded<start_task>},
    {"", "go", "go(function(...) ... end, ...)", "The same, from inside a story: what follows does not wait for it.", guarded<start_task>},
    {"", "wait", "wait(seconds)", "Goes on so much later. `wait()` goes on in the next step of the simulation.", guarded<wait>},
    {"", "wait_until", "wait_until(seconds)", "Goes on when world.time() is there.", guarded<wait_until>},
    {"", "tween", "tween(component, field, value, seconds, easing)", "Moves a number, vector, colour or rotation from what it is to `value`, and goes on when it is there. Easing: \"linear\", \"smooth\", \"in\" or \"out\". A later tween of the same field takes it over.", guarded<tween>},
    {"", "on", "on(event, function(...) ... end) -> handler", "Calls the function, as a story of its own, whenever the event is emitted. The sandbox emits \"key:1\" and its like.", guarded<on_event>},
    {"", "emit", "emit(event, ...) -> number", "Tells everyone who listens, with these values; gives how many they are.", guarded<emit_event>},
    {"", "wait_for", "wait_for(event) -> ...", "Goes on when the event is emitted, with the values it brings.", guarded<wait_for>},
    {"handler", "off", "handler:off()", "Stops listening.", guarded<handler_off>},
    {"camera", "path", "camera.path{ {time_s=0, position={...}, target={...}, fov=50}, ..., camera=entity }", "Moves the camera (the first active one, unless given) smoothly through the keys, whose times count from now, and goes on when it is through. `target` and `fov` may be left out.", guarded<camera_path>},
    {"", "cinematic", "cinematic{duration_s=10, fps=24, size={640, 360}, render=\"scripts/render/city.lua\"}", "Declares how the script wants to be filmed; the command line overrides it.", guarded<cinematic>},
};

}  // namespace

std::span<const Binding> timeline_bindings() { return bindings; }

}  // namespace petrichor::script
