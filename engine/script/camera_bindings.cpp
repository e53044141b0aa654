// How a script is filmed: camera paths and what a cinematic declares.

#include <fmt/format.h>

#include <algorithm>
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

struct CameraPath {
  Spline position, target, field_of_view;
};

double get_number(lua_State* state, int table, const char* key, const std::string& place, bool& found) {
  lua_getfield(state, table, key);
  found = !lua_isnil(state, -1);
  if (found && lua_type(state, -1) != LUA_TNUMBER)
    raise(state, fmt::format("{}.{}: got {}, expected a number", place, key, describe(state, -1)));
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
  charge(state, static_cast<std::uint64_t>(count) * 200);
  double last_s = -1.0;
  for (lua_Integer i = 1; i <= count; ++i) {
    const std::string place = fmt::format("camera.path, key {}", i);
    lua_rawgeti(state, index, i);
    const int key = lua_gettop(state);
    if (!lua_istable(state, key))
      raise(state, fmt::format("{}: got {}, expected a table", place, describe(state, key)));
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
    if (time_s < 0.0 || time_s <= last_s || time_s > longest_s)
      raise(state, place + ": times start at 0 or later and rise from key to key");
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
  if (!path->target.points.empty() && path->position.points.empty())
    raise(state, "camera.path: keys with a target need a position too");

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
        written = write_target(host, *host.field_of_view.schema, t,
                               std::clamp(path->field_of_view.at(time_s).x, field.minimum, field.maximum));
      }
      if (!written) return written;
    }
    return {};
  };
  // The first picture of the path is there at once, and a bad value is told at this line.
  if (const auto applied = track.apply(timeline.now_s(), track.targets); !applied)
    raise(state, applied.error().message);
  if (track.end_s <= timeline.now_s()) return 0;
  return timeline.run_track(state, std::move(track));
}

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
        raise(state, fmt::format("cinematic: {}: got {}, expected a number from {:g} to {:g}", key, describe(state, 3),
                                 minimum, maximum));
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
        if (!(s >= 1.0 && s <= 16384.0) || s != std::floor(s))
          raise(state, "cinematic: size: expected {width, height}, whole pixels from 1 to 16384");
      }
      declared.size_px = glm::ivec2(static_cast<int>(size[0]), static_cast<int>(size[1]));
    } else if (key == "render") {
      if (lua_type(state, 3) != LUA_TSTRING)
        raise(state, fmt::format("cinematic: render: got {}, expected the path of a script", describe(state, 3)));
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
    {"camera", "path", "camera.path{ {time_s=0, position={...}, target={...}, fov=50}, ..., camera=entity }",
     "Moves the camera (the first active one, unless given) smoothly through the keys, whose times count from now, and "
     "goes on when it is through. `target` and `fov` may be left out.",
     guarded<camera_path>},
    {"", "cinematic", "cinematic{duration_s=10, fps=24, size={640, 360}, render=\"scripts/render/city.lua\"}",
     "Declares how the script wants to be filmed; the command line overrides it.", guarded<cinematic>}};

}  // namespace

std::span<const Binding> camera_bindings() {
  return bindings;
}

}  // namespace petrichor::script
