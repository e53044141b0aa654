#include "systems/gpu_scene.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <string_view>

#include "engine/core/log.hpp"
#include "systems/gpu_scene_impl.hpp"
#include "systems/mesh_pack.hpp"

namespace petrichor {
namespace {

// Small enough to cull well, large enough for few draws.
constexpr std::uint32_t chunk_triangles = 768;

void append(Buffer& buffer, std::size_t used, const void* data, std::size_t bytes) {
  if (!buffer.id) buffer = make_buffer(0);
  if (used + bytes > buffer.bytes) {
    Buffer larger = make_buffer(std::max(used + bytes, 2 * buffer.bytes));
    if (used) glCopyNamedBufferSubData(buffer.id, larger.id, 0, 0, static_cast<GLsizeiptr>(used));
    buffer = std::move(larger);
  }
  if (bytes) glNamedBufferSubData(buffer.id, static_cast<GLintptr>(used), static_cast<GLsizeiptr>(bytes), data);
}

VertexArray new_vertex_array() {
  GLuint id = 0;
  glCreateVertexArrays(1, &id);
  return VertexArray(id);
}

void attribute(GLuint array, GLuint index, GLint size, GLenum type, bool normalised, GLuint offset, GLuint binding) {
  glEnableVertexArrayAttrib(array, index);
  glVertexArrayAttribFormat(array, index, size, type, normalised, offset);
  glVertexArrayAttribBinding(array, index, binding);
}

Texture one_texel(std::array<std::uint8_t, 4> rgba) {
  Texture texture = make_texture_2d(1, 1, GL_RGBA8);
  glTextureSubImage2D(texture.id, 0, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  return texture;
}

Texture upload_image(const Image& image, bool srgb) {
  const GLenum format = image.is_float ? GL_RGBA16F : srgb ? GL_SRGB8_ALPHA8 : GL_RGBA8;
  const int levels = full_mip_levels(image.width, image.height);
  Texture texture = make_texture_2d(image.width, image.height, format, levels);
  glTextureSubImage2D(texture.id, 0, 0, 0, image.width, image.height, GL_RGBA,
                      image.is_float ? GL_FLOAT : GL_UNSIGNED_BYTE, image.pixels.data());
  glGenerateTextureMipmap(texture.id);  // sRGB texels are averaged as light (OpenGL 4.5, 8.14.4)
  return texture;
}

bool same_placement(const TextureUse& a, const TextureUse& b) {
  return a.texcoord == b.texcoord && a.offset == b.offset && a.scale == b.scale && a.rotation_rad == b.rotation_rad;
}

GLint wrap_mode(Wrap wrap) {
  return wrap == Wrap::repeat ? GL_REPEAT : wrap == Wrap::clamp ? GL_CLAMP_TO_EDGE : GL_MIRRORED_REPEAT;
}

// Its place in the table of wet materials; materials that take water alike share one.
unsigned wet_kind(GpuScene::Impl& scene, const MaterialWater& water) {
  if (!water.wets) return 0;
  std::vector<WetMaterialGpu>& kinds = scene.wet_materials;
  const auto same = [&](const WetMaterialGpu& k) {
    return k.absorption_depth == water.gpu.absorption_depth && k.ripple == water.gpu.ripple;
  };
  auto found = std::find_if(kinds.begin() + 1, kinds.end(), same);
  if (found == kinds.end() && kinds.size() == WET_MATERIAL_KINDS) {
    log_warn("more than {} ways to take water among the materials; the rest is as the first", WET_MATERIAL_KINDS - 1);
    return 1;
  }
  if (found == kinds.end()) found = kinds.insert(kinds.end(), water.gpu);
  return static_cast<unsigned>(found - kinds.begin());
}

// Decides what the shader has to do, and gathers the textures. `texture_of` maps an image to its texture.
template <class TextureOf>
SceneMaterial describe(GpuScene::Impl& scene, const Material& m, const MaterialWater& water, TextureOf texture_of,
                       MaterialGpu& gpu) {
  const std::array<const TextureUse*, MATERIAL_TEXTURES> uses{&m.base_colour_texture, &m.metallic_roughness_texture,
                                                              &m.normal_texture, &m.occlusion_texture,
                                                              &m.emissive_texture,      &m.hollow_texture};
  SceneMaterial out{};
  out.alpha_mode = m.alpha_mode;
  out.double_sided = m.double_sided;
  gpu = {};
  gpu.base_colour = m.base_colour;
  gpu.emissive_cutoff = glm::vec4(m.emissive, m.alpha_mode == AlphaMode::mask ? m.alpha_cutoff : 0.0f);
  gpu.surface = {m.metallic, m.roughness, m.normal_scale, m.occlusion_strength};
  gpu.choices.y = m.double_sided ? 1.0f : 0.0f;
  gpu.choices.z = m.unlit ? 1.0f : 0.0f;
  gpu.water = {water.hollow == Hollow::texcoord_1 ? 1.0f : 0.0f, water.hollow == Hollow::vertex_colour ? 1.0f : 0.0f,
               static_cast<float>(wet_kind(scene, water)) / 255.0f, water.hollow == Hollow::texture ? 1.0f : 0.0f};
  gpu.relief = {water.relief, water.relief_mean, 0.0f, 0.0f};

  const TextureUse* first = nullptr;
  bool general = m.alpha_mode == AlphaMode::mask || water.hollow == Hollow::vertex_colour ||
                 water.hollow == Hollow::texture;
  for (int slot = 0; slot < MATERIAL_TEXTURES; ++slot) {
    const TextureUse& use = *uses[slot];
    if (slot == MATERIAL_HOLLOW && water.hollow != Hollow::texture) {
      out.textures[slot] = scene.white.id;
      out.samplers[slot] = scene.sampler({});
      continue;
    }
    const bool colour = slot == MATERIAL_BASE_COLOUR || slot == MATERIAL_EMISSIVE;
    out.textures[slot] = use.image == no_index ? (slot == MATERIAL_NORMAL ? scene.flat_normal.id : scene.white.id)
                                               : texture_of(use.image, colour);
    out.samplers[slot] = scene.sampler(use);
    // u' = s_x cos u + s_y sin v, v' = -s_x sin u + s_y cos v: counter-clockwise as v points down (the extension's
    // own example, a quadrant turned by 90 degrees, tells the sign).
    const float c = std::cos(use.rotation_rad), s = std::sin(use.rotation_rad);
    gpu.matrix[slot] = {use.scale.x * c, use.scale.y * s, -use.scale.x * s, use.scale.y * c};
    gpu.offset_set[slot] = {use.offset, static_cast<float>(use.texcoord), 0.0f};
    if (use.image == no_index) continue;
    if (!first) first = &use;
    general |= !same_placement(*first, use) || use.texcoord != 0;
  }
  const TextureUse& occlusion = m.occlusion_texture;
  const TextureUse& surface = m.metallic_roughness_texture;
  const bool shared =
      occlusion.image != no_index && occlusion.image == surface.image && same_placement(occlusion, surface);
  gpu.choices.x = shared ? 1.0f : 0.0f;
  general |= occlusion.image != no_index && !shared;
  if (occlusion.image == no_index) gpu.surface.w = 0.0f;
  // Without its own texture each slot takes the first one's placement: unread, but defined.
  const auto bit = [&](int slot, unsigned flag) { return uses[slot]->image != no_index ? flag : 0u; };
  out.variant = general ? unsigned{variant_general}
                        : bit(MATERIAL_BASE_COLOUR, variant_base_colour) | bit(MATERIAL_SURFACE, variant_surface) |
                              bit(MATERIAL_NORMAL, variant_normal) | bit(MATERIAL_EMISSIVE, variant_emissive);
  if (!general && first) {
    for (int slot = 0; slot < MATERIAL_TEXTURES; ++slot) {
      const auto from = static_cast<std::size_t>(std::find(uses.begin(), uses.end(), first) - uses.begin());
      gpu.matrix[slot] = gpu.matrix[from];
      gpu.offset_set[slot] = gpu.offset_set[from];
    }
  }
  return out;
}

}  // namespace

GLuint GpuScene::Impl::sampler(const TextureUse& use) {
  Sampler& sampler = samplers[{use.wrap_u, use.wrap_v, use.nearest}];
  if (!sampler) {
    GLuint id = 0;
    glCreateSamplers(1, &id);
    sampler = Sampler(id);
    glSamplerParameteri(id, GL_TEXTURE_WRAP_S, wrap_mode(use.wrap_u));
    glSamplerParameteri(id, GL_TEXTURE_WRAP_T, wrap_mode(use.wrap_v));
    glSamplerParameteri(id, GL_TEXTURE_MAG_FILTER, use.nearest ? GL_NEAREST : GL_LINEAR);
    // On software each lookup is paid on the CPU: one mip level instead of two, and no anisotropy.
    glSamplerParameteri(id, GL_TEXTURE_MIN_FILTER,
                        use.nearest ? GL_NEAREST_MIPMAP_NEAREST
                        : software  ? GL_LINEAR_MIPMAP_NEAREST
                                    : GL_LINEAR_MIPMAP_LINEAR);
    if (!use.nearest && !software && epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic")) {
      glSamplerParameterf(id, GL_TEXTURE_MAX_ANISOTROPY_EXT, 8.0f);
    }
  }
  return sampler;
}

GpuScene::GpuScene() : impl(std::make_unique<Impl>()) {
  const auto* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const std::string_view renderer = name ? name : "";
  for (const std::string_view software : {"llvmpipe", "softpipe", "SwiftShader"}) {
    impl->software |= renderer.find(software) != std::string_view::npos;
  }
  impl->white = one_texel({255, 255, 255, 255});
  impl->flat_normal = one_texel({128, 128, 255, 255});
  GLint alignment = 256;
  glGetIntegerv(GL_UNIFORM_BUFFER_OFFSET_ALIGNMENT, &alignment);
  const auto step = static_cast<std::size_t>(std::max(alignment, 16));
  impl->material_stride = (sizeof(MaterialGpu) + step - 1) / step * step;

  impl->all_attributes = new_vertex_array();
  impl->positions_only = new_vertex_array();
  for (const GLuint array : {GLuint{impl->all_attributes}, GLuint{impl->positions_only}}) {
    attribute(array, 0, 3, GL_FLOAT, false, 0, 0);
    for (GLuint row = 0; row < 3; ++row) attribute(array, 6 + row, 4, GL_FLOAT, false, row * sizeof(glm::vec4), 2);
    glVertexArrayBindingDivisor(array, 2, 1);
  }
  const GLuint all = impl->all_attributes;
  attribute(all, 1, 2, GL_SHORT, true, offsetof(PackedVertex, normal), 1);
  attribute(all, 2, 4, GL_INT_2_10_10_10_REV, true, offsetof(PackedVertex, tangent), 1);
  attribute(all, 3, 2, GL_FLOAT, false, offsetof(PackedVertex, uv0), 1);
  attribute(all, 4, 2, GL_FLOAT, false, offsetof(PackedVertex, uv1), 1);
  attribute(all, 5, 4, GL_UNSIGNED_SHORT, true, offsetof(PackedVertex, colour), 1);
}

GpuScene::~GpuScene() = default;

std::uint32_t GpuScene::add(const Model& model) {
  Impl& s = *impl;
  // An image becomes one texture per use as colour or as data, made when a material first asks for it.
  std::vector<std::array<GLuint, 2>> made(model.images.size(), {0, 0});
  const auto texture_of = [&](std::int32_t image, bool colour) {
    GLuint& id = made[static_cast<std::size_t>(image)][colour];
    if (!id) {
      s.textures.push_back(upload_image(model.images[static_cast<std::size_t>(image)], colour));
      id = s.textures.back().id;
    }
    return id;
  };
  const auto first_material = static_cast<std::uint32_t>(s.materials.size());
  std::vector<Material> materials = model.materials;
  Material plain;  // glTF's default material, for primitives that name none
  plain.metallic = 0.0f;
  materials.push_back(plain);
  // Whoever loads a model reads these first and says what is wrong with them.
  std::vector<MaterialWater> waters =
      read_material_water(model).value_or(std::vector<MaterialWater>(model.materials.size()));
  waters.emplace_back();
  for (std::size_t i = 0; i < materials.size(); ++i) {
    MaterialGpu gpu;
    s.materials.push_back(describe(s, materials[i], waters[i], texture_of, gpu));
    const std::size_t at = s.material_bytes.size();
    s.material_bytes.resize(at + s.material_stride);
    std::memcpy(s.material_bytes.data() + at, &gpu, sizeof gpu);
  }
  upload(s.material_buffer, s.material_bytes.data(), s.material_bytes.size());
  std::vector<WetMaterialGpu> table = s.wet_materials;
  table.resize(WET_MATERIAL_KINDS);  // no kind reads beyond the end
  upload(s.wet_material_buffer, std::span<const WetMaterialGpu>(table));

  std::vector<glm::vec3> positions;
  std::vector<PackedVertex> attributes;
  std::vector<std::uint32_t> all_indices;
  std::vector<SceneMesh> meshes;
  for (const Mesh& mesh : model.meshes) {
    SceneMesh out{static_cast<std::uint32_t>(s.chunks.size()), 0, false};
    for (const Primitive& primitive : mesh.primitives) {
      const std::size_t own =
          primitive.material == no_index ? materials.size() - 1 : static_cast<std::size_t>(primitive.material);
      const auto base_vertex = static_cast<std::int32_t>(s.vertex_count + positions.size());
      const auto base_index = static_cast<std::uint32_t>(s.index_count + all_indices.size());
      std::vector<std::uint32_t> indices = primitive.indices;
      for (const MeshChunk& chunk : cut_into_chunks(primitive.vertices, indices, chunk_triangles)) {
        s.chunks.push_back({base_index + chunk.first_index, chunk.index_count, base_vertex,
                            first_material + static_cast<std::uint32_t>(own), chunk.centre_m, chunk.half_extent_m});
        ++out.chunk_count;
        out.blended |= materials[own].alpha_mode == AlphaMode::blend;
      }
      for (const Vertex& vertex : primitive.vertices) {
        positions.push_back(vertex.position_m);
        attributes.push_back(pack_vertex(vertex));
      }
      all_indices.insert(all_indices.end(), indices.begin(), indices.end());
    }
    meshes.push_back(out);
  }
  append(s.position_buffer, s.vertex_count * sizeof(glm::vec3), positions.data(), positions.size() * sizeof(glm::vec3));
  append(s.attribute_buffer, s.vertex_count * sizeof(PackedVertex), attributes.data(),
         attributes.size() * sizeof(PackedVertex));
  append(s.index_buffer, s.index_count * sizeof(std::uint32_t), all_indices.data(),
         all_indices.size() * sizeof(std::uint32_t));
  s.vertex_count += positions.size();
  s.index_count += all_indices.size();
  for (const GLuint array : {GLuint{s.all_attributes}, GLuint{s.positions_only}}) {
    glVertexArrayVertexBuffer(array, 0, s.position_buffer.id, 0, sizeof(glm::vec3));
    glVertexArrayElementBuffer(array, s.index_buffer.id);
  }
  glVertexArrayVertexBuffer(s.all_attributes, 1, s.attribute_buffer.id, 0, sizeof(PackedVertex));
  s.models.push_back(std::move(meshes));
  return static_cast<std::uint32_t>(s.models.size() - 1);
}

bool scene_bounds(const GpuScene& scene, glm::vec3& minimum_m, glm::vec3& maximum_m) {
  minimum_m = glm::vec3(INFINITY);
  maximum_m = glm::vec3(-INFINITY);
  for (const SceneItem& item : scene.impl->items) {
    minimum_m = glm::min(minimum_m, item.centre_m - item.half_extent_m);
    maximum_m = glm::max(maximum_m, item.centre_m + item.half_extent_m);
  }
  return !scene.impl->items.empty();
}

bool has_blended(const GpuScene& scene, const Frame& frame) {
  return std::any_of(frame.instances.begin(), frame.instances.end(),
                     [&](const FrameInstance& i) { return scene.impl->models[i.model][i.mesh].blended; });
}

}  // namespace petrichor
