#include "systems/mirror/street.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace petrichor {

MirrorStreet make_mirror_street() {
  MirrorStreet street;
  const auto add = [&](glm::vec3 low, glm::vec3 high, glm::vec3 light) { street.boxes.push_back({low, high, light}); };
  add({-30, -0.5f, -70}, {30, -0.01f, 40}, {0.10f, 0.09f, 0.08f});  // the ground, a film below the water
  for (const float side : {-1.0f, 1.0f}) {
    const float wall = 5.0f * side;
    add({std::min(wall, wall + 6 * side), -0.01f, -50}, {std::max(wall, wall + 6 * side), 9, 30},
        {0.05f, 0.05f, 0.07f});
    for (int i = 0; i < 7; ++i)
      for (int storey = 0; storey < 2; ++storey) {
        const float z = -40.0f + 9.0f * static_cast<float>(i) + (side > 0 ? 3.0f : 0.0f), x = wall - 0.06f * side;
        if (side > 0 && storey == 0 && z > -9.0f && z < 0.0f) continue;  // the pane's place
        const float y = 1.0f + 3.2f * static_cast<float>(storey);
        const glm::vec3 light = (i + storey) % 3 == 0 ? glm::vec3(1.5f, 3.0f, 6.0f) : glm::vec3(9.0f, 6.0f, 3.0f);
        add({std::min(x, wall), y, z}, {std::max(x, wall), y + 1.7f, z + 2.2f}, light);
      }
    for (int i = 0; i < 4; ++i) {  // posts, and their lamps beside them
      const float x = 3.6f * side, z = -26.0f + 9.0f * static_cast<float>(i);
      add({x - 0.06f, -0.01f, z - 0.06f}, {x + 0.06f, 4.6f, z + 0.06f}, {0.01f, 0.01f, 0.01f});
      add({x - 0.2f - 0.2f * side, 4.6f, z - 0.2f}, {x + 0.2f - 0.2f * side, 5.0f, z + 0.2f}, {29.0f, 22.0f, 12.0f});
    }
  }
  add({-5, -0.01f, -52}, {5, 5, -50}, {6.0f, 2.0f, 1.0f});  // the shop across the end
  street.sky.zenith_cd_m2 = {0.02f, 0.025f, 0.04f};
  street.sky.horizon_cd_m2 = {0.25f, 0.18f, 0.12f};
  street.puddle.world_from_puddle = glm::translate(glm::mat4(1.0f), {0, 0, -6});
  street.puddle.half_size_m = {2.0f, 6.0f};
  street.puddle.level_m = street.puddle.depth_m = 0.02f;
  // Its z looks back across the street.
  street.pane.world =
      glm::mat4(glm::vec4(0, 0, 1, 0), glm::vec4(0, 1, 0, 0), glm::vec4(-1, 0, 0, 0), glm::vec4(4.9f, 1.7f, -4.5f, 1));
  street.pane.size_m = {4.0f, 2.4f};
  return street;
}

Model box_model(const std::vector<ShiningBox>& boxes) {
  Model model;
  for (const ShiningBox& box : boxes) {
    Material material;
    material.base_colour = glm::vec4(0, 0, 0, 1);
    material.metallic = 0.0f;
    material.emissive = box.light_cd_m2;
    Primitive p;
    p.material = static_cast<std::int32_t>(model.materials.size());
    model.materials.push_back(material);
    p.bounds_min_m = box.low_m;
    p.bounds_max_m = box.high_m;
    for (int face = 0; face < 6; ++face) {
      const int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
      const bool far = face % 2 == 1;
      const auto first = static_cast<std::uint32_t>(p.vertices.size());
      for (int corner = 0; corner < 4; ++corner) {
        Vertex vertex;
        vertex.position_m[axis] = far ? box.high_m[axis] : box.low_m[axis];
        vertex.position_m[u] = corner & 1 ? box.high_m[u] : box.low_m[u];
        vertex.position_m[v] = corner & 2 ? box.high_m[v] : box.low_m[v];
        vertex.normal = glm::vec3(0.0f);
        vertex.normal[axis] = far ? 1.0f : -1.0f;
        p.vertices.push_back(vertex);
      }
      for (const std::uint32_t i : {0u, 1u, 3u, 0u, 3u, 2u})  // seen from outside, counter-clockwise
        p.indices.push_back(first + (far ? i : i == 1u ? 2u : i == 2u ? 1u : i));
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

RayHit trace_street(const MirrorStreet& street, const glm::dvec3& from_m, const glm::dvec3& direction) {
  RayHit hit;
  const ShiningBox* nearest = nullptr;
  for (const ShiningBox& box : street.boxes) {
    double enter = 1e-6, leave = hit.distance_m;
    for (int axis = 0; axis < 3; ++axis) {
      const double inverse = 1.0 / (std::abs(direction[axis]) > 1e-12 ? direction[axis] : 1e-12);
      const double a = (static_cast<double>(box.low_m[axis]) - from_m[axis]) * inverse;
      const double b = (static_cast<double>(box.high_m[axis]) - from_m[axis]) * inverse;
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    if (enter < leave) hit.distance_m = enter, nearest = &box;
  }
  if (nearest) {
    hit.light_cd_m2 = glm::dvec3(nearest->light_cd_m2);
  } else {
    const double glow =
        std::exp(-std::max(direction.y, 0.0) / std::max(static_cast<double>(street.sky.glow_height), 1e-3));
    hit.light_cd_m2 = glm::mix(glm::dvec3(street.sky.zenith_cd_m2), glm::dvec3(street.sky.horizon_cd_m2), glow);
  }
  return hit;
}

glm::dvec3 trace_lobe(const MirrorStreet& street, const glm::dvec3& place_m, const glm::dvec3& normal,
                      const glm::dvec3& view, double roughness, int samples) {
  const double alpha = roughness * roughness;
  const glm::dvec3 aside = std::abs(normal.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 t = glm::normalize(glm::cross(aside, normal)), b = glm::cross(normal, t);
  const glm::dvec3 v(glm::dot(view, t), glm::dot(view, b), glm::dot(view, normal));
  const glm::dvec3 stretched = glm::normalize(glm::dvec3(alpha * v.x, alpha * v.y, v.z));
  const double flat = stretched.x * stretched.x + stretched.y * stretched.y;
  const glm::dvec3 t1 = flat > 0.0 ? glm::dvec3(-stretched.y, stretched.x, 0.0) / std::sqrt(flat) : glm::dvec3(1, 0, 0);
  const glm::dvec3 t2 = glm::cross(stretched, t1);
  glm::dvec3 sum(0.0);
  double weights = 0.0;
  for (int i = 0; i < samples; ++i) {
    // A spiral of golden angles over the disc.
    const double r = std::sqrt((i + 0.5) / samples), angle = 2.39996322972865 * i;
    const double p1 = r * std::cos(angle), s = 0.5 * (1.0 + stretched.z);
    const double p2 = (1.0 - s) * std::sqrt(std::max(1.0 - p1 * p1, 0.0)) + s * r * std::sin(angle);
    const glm::dvec3 n = p1 * t1 + p2 * t2 + std::sqrt(std::max(1.0 - p1 * p1 - p2 * p2, 0.0)) * stretched;
    const glm::dvec3 h = glm::normalize(glm::dvec3(alpha * n.x, alpha * n.y, std::max(n.z, 0.0)));
    const glm::dvec3 l = 2.0 * glm::dot(v, h) * h - v;
    if (l.z <= 0.0) continue;
    const double square = (l.x * l.x + l.y * l.y) / (l.z * l.z);
    const double weight = 2.0 / (1.0 + std::sqrt(1.0 + alpha * alpha * square));  // Smith's G1
    sum += weight * trace_street(street, place_m, l.x * t + l.y * b + l.z * normal).light_cd_m2;
    weights += weight;
  }
  return weights > 0.0 ? sum / weights : glm::dvec3(0.0);
}

}  // namespace petrichor
