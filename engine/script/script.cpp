#include "engine/script/script.hpp"

#include <fmt/format.h>

#include <lua.hpp>
#include <nlohmann/json.hpp>

#include "engine/script/bindings.hpp"
#include "engine/script/host.hpp"
#include "engine/script/values.hpp"

namespace petrichor {

namespace script {

struct Pin {
  const Schema* schema;
  const Field* field;
  nlohmann::json value;
};

ScriptHost::Impl& host_of(lua_State* state) {
  return *static_cast<ScriptHost::Impl*>(sandbox_of(state).host);
}

Result<void> set_field(ScriptHost::Impl& host, const Schema& schema, const Field& field, void* component,
                       const nlohmann::json& value) {
  for (const Pin& pin : host.pins) {
    if (pin.field == &field) return write_field(schema, field, component, pin.value);
  }
  return write_field(schema, field, component, value);
}

void* add_component(ScriptHost::Impl& host, const Schema& schema, Entity entity) {
  if (void* found = schema.find(host.registry, entity)) return found;
  void* component = schema.emplace(host.registry, entity);
  apply_pins(host, entity);
  return component;
}

void apply_pins(ScriptHost::Impl& host, Entity entity) {
  for (const Pin& pin : host.pins) {
    void* component = pin.schema->find(host.registry, entity);
    if (component) (void)write_field(*pin.schema, *pin.field, component, pin.value);  // was checked by pin()
  }
}

namespace {

FieldPlace place_of(std::span<const Schema> schemas, std::string_view path) {
  const auto dot = path.find('.');
  const Schema* schema = find_schema(schemas, path.substr(0, dot));
  if (!schema || dot == std::string_view::npos) return {};
  const Field* field = find_field(*schema, path.substr(dot + 1));
  return field ? FieldPlace{schema, field} : FieldPlace{};
}

void set_arguments(lua_State* state, const ScriptOptions& options) {
  lua_newtable(state);
  for (const auto& [name, value] : options.arguments) {
    lua_pushlstring(state, value.data(), value.size());
    lua_setfield(state, -2, name.c_str());
  }
  lua_setglobal(state, "args");
}

}  // namespace
}  // namespace script

using script::Sandbox;

ScriptHost::Impl::Impl(Registry& r, std::span<const Schema> s, ScriptOptions o)
    : registry(r), schemas(s), options(std::move(o)), sandbox(options), timeline(sandbox) {
  sandbox.host = this;
  name = script::place_of(schemas, options.names.name);
  position = script::place_of(schemas, options.names.position);
  orientation = script::place_of(schemas, options.names.orientation);
  field_of_view = script::place_of(schemas, options.names.field_of_view);
  camera_active = script::place_of(schemas, options.names.camera_active);
  opened = sandbox.protect([&](lua_State* state) {
    script::open_bindings(state);
    script::set_arguments(state, options);
  });
}

ScriptHost::Impl::~Impl() = default;

ScriptHost::ScriptHost(Registry& registry, std::span<const Schema> schemas, ScriptOptions options)
    : impl_(std::make_unique<Impl>(registry, schemas, std::move(options))) {}
ScriptHost::~ScriptHost() = default;
ScriptHost::ScriptHost(ScriptHost&&) noexcept = default;
ScriptHost& ScriptHost::operator=(ScriptHost&&) noexcept = default;

Result<void> ScriptHost::run_file(const std::filesystem::path& file) {
  Impl& self = *impl_;
  if (!self.opened) return self.opened;
  self.sandbox.begin(self.options.limits.load_instructions);
  std::uint64_t task = 0;
  Result<void> loaded;
  const auto safe = self.sandbox.protect([&](lua_State* state) {
    loaded = self.sandbox.load(state, file);
    if (loaded) task = self.timeline.start(state, 0);
  });
  if (!safe) return failure(fmt::format("{}: {}", file.generic_string(), safe.error().message));
  if (!loaded) return loaded;
  return self.timeline.run_now(task);
}

Result<void> ScriptHost::advance(double time_s) {
  Impl& self = *impl_;
  if (!self.opened) return self.opened;
  self.sandbox.begin(self.options.limits.step_instructions);
  return self.timeline.advance(time_s);
}

void ScriptHost::emit(std::string_view event, const nlohmann::json& argument) {
  impl_->timeline.emit_later(std::string(event), argument);
}

void ScriptHost::emit(std::string_view event) {
  emit(event, nlohmann::json());
}

Result<void> ScriptHost::pin(std::string_view component, std::string_view field, const nlohmann::json& value) {
  Impl& self = *impl_;
  const Schema* schema = find_schema(self.schemas, component);
  if (!schema) return failure(fmt::format("no component is called \"{}\"", component));
  const Field* found = find_field(*schema, field);
  if (!found) return failure(fmt::format("{} has no field \"{}\"", component, field));
  {  // checked on a component of its own, so that a bad value changes nothing
    Registry scratch;
    if (const auto checked = write_field(*schema, *found, schema->emplace(scratch, scratch.create()), value); !checked)
      return checked;
  }
  std::erase_if(self.pins, [&](const script::Pin& p) { return p.field == found; });
  self.pins.push_back(script::Pin{schema, found, value});
  for (const Entity entity : schema->entities(self.registry)) {
    if (const auto set = write_field(*schema, *found, schema->find(self.registry, entity), value); !set) return set;
  }
  return {};
}

const Cinematic& ScriptHost::cinematic() const {
  return impl_->cinematic;
}
std::optional<double> ScriptHost::duration_s() const {
  return impl_->cinematic.duration_s;
}
bool ScriptHost::busy() const {
  return impl_->timeline.busy();
}
const std::vector<std::filesystem::path>& ScriptHost::files() const {
  return impl_->sandbox.files;
}

Result<nlohmann::json> read_table(const std::filesystem::path& file, const ScriptOptions& options,
                                  std::vector<std::filesystem::path>* files) {
  Sandbox sandbox(options);
  sandbox.begin(options.limits.load_instructions);
  Result<nlohmann::json> value = nlohmann::json();
  Result<void> loaded;
  lua_State* thread = nullptr;
  auto safe = sandbox.protect([&](lua_State* state) {
    script::open_vectors(state);
    script::set_arguments(state, options);
    loaded = sandbox.load(state, file);
    if (!loaded) return;
    thread = lua_newthread(state);
    lua_setfield(state, LUA_REGISTRYINDEX, "petrichor.table");
    lua_xmove(state, thread, 1);
  });
  if (files) files->insert(files->end(), sandbox.files.begin(), sandbox.files.end());
  if (!safe) return failure(fmt::format("{}: {}", file.generic_string(), safe.error().message));
  if (!loaded) return tl::unexpected(loaded.error());
  // A thread, and not a protected call, because its stack is still there for the traceback after a failure.
  int results = 0;
  const int status = lua_resume(thread, sandbox.state, 0, &results);
  if (files) *files = sandbox.files;
  if (status == LUA_YIELD)
    return failure(fmt::format("{}: a file that returns a table cannot yield", file.generic_string()));
  if (status != LUA_OK) return failure(sandbox.failure_text(thread, status));
  safe = sandbox.protect([&](lua_State* state) {
    if (results < 1 || !lua_istable(thread, -results)) {
      value = failure(
          fmt::format("returns {}, expected a table", results < 1 ? "nothing" : script::describe(thread, -results)));
      return;
    }
    lua_settop(thread, -results);
    lua_xmove(thread, state, 1);
    value = script::to_json(state, -1);
  });
  if (!safe) return failure(fmt::format("{}: {}", file.generic_string(), safe.error().message));
  if (!value) return failure(fmt::format("{}: {}", file.generic_string(), value.error().message));
  return value;
}

}  // namespace petrichor
