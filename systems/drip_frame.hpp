#pragma once
// The drips of one frame. Filled by systems/drip; splashes and ripples read the landings.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace petrichor {

// A drop in the air, or hanging.
struct FrameDrip {
  glm::dvec3 place_m;        // world, middle of the drop when the shutter closes
  glm::vec3 velocity_mps;    // the mean while the shutter is open; 0: it hangs
  float diameter_mm;         // of the sphere of its volume
  float stretch;             // height over width of its shape
  std::uint32_t seed;        // of its looks
  std::uint16_t source = 0;  // of FrameDrips::sources
  std::uint16_t cluster = 0;
};

// A drop that has landed within the last landing_memory_s.
struct DripLanding {
  glm::dvec3 place_m;  // world, on the surface
  double time_s;       // when
  float diameter_mm;
  glm::vec3 velocity_mps;  // at the impact
  std::uint32_t seed;
};
constexpr double landing_memory_s = 1.0;

// How billboards of a source look: DripSource says what is what.
struct DripLooks {
  float opacity = 1.0f, edge_strength = 0.5f, edge_bias = 0.95f, elongation = 1.0f;
  bool published = false;
};

// Drops that are lit by the same lamps.
struct DripCluster {
  glm::dvec3 centre_m;
  float radius_m;
};

struct FrameDrips {
  std::vector<FrameDrip> drops;  // that the view may see
  std::vector<DripLooks> sources;
  std::vector<DripCluster> clusters;
  std::vector<DripLanding> landings;  // near the camera, seen or not; by time, the oldest first
  float reach_m = 0.0f;               // out to where drops are drawn
  float shows_world_px = 0.5f;        // radius of its image above which the refracting rung shows the world in a drop
};

}  // namespace petrichor
