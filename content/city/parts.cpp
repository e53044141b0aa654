#include "content/city/parts.hpp"

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>
#include <utility>

namespace petrichor::city {

int add_node(Scene& scene, const std::string& name, int parent, int mesh, const glm::mat4& frame) {
  Node node;
  node.name = name;
  node.parent = parent;
  node.mesh = mesh;
  node.translation_m = glm::vec3(frame[3]);
  node.rotation = glm::normalize(glm::quat_cast(glm::mat3(frame)));
  return scene.add(std::move(node));
}

int add_mesh_node(Scene& scene, int parent, Mesh mesh, const glm::mat4& frame) {
  const std::string name = mesh.name;
  return add_node(scene, name, parent, scene.add_mesh(std::move(mesh)), frame);
}

int add_light(Scene& scene, const std::string& name, int parent, glm::vec3 position, const Lamp& lamp,
              glm::vec3 direction) {
  Light light;
  light.name = name;
  light.spot = lamp.outer_deg > 0.0f;
  light.colour = lamp.colour;
  light.intensity_cd = lamp.intensity_cd;
  light.range_m = lamp.range_m;
  light.inner_cone_rad = glm::radians(lamp.inner_deg);
  light.outer_cone_rad = glm::radians(lamp.outer_deg);
  scene.lights.push_back(light);
  Node node;
  node.name = name;
  node.parent = parent;
  node.translation_m = position;
  node.light = static_cast<int>(scene.lights.size()) - 1;
  if (light.spot) {
    const glm::vec3 z = -glm::normalize(direction);
    const glm::vec3 x = glm::normalize(glm::cross(std::abs(z.y) < 0.99f ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1), z));
    node.rotation = glm::normalize(glm::quat_cast(glm::mat3(x, glm::cross(z, x), z)));
  }
  nlohmann::json extras;
  extras["light"] = {{"casts_shadow", lamp.casts_shadow}, {"source_radius_m", lamp.source_radius_m}};
  node.extras_json = extras.dump();
  return scene.add(std::move(node));
}

namespace {

int add_mark(Scene& scene, const std::string& schema, int parent, const glm::mat4& frame,
             const nlohmann::json& fields) {
  int count = 0;
  for (const Node& n : scene.nodes) count += n.name.starts_with(schema) ? 1 : 0;
  const int node = add_node(scene, schema + "_" + std::to_string(count), parent, -1, frame);
  nlohmann::json extras;
  extras[schema] = fields;
  scene.nodes[static_cast<std::size_t>(node)].extras_json = extras.dump();
  return node;
}

}  // namespace

void mark_drip(Scene& scene, int parent, const glm::mat4& frame, float length_m, float catchment_m, float lip_mm,
               DripMark mark) {
  nlohmann::json values = {{"length_m", length_m}, {"catchment_depth_m", catchment_m}, {"lip_radius_mm", lip_mm}};
  if (mark.edge_share != 1.0f) values["edge_share"] = mark.edge_share;
  if (mark.sites > 0) {
    values["site_spacing_mm"] = 1000.0f * length_m / static_cast<float>(mark.sites);
    values["site_scatter"] = 0.0f;
  }
  add_mark(scene, "drip_source", parent, frame, values);
}

void mark_pane(Scene& scene, int parent, const glm::mat4& frame, glm::vec2 size_m) {
  add_mark(scene, "glass_pane", parent, frame, {{"size_m", {size_m.x, size_m.y}}});
}

void mark_probe(Scene& scene, int node, glm::vec3 centre_m, float radius_m) {
  const std::string& marked = scene.nodes[static_cast<std::size_t>(node)].extras_json;
  nlohmann::json extras = marked.empty() ? nlohmann::json::object() : nlohmann::json::parse(marked);
  extras["reflection_probe"] = {{"centre_m", {centre_m.x, centre_m.y, centre_m.z}}, {"radius_m", radius_m}};
  scene.nodes[static_cast<std::size_t>(node)].extras_json = extras.dump();
}

void mark_wader(Scene& scene, int node, float radius_m, float draft_mm) {
  nlohmann::json extras;
  extras["wader"] = {{"radius_m", radius_m}, {"draft_mm", draft_mm}};
  scene.nodes[static_cast<std::size_t>(node)].extras_json = extras.dump();
}

Scene make_city() {
  Scene scene;
  const StandingWater water = flood_streets();
  add_ground(scene, water);
  add_buildings(scene);
  add_toy_shop(scene);
  add_furniture(scene);
  add_vehicles(scene);
  add_marks(scene);
  mark_rain_catchers(scene);
  return scene;
}

}  // namespace petrichor::city
