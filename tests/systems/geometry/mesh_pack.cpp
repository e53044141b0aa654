#include "systems/mesh_pack.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <glm/gtc/packing.hpp>
#include <random>

namespace petrichor::test {
namespace {

TEST(MeshPack, DirectionsSurvivePacking) {
  std::mt19937 random(9);
  std::normal_distribution<float> gauss;
  double worst_normal = 0, worst_tangent = 0;
  for (int i = 0; i < 20000; ++i) {
    Vertex v;
    v.normal = glm::normalize(glm::vec3(gauss(random), gauss(random), gauss(random)));
    if (i < 6) v.normal = glm::vec3(i == 0, i == 1, i == 2) - glm::vec3(i == 3, i == 4, i == 5);
    const glm::vec3 t = glm::cross(v.normal, glm::vec3(gauss(random), gauss(random), gauss(random)));
    v.tangent = glm::vec4(glm::normalize(t), i % 2 ? 1.0f : -1.0f);
    const PackedVertex p = pack_vertex(v);
    const glm::vec3 n = unit_from_octahedral({p.normal[0] / 32767.0f, p.normal[1] / 32767.0f});
    const glm::vec4 tangent = glm::unpackSnorm3x10_1x2(p.tangent);
    worst_normal = std::max(worst_normal, static_cast<double>(glm::length(glm::cross(n, v.normal))));
    worst_tangent = std::max(
        worst_tangent,
        static_cast<double>(glm::length(glm::cross(glm::normalize(glm::vec3(tangent)), glm::vec3(v.tangent)))));
    EXPECT_GT(glm::dot(n, v.normal), 0.99f);
    EXPECT_EQ(tangent.w, v.tangent.w);
  }
  EXPECT_LT(worst_normal, 1e-4);   // 16 bits over the octahedron: 6e-5
  EXPECT_LT(worst_tangent, 2e-3);  // 10 bits: half a step of 1/511 on each axis
}

TEST(MeshPack, ChunksKeepEveryTriangleOnceAndBoundIt) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(-50.0f, 50.0f);
  std::vector<Vertex> vertices(3000);
  for (Vertex& v : vertices) v.position_m = {unit(random), 0.1f * unit(random), unit(random)};
  std::vector<std::uint32_t> indices;
  for (std::uint32_t i = 0; i < 5000; ++i) {
    for (int k = 0; k < 3; ++k) indices.push_back((i * 7 + static_cast<std::uint32_t>(k) * 11) % 3000);
  }
  const auto triangles = [](const std::vector<std::uint32_t>& from) {
    std::vector<std::array<std::uint32_t, 3>> out;
    for (std::size_t i = 0; i < from.size(); i += 3) out.push_back({from[i], from[i + 1], from[i + 2]});
    std::sort(out.begin(), out.end());
    return out;
  };
  const auto before = triangles(indices);
  const std::vector<MeshChunk> chunks = cut_into_chunks(vertices, indices, 512);
  EXPECT_EQ(triangles(indices), before);
  std::uint32_t next = 0;
  for (const MeshChunk& chunk : chunks) {
    EXPECT_EQ(chunk.first_index, next);
    EXPECT_LE(chunk.index_count, 3u * 512u);
    next += chunk.index_count;
    for (std::uint32_t i = chunk.first_index; i < chunk.first_index + chunk.index_count; ++i) {
      const glm::vec3 off = glm::abs(vertices[indices[i]].position_m - chunk.centre_m) - chunk.half_extent_m;
      EXPECT_LT(std::max({off.x, off.y, off.z}), 1e-4f);
    }
  }
  EXPECT_EQ(next, indices.size());
  EXPECT_GE(chunks.size(), 10u);
}

}  // namespace
}  // namespace petrichor::test
