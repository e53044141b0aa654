#include "systems/mesh_pack.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>

namespace petrichor {
namespace {

glm::vec3 unit_or(const glm::vec3& v, const glm::vec3& otherwise) {
  const float length = glm::length(v);
  return length > 1e-12f && std::isfinite(length) ? v / length : otherwise;
}

float sign_of(float x) {
  return x >= 0.0f ? 1.0f : -1.0f;
}

std::uint16_t unorm16(float x) {
  return static_cast<std::uint16_t>(std::lround(glm::clamp(x, 0.0f, 1.0f) * 65535.0f));
}

struct Triangle {
  glm::vec3 centre;
  std::uint32_t number;
};

MeshChunk bound(std::span<const Vertex> vertices, std::span<const std::uint32_t> indices, std::uint32_t first,
                std::uint32_t count) {
  glm::vec3 low(INFINITY), high(-INFINITY);
  for (std::uint32_t i = first; i < first + count; ++i) {
    low = glm::min(low, vertices[indices[i]].position_m);
    high = glm::max(high, vertices[indices[i]].position_m);
  }
  return {first, count, 0.5f * (low + high), 0.5f * (high - low)};
}

void halve(std::span<Triangle> triangles, std::uint32_t maximum, std::vector<std::size_t>& ends, std::size_t first) {
  if (triangles.size() <= maximum) {
    // The order of the file inside a chunk: neighbours share vertices.
    std::sort(triangles.begin(), triangles.end(), [](auto& a, auto& b) { return a.number < b.number; });
    ends.push_back(first + triangles.size());
    return;
  }
  glm::vec3 low(INFINITY), high(-INFINITY);
  for (const Triangle& t : triangles) low = glm::min(low, t.centre), high = glm::max(high, t.centre);
  const glm::vec3 extent = high - low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const std::size_t middle = triangles.size() / 2;
  std::nth_element(triangles.begin(), triangles.begin() + static_cast<std::ptrdiff_t>(middle), triangles.end(),
                   [axis](const Triangle& a, const Triangle& b) {
                     return a.centre[axis] != b.centre[axis] ? a.centre[axis] < b.centre[axis] : a.number < b.number;
                   });
  halve(triangles.first(middle), maximum, ends, first);
  halve(triangles.subspan(middle), maximum, ends, first + middle);
}

}  // namespace

glm::vec2 octahedral_from_unit(const glm::vec3& n) {
  const glm::vec2 p = glm::vec2(n) / (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
  if (n.z >= 0.0f) return p;
  return {(1.0f - std::abs(p.y)) * sign_of(p.x), (1.0f - std::abs(p.x)) * sign_of(p.y)};
}

glm::vec3 unit_from_octahedral(const glm::vec2& p) {
  glm::vec3 n(p, 1.0f - std::abs(p.x) - std::abs(p.y));
  const float t = std::max(-n.z, 0.0f);
  n.x += n.x >= 0.0f ? -t : t;
  n.y += n.y >= 0.0f ? -t : t;
  return glm::normalize(n);
}

PackedVertex pack_vertex(const Vertex& v) {
  const glm::vec3 normal = unit_or(v.normal, {0.0f, 1.0f, 0.0f});
  // A tangent must not run along the normal: any other direction is better than a division by zero.
  glm::vec3 tangent = glm::vec3(v.tangent) - normal * glm::dot(glm::vec3(v.tangent), normal);
  const glm::vec3 other = std::abs(normal.y) < 0.9f ? glm::vec3(0.0f, 1.0f, 0.0f) : glm::vec3(1.0f, 0.0f, 0.0f);
  tangent = glm::length(tangent) > 1e-4f ? glm::normalize(tangent) : glm::normalize(glm::cross(other, normal));

  PackedVertex p{};
  const glm::vec2 oct = octahedral_from_unit(normal);
  p.normal[0] = static_cast<std::int16_t>(std::lround(oct.x * 32767.0f));
  p.normal[1] = static_cast<std::int16_t>(std::lround(oct.y * 32767.0f));
  p.tangent = glm::packSnorm3x10_1x2(glm::vec4(tangent, v.tangent.w < 0.0f ? -1.0f : 1.0f));
  for (int i = 0; i < 2; ++i) {
    p.uv0[i] = v.uv0[i];
    p.uv1[i] = v.uv1[i];
  }
  for (int i = 0; i < 4; ++i) p.colour[i] = unorm16(v.colour[i]);
  return p;
}

std::vector<MeshChunk> cut_into_chunks(std::span<const Vertex> vertices, std::vector<std::uint32_t>& indices,
                                       std::uint32_t maximum_triangles) {
  const auto count = static_cast<std::uint32_t>(indices.size() / 3);
  if (count == 0) return {};
  if (count <= maximum_triangles) return {bound(vertices, indices, 0, 3 * count)};
  std::vector<Triangle> triangles(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const glm::vec3 sum = vertices[indices[3 * i]].position_m + vertices[indices[3 * i + 1]].position_m +
                          vertices[indices[3 * i + 2]].position_m;
    triangles[i] = {sum / 3.0f, i};
  }
  std::vector<std::size_t> ends;
  halve(triangles, maximum_triangles, ends, 0);

  std::vector<std::uint32_t> sorted(indices.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::uint32_t k = 0; k < 3; ++k) sorted[3 * i + k] = indices[3 * triangles[i].number + k];
  }
  indices = std::move(sorted);
  std::vector<MeshChunk> chunks;
  std::uint32_t first = 0;
  for (const std::size_t end : ends) {
    const auto last = static_cast<std::uint32_t>(3 * end);
    chunks.push_back(bound(vertices, indices, first, last - first));
    first = last;
  }
  return chunks;
}

}  // namespace petrichor
