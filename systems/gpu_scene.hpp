#pragma once
// The loaded models on the GPU, shared by every pass that draws geometry (G-buffer, shadow and occlusion maps).

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/gpu/objects.hpp"
#include "engine/gpu/shader.hpp"
#include "systems/frame.hpp"

namespace petrichor {

struct GpuScene {
  GpuScene();
  ~GpuScene();

  // Uploads; returns the model's index for MeshInstance::model. Textures get mip chains; colour textures are sRGB.
  std::uint32_t add(const Model&);

  struct Impl;
  std::unique_ptr<Impl> impl;
};

enum class DrawWhat {
  depth_only,  // what casts shadows: opaque and masked surfaces of instances with casts_shadow
  shelter,     // what stops rain: every surface, glass too
  opaque,      // opaque and masked, with materials
  blended,     // far to near, with materials
};

// What a material needs of its shader, so that no more is sampled than it has (software OpenGL pays for
// every lookup, and also for those in a branch not taken). `general` handles everything.
enum MaterialVariant : unsigned {
  variant_base_colour = 1,
  variant_surface = 2,  // metallic-roughness, perhaps with occlusion in its red
  variant_normal = 4,
  variant_emissive = 8,
  variant_general = 16,  // masked, two UV sets, differing transforms, occlusion or hollows by texture of their own
  material_variants = 17,
};

// Places the instances and the boxes that draw_instances culls relative to the frame's camera. FrameGpu::upload calls
// it; once a frame, before the first draw_instances, and again after a pass that drew from elsewhere.
void upload_instances(GpuScene&, const Frame&);

// Draws the frame's instances that touch the frustum of clip_from_relative (camera-relative world -> clip, depth
// 0..1), grouped by mesh and material and instanced. Binds vertex arrays and, for opaque and blended, material
// textures and uniforms; sets glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE), glFrontFace and,
// with materials, GL_CULL_FACE. The caller binds program, framebuffer and depth state.
// by_variant: material_variants programs, of which each batch uses its own; empty: the bound program draws all.
// Vertex shaders include "systems/geometry/vertex.glsl". Returns triangles drawn.
std::uint64_t draw_instances(GpuScene&, const Frame&, const glm::mat4& clip_from_relative, DrawWhat,
                             std::span<const Program* const> by_variant = {});

// Box around all instances, relative to the camera of the last upload_instances; false where there is none.
bool scene_bounds(const GpuScene&, glm::vec3& minimum_m, glm::vec3& maximum_m);

// Whether any instance has a blended surface.
bool has_blended(const GpuScene&, const Frame&);

}  // namespace petrichor
