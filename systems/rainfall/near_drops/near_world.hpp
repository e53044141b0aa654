#pragma once
// The surroundings of near drops: six faces at the camera, as a cube of radiance.

#include <cstdint>
#include <glm/glm.hpp>

#include "engine/gpu/objects.hpp"
#include "engine/gpu/shader.hpp"
#include "systems/frame.hpp"

namespace petrichor {

struct NearWorld {
  Texture cube;  // rgba16f, all levels: cd/m2, and 1 / distance of what is seen, 1/m
  Texture depth, albedo, normal, emissive;
  Framebuffer framebuffer;
  Buffer uniforms, lamps;
  int face_texels = 0;
  glm::i64vec3 cell{0};  // of the grid of places that captures are made at
  float step_m = 0.0f, exposure_ev100 = 0.0f;
  glm::dvec3 place_m{0.0};  // world
  bool captured = false, lit = false, shadows = false;
  std::uint64_t geometry_version = 0, lighting = 0;
  const GpuScene* scene = nullptr;
  std::uint64_t captures = 0, relights = 0;  // since start
};

struct NearWorldPrograms {
  const Program& surfaces;  // the G-buffer's, for all materials
  const Program& light;
};

// Captures again where the camera has come to another place of the grid of that step, or the geometry changed, or the
// exposure (materials without light are as bright as the picture's white); lights
// again where lamps or sky changed. Turning the camera does neither. The place is the grid's, not the camera's, so that
// a picture does not depend on the way that the camera came. shadow_atlas may be null.
void update_near_world(NearWorld&, const Frame&, int face_texels, float step_m, const Texture* shadow_atlas,
                       const NearWorldPrograms&);

}  // namespace petrichor
