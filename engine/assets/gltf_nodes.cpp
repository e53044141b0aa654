// The scene of a glTF: its node tree in preorder, and the lights, cameras and meshes that nodes carry. No
// recursion: a chain of a hundred thousand nodes is a valid file.

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "engine/assets/gltf_document.hpp"

namespace petrichor {
namespace {

using nlohmann::json;

constexpr double largest_transform = 1e15;
constexpr float largest_light = 1e15f;  // candela or lux; the sun seen from Earth is 1e5 lux

// The parent of each glTF node. Nodes form strict trees (section 3.5.2): one parent each, no cycles.
std::vector<std::int32_t> find_parents(const tinygltf::Model& gltf) {
  std::vector<std::int32_t> parents(gltf.nodes.size(), no_index);
  for (std::size_t i = 0; i < gltf.nodes.size(); ++i) {
    for (std::size_t k = 0; k < gltf.nodes[i].children.size(); ++k) {
      const auto child = static_cast<std::size_t>(gltf.nodes[i].children[k]);
      const std::string path = fmt::format("/nodes/{}/children/{}", i, k);
      if (child == i) gltf_fail(path, fmt::format("node {} is its own child", i));
      if (parents[child] != no_index) {
        gltf_fail(path,
                  fmt::format("node {} is a child of node {} already; one parent is allowed", child, parents[child]));
      }
      parents[child] = static_cast<std::int32_t>(i);
    }
  }
  // With one parent each, what cannot be reached from a parentless node lies on or under a cycle.
  std::vector<std::size_t> stack;
  std::vector<bool> reached(gltf.nodes.size(), false);
  for (std::size_t i = 0; i < gltf.nodes.size(); ++i) {
    if (parents[i] == no_index) stack.push_back(i);
  }
  while (!stack.empty()) {
    const std::size_t node = stack.back();
    stack.pop_back();
    reached[node] = true;
    for (int child : gltf.nodes[node].children) stack.push_back(static_cast<std::size_t>(child));
  }
  for (std::size_t i = 0; i < reached.size(); ++i) {
    if (!reached[i])
      gltf_fail(fmt::format("/nodes/{}/children", i), "the node is among its own descendants or under such a cycle");
  }
  return parents;
}

std::vector<int> scene_roots(Document& document, const std::vector<std::int32_t>& parents) {
  const tinygltf::Model& gltf = *document.gltf;
  std::vector<int> roots;
  if (gltf.scenes.empty()) {
    for (std::size_t i = 0; i < parents.size(); ++i) {
      if (parents[i] == no_index) roots.push_back(static_cast<int>(i));
    }
    return roots;
  }
  const std::size_t scene = gltf.defaultScene >= 0 ? static_cast<std::size_t>(gltf.defaultScene) : 0;
  if (gltf.scenes.size() > 1)
    document.warn(fmt::format("/scenes/{}", scene), fmt::format("one of {} scenes is loaded", gltf.scenes.size()));
  std::vector<bool> seen(parents.size(), false);
  const auto& nodes = gltf.scenes[scene].nodes;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto node = static_cast<std::size_t>(nodes[i]);
    const std::string path = fmt::format("/scenes/{}/nodes/{}", scene, i);
    if (parents[node] != no_index)
      gltf_fail(path, fmt::format("node {} is a child of node {}, scenes list root nodes", node, parents[node]));
    if (seen[node]) gltf_fail(path, fmt::format("node {} is listed twice", node));
    seen[node] = true;
    roots.push_back(nodes[i]);
  }
  return roots;
}

glm::dvec3 any_perpendicular(glm::dvec3 n) {
  const glm::dvec3 axis = std::abs(n.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
  return glm::normalize(axis - n * glm::dot(n, axis));
}

// A matrix of a node decomposes to translation, rotation and scale (section 3.5.3); shear is not allowed and
// is dropped with a warning. Columns of no length keep a scale of zero.
void set_matrix(Document& document, Node& node, const std::vector<double>& m) {
  node.translation_m = glm::vec3(m[12], m[13], m[14]);
  glm::dvec3 columns[3], axes[3];
  glm::dvec3 scale(0.0);
  for (int c = 0; c < 3; ++c) {
    const auto k = static_cast<std::size_t>(4 * c);
    columns[c] = {m[k], m[k + 1], m[k + 2]};
    scale[c] = glm::length(columns[c]);
  }
  if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0) {
    document.warn(node.json_path + "/matrix", "the fourth row is not 0 0 0 1 and is taken as such");
  }
  // Gram and Schmidt, longest column first, so that flat and mirrored boxes find their axes.
  int order[3] = {0, 1, 2};
  std::sort(order, order + 3, [&](int a, int b) { return scale[a] > scale[b]; });
  const auto remainder = [&](int c, std::initializer_list<int> others) {
    glm::dvec3 v = scale[c] > 0.0 ? columns[c] / scale[c] : glm::dvec3(0.0);
    for (int o : others) v -= axes[o] * glm::dot(axes[o], v);
    return v;
  };
  const glm::dvec3 first = remainder(order[0], {});
  axes[order[0]] = glm::length(first) > 0.5 ? first : glm::dvec3(order[0] == 0, order[0] == 1, order[0] == 2);
  const glm::dvec3 second = remainder(order[1], {order[0]});
  axes[order[1]] = glm::length(second) > 1e-6 ? glm::normalize(second) : any_perpendicular(axes[order[0]]);
  const glm::dvec3 third = remainder(order[2], {order[0], order[1]});
  // The third axis makes the frame right-handed; a mirrored column shows as a negative scale.
  glm::dvec3 completed = glm::cross(axes[(order[2] + 1) % 3], axes[(order[2] + 2) % 3]);
  axes[order[2]] = completed;
  if (glm::dot(completed, third) < 0.0) scale[order[2]] = -scale[order[2]];
  double shear = 0.0;
  for (int c = 0; c < 3; ++c) shear = std::max(shear, glm::length(columns[c] - axes[c] * scale[c]));
  if (shear > 1e-3 * std::max({std::abs(scale.x), std::abs(scale.y), std::abs(scale.z)})) {
    document.warn(node.json_path + "/matrix", "the matrix shears, which glTF does not allow; the shear is dropped");
  }
  node.scale = scale;
  node.rotation = glm::normalize(glm::quat(glm::quat_cast(glm::dmat3(axes[0], axes[1], axes[2]))));
}

void set_transform(Document& document, Node& node, const tinygltf::Node& source) {
  if (source.matrix.size() == 16) {
    set_matrix(document, node, source.matrix);
    return;
  }
  if (source.translation.size() == 3)
    node.translation_m = {source.translation[0], source.translation[1], source.translation[2]};
  if (source.scale.size() == 3) node.scale = {source.scale[0], source.scale[1], source.scale[2]};
  if (source.rotation.size() == 4) {
    const glm::dquat q(source.rotation[3], source.rotation[0], source.rotation[1], source.rotation[2]);
    const double length = glm::length(q);
    if (!(length > 1e-6 && length < 1e30)) gltf_fail(node.json_path + "/rotation", "a unit quaternion is needed");
    if (std::abs(length - 1.0) > 0.01)
      document.warn(node.json_path + "/rotation",
                    fmt::format("a quaternion of length {:g} is taken as a unit one", length));
    node.rotation = glm::quat(q / length);
  }
}

// Products of finite transforms can overflow: a Model promises finite numbers down the whole tree.
void check_world(const Node& node, const std::vector<Node>& nodes, std::vector<glm::dmat4>& worlds) {
  glm::dmat4 local(glm::dmat3(glm::mat3_cast(glm::dquat(node.rotation))) *
                   glm::dmat3(node.scale.x, 0, 0, 0, node.scale.y, 0, 0, 0, node.scale.z));
  local[3] = glm::dvec4(glm::dvec3(node.translation_m), 1.0);
  worlds.push_back(node.parent == no_index ? local : worlds[static_cast<std::size_t>(node.parent)] * local);
  for (int c = 0; c < 4; ++c) {
    for (int r = 0; r < 4; ++r) {
      if (std::abs(worlds.back()[c][r]) <= largest_transform) continue;
      gltf_fail(node.json_path,
                fmt::format("its place in the world is {:g}, at most {:g} is read (node {} of the scene)",
                            worlds.back()[c][r], largest_transform, nodes.size()));
    }
  }
}

void convert_lights(Document& document, Model& model) {
  const json::json_pointer pointer("/extensions/KHR_lights_punctual/lights");
  if (!document.json->contains(pointer)) return;
  const json& lights = document.json->at(pointer);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const std::string path = fmt::format("/extensions/KHR_lights_punctual/lights/{}", i);
    const json& source = lights[i];
    ModelLight light;
    light.name = source.value("name", std::string());
    const std::string type = source["type"];
    if (type == "directional")
      light.kind = ModelLightKind::directional;
    else if (type == "spot")
      light.kind = ModelLightKind::spot;
    else if (type != "point")
      gltf_fail(path + "/type", fmt::format("\"{}\", one of point, spot, directional is needed", type.substr(0, 40)));
    if (source.contains("color")) {
      for (int c = 0; c < 3; ++c) light.colour[c] = source["color"][static_cast<std::size_t>(c)];
    }
    light.intensity = source.value("intensity", 1.0f);
    light.range_m = source.value("range", 0.0f);
    if (!(light.intensity * std::max({1.0f, light.colour.x, light.colour.y, light.colour.z}) <= largest_light)) {
      gltf_fail(path,
                fmt::format("an intensity of {:g} is asked for, at most {:g} is read", light.intensity, largest_light));
    }
    if (source.contains("spot")) {
      light.inner_cone_rad = source["spot"].value("innerConeAngle", light.inner_cone_rad);
      light.outer_cone_rad = source["spot"].value("outerConeAngle", light.outer_cone_rad);
    }
    if (light.kind == ModelLightKind::spot && light.inner_cone_rad >= light.outer_cone_rad) {
      document.warn(path + "/spot", "innerConeAngle is not less than outerConeAngle and is made so");
      light.outer_cone_rad = std::max(light.outer_cone_rad, 0.001f);
      light.inner_cone_rad = std::min(light.inner_cone_rad, light.outer_cone_rad * 0.999f);
    }
    model.lights.push_back(std::move(light));
  }
}

void convert_cameras(Document& document, Model& model) {
  if (!document.json->contains("cameras")) return;
  const json& cameras = (*document.json)["cameras"];
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const std::string path = fmt::format("/cameras/{}", i);
    ModelCamera camera;
    camera.name = cameras[i].value("name", std::string());
    const std::string type = cameras[i]["type"];
    if (type == "perspective") {
      if (!cameras[i].contains("perspective")) gltf_fail(path, "\"perspective\" is missing");
      camera.vertical_fov_rad = std::clamp(cameras[i]["perspective"]["yfov"].get<float>(), 0.01f, 3.0f);
      camera.near_m = cameras[i]["perspective"]["znear"].get<float>();
    } else if (type == "orthographic") {
      document.warn(path, "an orthographic camera becomes a perspective one");
    } else {
      gltf_fail(path + "/type", fmt::format("\"{}\", perspective or orthographic is needed", type.substr(0, 40)));
    }
    model.cameras.push_back(std::move(camera));
  }
}

// One Model mesh per glTF mesh, and one more for each other skin or set of morph weights a node asks for.
class MeshTable {
 public:
  MeshTable(Document& document, Model& model) : document_(document), model_(model) {}

  std::int32_t find(int mesh, const std::vector<double>& node_weights, const SkinPose* pose = nullptr) {
    const auto& defaults = document_.gltf->meshes[static_cast<std::size_t>(mesh)].weights;
    const auto& weights = node_weights.empty() ? defaults : node_weights;
    const auto [entry, added] = known_.emplace(std::tuple(mesh, pose ? pose->skin : no_index, weights),
                                               static_cast<std::int32_t>(model_.meshes.size()));
    if (added) model_.meshes.push_back(convert_mesh(document_, model_, mesh, weights, pose));
    return entry->second;
  }

 private:
  Document& document_;
  Model& model_;
  std::map<std::tuple<int, int, std::vector<double>>, std::int32_t> known_;
};

void warn_of_motion(Document& document) {
  const json& root = *document.json;
  for (const char* name : {"animations", "skins"}) {
    if (!root.contains(name)) continue;
    for (std::size_t i = 0; i < root[name].size(); ++i) {
      const std::string what = root[name][i].value("name", std::string()).substr(0, 60);
      document.warn(fmt::format("/{}/{}", name, i),
                    fmt::format("\"{}\" does not move: models stand in their first pose", what));
    }
  }
}

}  // namespace

void convert_nodes(Document& document, Model& model) {
  convert_lights(document, model);
  convert_cameras(document, model);
  warn_of_motion(document);
  const tinygltf::Model& gltf = *document.gltf;
  const auto parents = find_parents(gltf);
  auto pending = scene_roots(document, parents);
  std::reverse(pending.begin(), pending.end());
  std::vector<std::int32_t> new_index(gltf.nodes.size(), no_index);
  std::vector<glm::dmat4> worlds;
  MeshTable meshes(document, model);
  std::vector<std::size_t> skinned;
  while (!pending.empty()) {
    const auto index = static_cast<std::size_t>(pending.back());
    pending.pop_back();
    const tinygltf::Node& source = gltf.nodes[index];
    const json& raw = (*document.json)["nodes"][index];
    Node node;
    node.name = source.name;
    node.json_path = fmt::format("/nodes/{}", index);
    node.parent = parents[index] == no_index ? no_index : new_index[static_cast<std::size_t>(parents[index])];
    set_transform(document, node, source);
    check_world(node, model.nodes, worlds);
    if (source.mesh >= 0 && source.skin >= 0)
      skinned.push_back(index);
    else if (source.mesh >= 0)
      node.mesh = meshes.find(source.mesh, source.weights);
    node.camera = source.camera;
    if (const json::json_pointer light("/extensions/KHR_lights_punctual/light"); raw.contains(light))
      node.light = raw.at(light).get<std::int32_t>();
    if (raw.contains("extras") && raw["extras"].is_object()) {
      node.extras_json = raw["extras"].dump(-1, ' ', false, json::error_handler_t::replace);
    }
    new_index[index] = static_cast<std::int32_t>(model.nodes.size());
    model.nodes.push_back(std::move(node));
    for (auto child = source.children.rbegin(); child != source.children.rend(); ++child) pending.push_back(*child);
  }
  if (model.nodes.empty()) document.warn("", "the scene has no nodes");

  // The place of a skinned mesh's own node does not matter (section 3.7.3.3): it hangs on a root of its own.
  const auto world_of_node = [&](std::size_t gltf_node) {
    const std::int32_t at = new_index[gltf_node];
    return at == no_index ? glm::dmat4(1.0) : worlds[static_cast<std::size_t>(at)];
  };
  std::map<int, SkinPose> poses;
  for (std::size_t index : skinned) {
    const tinygltf::Node& source = gltf.nodes[index];
    auto pose = poses.find(source.skin);
    if (pose == poses.end())
      pose = poses.emplace(source.skin, pose_of_skin(document, source.skin, world_of_node)).first;
    Node node;
    node.name = source.name;
    node.json_path = fmt::format("/nodes/{}", index);
    node.mesh = meshes.find(source.mesh, source.weights, &pose->second);
    model.nodes.push_back(std::move(node));
  }
}

}  // namespace petrichor
