// Per frame: instances to the GPU; per pass: cull, group, draw.

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

#include "systems/frustum.hpp"
#include "systems/gpu_scene_impl.hpp"

namespace petrichor {
namespace {

constexpr std::size_t ring_bytes = 1 << 20;

// Writes behind what the GPU may still be reading; starts over where the end is reached.
std::size_t stream(Buffer& buffer, std::size_t& offset, const void* data, std::size_t bytes) {
  if (!buffer.id || bytes > buffer.bytes) {
    buffer = make_buffer(std::max(ring_bytes, std::bit_ceil(bytes)));
    offset = 0;
  }
  if (offset + bytes > buffer.bytes) {
    glInvalidateBufferData(buffer.id);
    offset = 0;
  }
  glNamedBufferSubData(buffer.id, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
  const std::size_t at = offset;
  offset += (bytes + 63) & ~std::size_t{63};
  return at;
}

bool takes(DrawWhat what, AlphaMode alpha, bool casts_shadow) {
  switch (what) {
    case DrawWhat::depth_only:
      return casts_shadow && alpha != AlphaMode::blend;
    case DrawWhat::shelter:
      return true;
    case DrawWhat::opaque:
      return alpha != AlphaMode::blend;
    case DrawWhat::blended:
      return alpha == AlphaMode::blend;
  }
  return false;
}

// Orders floats >= 0 as their 16 leading bits.
std::uint64_t short_distance(float distance) {
  return std::bit_cast<std::uint32_t>(std::max(distance, 0.0f)) >> 15;
}

// State that changes between batches: its order is the order of the batches.
std::uint64_t batch_of(const SceneChunk& chunk, bool flipped, bool with_materials) {
  return (with_materials ? std::uint64_t{chunk.material} << 1 : 0u) | (flipped ? 1u : 0u);
}

}  // namespace

void upload_instances(GpuScene& scene, const Frame& frame) {
  GpuScene::Impl& s = *scene.impl;
  s.items.clear();
  s.instances.clear();
  if (s.wet_material_buffer.id)
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, WET_MATERIALS_BINDING, s.wet_material_buffer.id);
  for (std::size_t i = 0; i < frame.instances.size(); ++i) {
    const FrameInstance& in = frame.instances[i];
    glm::mat4 m = in.matrix;
    m[3] = glm::vec4(glm::vec3(glm::dvec3(in.matrix[3]) - frame.camera.position_m), 1.0f);
    const glm::mat3 linear(m);
    const float determinant = glm::determinant(linear);
    const glm::mat4 rows = glm::transpose(m);
    s.instances.push_back({rows[0], rows[1], rows[2]});
    assert(in.model < s.models.size() && in.mesh < s.models[in.model].size());
    const SceneMesh& mesh = s.models[in.model][in.mesh];
    const glm::mat3 absolute(glm::abs(linear[0]), glm::abs(linear[1]), glm::abs(linear[2]));
    for (std::uint32_t c = mesh.first_chunk; c < mesh.first_chunk + mesh.chunk_count; ++c) {
      const SceneChunk& chunk = s.chunks[c];
      s.items.push_back({linear * chunk.centre_m + glm::vec3(m[3]), absolute * chunk.half_extent_m, c,
                         static_cast<std::uint32_t>(i), determinant < 0.0f, in.casts_shadow});
    }
  }
}

std::uint64_t draw_instances(GpuScene& scene, const Frame& frame, const glm::mat4& clip_from_relative, DrawWhat what,
                             std::span<const Program* const> by_variant) {
  GpuScene::Impl& s = *scene.impl;
  assert(s.instances.size() == frame.instances.size());  // upload_instances first
  assert(by_variant.empty() || by_variant.size() == material_variants);
  (void)frame;
  const bool with_materials = what == DrawWhat::opaque || what == DrawWhat::blended;
  const bool far_to_near = what == DrawWhat::blended;
  const Frustum frustum = frustum_of(clip_from_relative);

  // Distances along the view: w of a perspective, else depth; any monotonous measure of "near" will do.
  const glm::mat4 rows = glm::transpose(clip_from_relative);
  const bool perspective = glm::vec3(rows[3]) != glm::vec3(0.0f);
  s.visible.clear();
  s.chunk_distance.assign(s.chunks.size(), INFINITY);
  for (std::uint32_t i = 0; i < s.items.size(); ++i) {
    const SceneItem& item = s.items[i];
    if (!takes(what, s.materials[s.chunks[item.chunk].material].alpha_mode, item.casts_shadow)) continue;
    if (!box_touches(frustum, item.centre_m, item.half_extent_m)) continue;
    const float distance = perspective ? glm::dot(glm::vec3(rows[3]), item.centre_m) + rows[3].w : 0.0f;
    s.visible.push_back({std::bit_cast<std::uint32_t>(distance), i});
    float& nearest = s.chunk_distance[item.chunk];
    nearest = std::min(nearest, distance);
  }
  // Near batches of a chunk first, all its instances together; glass strictly from far to near.
  for (GpuScene::Impl::Visible& v : s.visible) {
    const SceneItem& item = s.items[v.item];
    const SceneChunk& chunk = s.chunks[item.chunk];
    const float own = std::bit_cast<float>(static_cast<std::uint32_t>(v.key));
    v.key = far_to_near ? ~(std::uint64_t{std::bit_cast<std::uint32_t>(std::max(own, 0.0f))} << 24)
                        : batch_of(chunk, item.flipped, with_materials) << 44 |
                              short_distance(s.chunk_distance[item.chunk]) << 24 | (item.chunk & 0xffffffu);
  }
  std::sort(s.visible.begin(), s.visible.end(),
            [](const auto& a, const auto& b) { return a.key != b.key ? a.key < b.key : a.item < b.item; });
  if (s.visible.empty()) return 0;

  s.stream.clear();
  s.commands.clear();
  struct Batch {
    std::uint64_t state;
    std::uint32_t material;
    std::size_t first, count;
  };
  std::vector<Batch> batches;
  std::uint64_t triangles = 0;
  const SceneItem* last = nullptr;
  for (const GpuScene::Impl::Visible& v : s.visible) {
    const SceneItem& item = s.items[v.item];
    const SceneChunk& chunk = s.chunks[item.chunk];
    const std::uint64_t state = batch_of(chunk, item.flipped, with_materials);
    const bool new_batch = batches.empty() || batches.back().state != state;
    if (new_batch) batches.push_back({state, chunk.material, s.commands.size(), 0});
    if (!new_batch && last && last->chunk == item.chunk) {
      ++s.commands.back().instance_count;
    } else {
      s.commands.push_back(
          {chunk.index_count, 1, chunk.first_index, chunk.base_vertex, static_cast<GLuint>(s.stream.size())});
      ++batches.back().count;
    }
    s.stream.push_back(s.instances[item.instance]);
    triangles += chunk.index_count / 3;
    last = &item;
  }

  const std::size_t stream_at =
      stream(s.stream_buffer, s.stream_offset, s.stream.data(), s.stream.size() * sizeof(InstanceRows));
  const std::size_t commands_at =
      stream(s.command_buffer, s.command_offset, s.commands.data(), s.commands.size() * sizeof(DrawCommand));
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  const GLuint array = with_materials ? s.all_attributes : s.positions_only;
  glVertexArrayVertexBuffer(array, 2, s.stream_buffer.id, static_cast<GLintptr>(stream_at), sizeof(InstanceRows));
  glBindVertexArray(array);
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, s.command_buffer.id);
  for (const Batch& batch : batches) {
    glFrontFace(batch.state & 1u ? GL_CW : GL_CCW);
    if (with_materials) {
      const SceneMaterial& material = s.materials[batch.material];
      if (!by_variant.empty()) by_variant[material.variant]->use();
      material.double_sided ? glDisable(GL_CULL_FACE) : glEnable(GL_CULL_FACE);
      glBindTextures(MATERIAL_FIRST_UNIT, MATERIAL_TEXTURES, material.textures.data());
      glBindSamplers(MATERIAL_FIRST_UNIT, MATERIAL_TEXTURES, material.samplers.data());
      glBindBufferRange(GL_UNIFORM_BUFFER, MATERIAL_UNIFORMS_BINDING, s.material_buffer.id,
                        static_cast<GLintptr>(batch.material * s.material_stride), sizeof(MaterialGpu));
    }
    glMultiDrawElementsIndirect(GL_TRIANGLES, GL_UNSIGNED_INT,
                                reinterpret_cast<const void*>(commands_at + batch.first * sizeof(DrawCommand)),
                                static_cast<GLsizei>(batch.count), 0);
  }
  // What was set here is put back: later passes sample with their textures' own settings.
  if (with_materials) glBindSamplers(MATERIAL_FIRST_UNIT, MATERIAL_TEXTURES, nullptr);
  glFrontFace(GL_CCW);
  return triangles;
}

}  // namespace petrichor
