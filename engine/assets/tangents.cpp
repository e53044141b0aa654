// Tangents for normal maps, in the manner of MikkTSpace (Mikkelsen 2008, "Simulation of Wrinkled Surfaces
// Revisited"; glTF 2.0, section 3.7.2.1): per triangle from the texture coordinates, summed per vertex
// weighted by the corner's angle, never across a seam where the map is mirrored.

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "engine/assets/gltf_document.hpp"

namespace petrichor {
namespace {

glm::vec3 any_perpendicular(glm::vec3 n) {
  const glm::vec3 axis = std::abs(n.x) < 0.7f ? glm::vec3(1, 0, 0) : glm::vec3(0, 0, 1);
  return glm::normalize(axis - n * glm::dot(n, axis));
}

struct Face {
  glm::dvec3 tangent{0.0};  // unit, along growing u; zero where the coordinates are degenerate
  float handedness = 1.0f;
};

Face face_of(const Primitive& p, std::size_t corner, bool uv1) {
  const Vertex& a = p.vertices[p.indices[corner]];
  const Vertex& b = p.vertices[p.indices[corner + 1]];
  const Vertex& c = p.vertices[p.indices[corner + 2]];
  const auto uv = [&](const Vertex& v) { return glm::dvec2(uv1 ? v.uv1 : v.uv0); };
  const glm::dvec2 s = uv(b) - uv(a), t = uv(c) - uv(a);
  const double area = s.x * t.y - s.y * t.x;
  Face face;
  face.handedness = area > 0.0 ? -1.0f : 1.0f;
  // glTF's v grows downwards while the bitangent of a normal map points up: a right-handed layout with v
  // down (area < 0 seen from the front) is the +1 of TANGENT.w = handedness of cross(normal, tangent).
  const glm::dvec3 e = glm::dvec3(b.position_m) - glm::dvec3(a.position_m);
  const glm::dvec3 f = glm::dvec3(c.position_m) - glm::dvec3(a.position_m);
  if (std::abs(area) < 1e-30) return face;
  const glm::dvec3 tangent = (e * t.y - f * s.y) * (area > 0.0 ? 1.0 : -1.0);
  const double length = glm::length(tangent);
  if (length > 1e-30) face.tangent = tangent / length;
  return face;
}

double corner_angle(const Primitive& p, std::size_t triangle, std::size_t k) {
  const glm::dvec3 at = p.vertices[p.indices[triangle + k]].position_m;
  const glm::dvec3 e = glm::dvec3(p.vertices[p.indices[triangle + (k + 1) % 3]].position_m) - at;
  const glm::dvec3 f = glm::dvec3(p.vertices[p.indices[triangle + (k + 2) % 3]].position_m) - at;
  return std::atan2(glm::length(glm::cross(e, f)), glm::dot(e, f));
}

}  // namespace

void compute_tangents(Primitive& p, bool uv1, bool exact) {
  if (!exact) {
    for (Vertex& v : p.vertices) v.tangent = glm::vec4(any_perpendicular(v.normal), 1.0f);
    return;
  }
  constexpr float unset = 0.0f;
  std::vector<float> handedness(p.vertices.size(), unset);
  std::vector<glm::dvec3> sums(p.vertices.size(), glm::dvec3(0.0));
  std::unordered_map<std::uint32_t, std::uint32_t> mirrored;  // the second vertex of one on a mirror seam
  for (std::size_t i = 0; i < p.indices.size(); i += 3) {
    const Face face = face_of(p, i, uv1);
    if (face.tangent == glm::dvec3(0.0)) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      std::uint32_t v = p.indices[i + k];
      const double angle = corner_angle(p, i, k);
      if (handedness[v] != unset && handedness[v] != face.handedness) {
        const auto [entry, added] = mirrored.emplace(v, static_cast<std::uint32_t>(p.vertices.size()));
        if (added) {
          const Vertex copy = p.vertices[v];
          p.vertices.push_back(copy);
          handedness.push_back(unset);
          sums.emplace_back(0.0);
        }
        v = p.indices[i + k] = entry->second;
      }
      handedness[v] = face.handedness;
      const glm::dvec3 n = p.vertices[v].normal;
      const glm::dvec3 in_plane = face.tangent - n * glm::dot(n, face.tangent);
      const double length = glm::length(in_plane);
      if (length > 1e-12) sums[v] += in_plane / length * angle;
    }
  }
  for (std::size_t i = 0; i < p.vertices.size(); ++i) {
    const double length = glm::length(sums[i]);
    const glm::vec3 tangent = length > 1e-12 ? glm::vec3(sums[i] / length) : any_perpendicular(p.vertices[i].normal);
    p.vertices[i].tangent = glm::vec4(tangent, handedness[i] == unset ? 1.0f : handedness[i]);
  }
}

}  // namespace petrichor
