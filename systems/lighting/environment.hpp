#pragma once
// Captures of the surroundings, on a grid of places near the camera.

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "engine/gpu/objects.hpp"
#include "systems/frame.hpp"
#include "systems/lighting/capture.hpp"

namespace petrichor {

struct EnvironmentCorner {
  glm::ivec3 cell;
  float weight;
};

struct Environment {
  std::vector<EnvironmentProbe> probes;
  std::uint64_t geometry_version = 0;
  const GpuScene* scene = nullptr;
  bool shadows = false;
  std::uint64_t clock = 0;     // for the choice of the probe to drop; no picture depends on it
  std::uint64_t captures = 0;  // since start
  Buffer lights;
};

// The one to four grid places round a camera position and their shares, which sum to 1. Near a place it has all.
std::vector<EnvironmentCorner> environment_corners(const glm::dvec3& camera_m, float spacing_m);
glm::dvec3 environment_place_m(const glm::ivec3& cell, float spacing_m);

// Writes `target` (rgba16f, ENVIRONMENT_WIDTH x ENVIRONMENT_HEIGHT). shadow_atlas may be null; shadow_slots as for
// choose_lights.
void update_environment(Environment&, const Frame&, float spacing_m, const Texture* shadow_atlas,
                        std::span<const int> shadow_slots, const EnvironmentPrograms&, const Texture& target);

}  // namespace petrichor
