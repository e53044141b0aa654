#pragma once
// The loaded models on the GPU, shared by every pass that draws geometry (G-buffer, shadow and occlusion maps).

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/gpu/objects.hpp"
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

enum class DrawWhat { depth_only, opaque, blended };

// Draws the frame's instances that touch the frustum of clip_from_relative (camera-relative world -> clip),
// grouped by mesh and material and instanced. Binds vertex arrays, the instance buffer (INSTANCES_BINDING)
// and, unless depth_only, material textures and uniforms; the caller binds program, framebuffer and state.
// Vertex shaders include "systems/geometry/vertex.glsl". Returns triangles drawn.
std::uint64_t draw_instances(GpuScene&, const Frame&, const glm::mat4& clip_from_relative, DrawWhat);

}  // namespace petrichor
