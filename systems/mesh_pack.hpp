#pragma once
// Meshes made ready for the GPU: thin vertices, and big meshes cut into chunks that can be culled one by one.

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "engine/assets/model.hpp"

namespace petrichor {

// All that a vertex has but its position, which stands in a stream of its own: depth-only passes read no more.
struct PackedVertex {
  std::int16_t normal[2];  // octahedral, signed normalised
  std::uint32_t tangent;   // 10.10.10 signed normalised, 2 bits of handedness
  float uv0[2];
  float uv1[2];
  std::uint16_t colour[4];  // unsigned normalised, linear
};
static_assert(sizeof(PackedVertex) == 32);

PackedVertex pack_vertex(const Vertex&);
glm::vec2 octahedral_from_unit(const glm::vec3&);  // as in systems/geometry/gbuffer.glsl
glm::vec3 unit_from_octahedral(const glm::vec2&);

struct MeshChunk {
  std::uint32_t first_index;  // in the primitive's indices
  std::uint32_t index_count;
  glm::vec3 centre_m;  // box in object space
  glm::vec3 half_extent_m;
};

// Reorders the triangles so that each chunk holds at most maximum_triangles that lie close together (halved at
// the median of their centres along the longest axis). The set of triangles stays the same.
std::vector<MeshChunk> cut_into_chunks(std::span<const Vertex>, std::vector<std::uint32_t>& indices,
                                       std::uint32_t maximum_triangles);

}  // namespace petrichor
