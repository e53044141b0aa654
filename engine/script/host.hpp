#pragma once
// Inside engine/script: what the bindings see of a ScriptHost.

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "engine/script/sandbox.hpp"
#include "engine/script/script.hpp"
#include "engine/script/timeline.hpp"

namespace petrichor::script {

struct Pin;

}  // namespace petrichor::script

namespace petrichor {

struct FieldPlace {
  const Schema* schema = nullptr;
  const Field* field = nullptr;
};

struct ScriptHost::Impl {
  Impl(Registry&, std::span<const Schema>, ScriptOptions);
  ~Impl();

  Registry& registry;
  std::span<const Schema> schemas;
  ScriptOptions options;
  script::Sandbox sandbox;
  script::Timeline timeline;
  Cinematic cinematic;
  FieldPlace name, position, orientation, field_of_view, camera_active;
  std::vector<script::Pin> pins;
  std::size_t models_loaded = 0;
  Result<void> opened;  // whether the bindings could be set up within the memory cap
};

namespace script {

ScriptHost::Impl& host_of(lua_State*);

// All writes of scripts go through here: a pinned field takes its pin instead. The component must exist.
Result<void> set_field(ScriptHost::Impl&, const Schema&, const Field&, void* component, const nlohmann::json& value);
// Brings the pinned fields of an entity that scripts did not make to their pins.
void apply_pins(ScriptHost::Impl&, Entity);
// Adds the component, or finds it, with pinned fields in place.
void* add_component(ScriptHost::Impl&, const Schema&, Entity);

}  // namespace script
}  // namespace petrichor
