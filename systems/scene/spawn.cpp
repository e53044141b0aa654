#include "systems/scene/spawn.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace petrichor {
namespace {

using nlohmann::json;

Light light_of(const ModelLight& from) {
  Light light;
  switch (from.kind) {
    case ModelLightKind::point:
      light.kind = LightKind::point;
      break;
    case ModelLightKind::spot:
      light.kind = LightKind::spot;
      break;
    case ModelLightKind::directional:
      light.kind = LightKind::directional;
      break;
  }
  light.colour = from.colour;
  light.intensity_cd = from.intensity;
  light.range_m = from.range_m;
  light.inner_cone_deg = glm::degrees(from.inner_cone_rad);
  light.outer_cone_deg = glm::degrees(from.outer_cone_rad);
  light.casts_shadow = false;
  return light;
}

Camera camera_of(const ModelCamera& from) {
  Camera camera;
  camera.vertical_fov_deg = std::clamp(glm::degrees(from.vertical_fov_rad), 1.0f, 170.0f);
  camera.near_m = from.near_m;
  camera.active = false;
  return camera;
}

Result<void> apply(Registry& registry, Entity entity, const Schema& schema, const json& fields) {
  return write_fields(schema, schema.emplace(registry, entity), fields);
}

// Error messages start at "/extras/...".
Result<void> apply_extras(Registry& registry, Entity entity, const std::string& text) {
  const json extras = json::parse(text, nullptr, false);
  if (!extras.is_object()) return {};
  for (const auto& [key, value] : extras.items()) {
    const Schema* schema = find_schema(component_schemas(), key);
    if (schema == nullptr || !value.is_object()) continue;
    if (auto done = apply(registry, entity, *schema, value); !done) {
      return failure(fmt::format("/extras/{}: {}", key, done.error().message));
    }
  }
  const auto own = extras.find("petrichor");
  if (own == extras.end() || !own->is_object()) return {};
  for (const auto& [key, value] : own->items()) {
    const Schema* schema = find_schema(component_schemas(), key);
    if (schema == nullptr) {
      std::string known;
      for (const Schema& s : component_schemas()) known += (known.empty() ? "" : ", ") + std::string(s.name);
      return failure(fmt::format("/extras/petrichor/{}: no such component; there are {}", key.substr(0, 60), known));
    }
    if (auto done = apply(registry, entity, *schema, value); !done) {
      return failure(fmt::format("/extras/petrichor/{}: {}", key, done.error().message));
    }
  }
  return {};
}

}  // namespace

Result<std::vector<Entity>> spawn_model(Registry& registry, const Model& model, std::uint32_t model_index,
                                        Entity parent) {
  std::vector<Entity> entities;
  entities.reserve(model.nodes.size());
  for (const Node& node : model.nodes) {
    const Entity entity = registry.create();
    entities.push_back(entity);
    if (!node.name.empty()) registry.emplace<Name>(entity, Name{node.name});
    registry.emplace<Transform>(entity, Transform{node.translation_m, node.rotation, node.scale});
    const Entity above = node.parent == no_index ? parent : entities[static_cast<std::size_t>(node.parent)];
    if (above != null_entity) registry.emplace<Parent>(entity, Parent{above});
    if (node.mesh != no_index) {
      registry.emplace<MeshInstance>(entity, MeshInstance{model_index, static_cast<std::uint32_t>(node.mesh)});
    }
    if (node.light != no_index) {
      registry.emplace<Light>(entity, light_of(model.lights[static_cast<std::size_t>(node.light)]));
    }
    if (node.camera != no_index) {
      registry.emplace<Camera>(entity, camera_of(model.cameras[static_cast<std::size_t>(node.camera)]));
    }
    if (node.extras_json.empty()) continue;
    if (auto applied = apply_extras(registry, entity, node.extras_json); !applied) {
      for (Entity spawned : entities) registry.destroy(spawned);
      return failure(fmt::format("{}: {}{}", model.source, node.json_path, applied.error().message));
    }
  }
  return entities;
}

}  // namespace petrichor
