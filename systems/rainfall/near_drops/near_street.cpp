#include "systems/rainfall/near_drops/near_street.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "systems/gpu_scene.hpp"

namespace petrichor {

NearStreet make_near_street() {
  NearStreet street;
  const auto add = [&](glm::vec3 low, glm::vec3 high, glm::vec3 light) { street.boxes.push_back({low, high, light}); };
  add({-40, -0.5f, -60}, {40, 0, 40}, {0.12f, 0.11f, 0.10f});  // ground
  for (const float side : {-1.0f, 1.0f}) {
    const float wall = 4.0f * side;
    add({std::min(wall, wall + 6 * side), 0, -40}, {std::max(wall, wall + 6 * side), 9, 30}, {0.05f, 0.05f, 0.06f});
    for (int i = 0; i < 7; ++i) {
      const float z = -30.0f + 8.0f * static_cast<float>(i) + (side > 0 ? 2.5f : 0.0f), x = wall - 0.05f * side;
      const glm::vec3 light = i % 3 == 0 ? glm::vec3(1.5f, 3.0f, 6.0f) : glm::vec3(9.0f, 6.0f, 3.0f);
      add({std::min(x, wall), 1.0f, z}, {std::max(x, wall), 2.8f, z + 2.0f}, light);
    }
  }
  add({-4, 0, -41}, {4, 5, -40}, {6.0f, 2.0f, 1.0f});  // the shop across the end
  for (int i = 0; i < 3; ++i) {
    const float z = -22.0f + 12.0f * static_cast<float>(i);
    add({2.6f, 4.6f, z - 0.3f}, {3.2f, 5.0f, z + 0.3f}, {29.0f, 22.0f, 12.0f});
  }
  street.sky.zenith_cd_m2 = {0.02f, 0.025f, 0.04f};
  street.sky.horizon_cd_m2 = {0.25f, 0.18f, 0.12f};
  return street;
}

Model street_model(const NearStreet& street) {
  Model model;
  for (const StreetBox& box : street.boxes) {
    Material material;
    material.base_colour = glm::vec4(0, 0, 0, 1);
    material.metallic = 0.0f;
    material.emissive = box.light_cd_m2;
    Primitive p;
    p.material = static_cast<std::int32_t>(model.materials.size());
    model.materials.push_back(material);
    p.bounds_min_m = box.low_m;
    p.bounds_max_m = box.high_m;
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        const auto first = static_cast<std::uint32_t>(p.vertices.size());
        for (int corner = 0; corner < 4; ++corner) {
          Vertex vertex;
          vertex.position_m[axis] = side ? box.high_m[axis] : box.low_m[axis];
          vertex.position_m[u] = corner == 1 || corner == 2 ? box.high_m[u] : box.low_m[u];
          vertex.position_m[v] = corner >= 2 ? box.high_m[v] : box.low_m[v];
          vertex.normal = glm::vec3(0.0f);
          vertex.normal[axis] = side ? 1.0f : -1.0f;
          p.vertices.push_back(vertex);
        }
        // Counter-clockwise from outside: the lower side is turned round.
        for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u})
          p.indices.push_back(first + (side || i == 0u ? i : 4u - i));
      }
    Mesh mesh;
    mesh.primitives.push_back(std::move(p));
    Node node;
    node.mesh = static_cast<std::int32_t>(model.meshes.size());
    model.meshes.push_back(std::move(mesh));
    model.nodes.push_back(std::move(node));
  }
  return model;
}

void enter_street(const NearStreet& street, GpuScene& scene, Frame& frame) {
  const std::uint32_t model = scene.add(street_model(street));
  for (std::size_t i = 0; i < street.boxes.size(); ++i)
    frame.instances.push_back({model, static_cast<std::uint32_t>(i), true, glm::mat4(1.0f)});
  frame.scene = &scene;
  frame.sky = street.sky;
  frame.geometry_version = frame.lights_version = 1;
}

World street_world(const NearStreet& street) {
  return [street](const glm::dvec3& place, const glm::dvec3& direction) {
    double nearest = std::numeric_limits<double>::max();
    const StreetBox* hit = nullptr;
    for (const StreetBox& box : street.boxes) {
      double enter = 0.0, leave = nearest;
      for (int axis = 0; axis < 3; ++axis) {
        const double inverse = 1.0 / (std::abs(direction[axis]) > 1e-12 ? direction[axis] : 1e-12);
        const double a = (box.low_m[axis] - place[axis]) * inverse, b = (box.high_m[axis] - place[axis]) * inverse;
        enter = std::max(enter, std::min(a, b));
        leave = std::min(leave, std::max(a, b));
      }
      if (enter < leave && enter < nearest) nearest = enter, hit = &box;
    }
    if (hit) return glm::dvec3(hit->light_cd_m2);
    const double glow = std::exp(-std::max(direction.y, 0.0) / std::max(double(street.sky.glow_height), 1e-3));
    return glm::mix(glm::dvec3(street.sky.zenith_cd_m2), glm::dvec3(street.sky.horizon_cd_m2), glow);
  };
}

}  // namespace petrichor
