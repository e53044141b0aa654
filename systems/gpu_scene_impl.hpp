#pragma once
// Inside GpuScene: for gpu_scene.cpp (upload) and gpu_scene_draw.cpp only.

#include <array>
#include <map>
#include <tuple>

#include "systems/gpu_scene.hpp"
#include "systems/material_shared.h"
#include "systems/wet_materials.hpp"

namespace petrichor {

// One draw: a chunk of a primitive.
struct SceneChunk {
  std::uint32_t first_index;
  std::uint32_t index_count;
  std::int32_t base_vertex;
  std::uint32_t material;  // in GpuScene::Impl::materials
  glm::vec3 centre_m;
  glm::vec3 half_extent_m;
};

struct SceneMesh {
  std::uint32_t first_chunk, chunk_count;
  bool blended;  // any of it
};

struct SceneMaterial {
  std::array<GLuint, MATERIAL_TEXTURES> textures;
  std::array<GLuint, MATERIAL_TEXTURES> samplers;
  unsigned variant;  // MaterialVariant bits
  AlphaMode alpha_mode;
  bool double_sided;
};

// A chunk of an instance, in camera-relative space.
struct SceneItem {
  glm::vec3 centre_m;
  glm::vec3 half_extent_m;
  std::uint32_t chunk;
  std::uint32_t instance;
  bool flipped;  // its matrix mirrors
  bool casts_shadow;
};

// Rows of object -> camera-relative world; the fourth is (0, 0, 0, 1).
struct InstanceRows {
  glm::vec4 x, y, z;
};

struct DrawCommand {  // DrawElementsIndirectCommand
  GLuint count, instance_count, first_index;
  GLint base_vertex;
  GLuint base_instance;
};

struct GpuScene::Impl {
  bool software = false;
  Buffer position_buffer, attribute_buffer, index_buffer, material_buffer;
  Buffer stream_buffer, command_buffer;  // per draw_instances: instances, indirect commands
  std::size_t stream_offset = 0, command_offset = 0;
  std::size_t vertex_count = 0, index_count = 0;
  VertexArray all_attributes, positions_only;
  std::size_t material_stride = 0;

  std::vector<Texture> textures;
  Texture white, flat_normal;
  std::map<std::tuple<Wrap, Wrap, bool>, Sampler> samplers;

  std::vector<SceneChunk> chunks;
  std::vector<std::vector<SceneMesh>> models;
  std::vector<SceneMaterial> materials;
  std::vector<std::byte> material_bytes;
  std::vector<WetMaterialGpu> wet_materials{WetMaterialGpu{}};  // the first never gets wet
  Buffer wet_material_buffer;

  std::vector<SceneItem> items;  // of the frame
  std::vector<InstanceRows> instances;
  struct Visible {
    std::uint64_t key;
    std::uint32_t item;
  };
  std::vector<Visible> visible;
  std::vector<float> chunk_distance;
  std::vector<InstanceRows> stream;
  std::vector<DrawCommand> commands;

  GLuint sampler(const TextureUse&);
};

}  // namespace petrichor
