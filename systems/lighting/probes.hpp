#pragma once
// Cube maps about objects (frame.mirrors->probes): captures on a grid of places, so that any frame finds the same, put
// together as seen from the object.

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "engine/gpu/objects.hpp"
#include "systems/lighting/capture.hpp"

namespace petrichor {

struct ProbeCorner {
  glm::i64vec3 cell;  // of the grid, y in sixteenths of a metre
  float weight;
};

// The one to four places of the grid about a place that its cube map is made of, and their shares, which sum to 1. In
// the middle half of a step two share. The height is rounded: an object climbs no stairs.
std::vector<ProbeCorner> probe_corners(const glm::dvec3& place_m, float step_m);
glm::dvec3 probe_corner_m(const glm::i64vec3& cell, float step_m);

// A capture depends on its place, on all instances but the object's own, on the lights and sky alone.
struct ProbeCapture {
  EnvironmentProbe faces;
  glm::i64vec3 cell{0};
  std::uint32_t entity = 0;
  std::uint64_t others = 0;  // hash of all instances but the object's own
  std::uint64_t last_used = 0;
};

struct Probes {
  std::vector<ProbeCapture> captures;
  std::uint64_t clock = 0;              // for the choice of the capture to drop; no picture depends on it
  std::uint64_t captured = 0, lit = 0;  // since start
  const GpuScene* scene = nullptr;
  float step_m = 0.0f;
  bool shadows = false;
  Buffer lights, block;
};

struct ProbePrograms {
  const Program& surfaces;
  const Program& light;
  const Program& filter;
  const Program& blend;
};

// Writes the layers of `target` (rgba16f array, ENVIRONMENT_WIDTH x ENVIRONMENT_HEIGHT) of the probes in view, and
// binds ProbesGpu.
void update_probes(Probes&, const Frame&, float step_m, const Texture* shadow_atlas, std::span<const int> shadow_slots,
                   const ProbePrograms&, const Texture& target);

}  // namespace petrichor
