#pragma once
// Where an orthographic depth map of the scene lies, seen from where the precipitation comes from.

#include <glm/glm.hpp>

namespace petrichor {

// Where a map lies: a square prism along `fall`, in the world. Equal placements show the same picture.
struct OcclusionPlacement {
  glm::vec3 fall{0.0f, -1.0f, 0.0f};  // unit, the way the precipitation moves
  glm::dvec3 corner_m{0.0};           // world position of texture (0, 0) at the upper end
  glm::vec3 right{1.0f, 0.0f, 0.0f};  // unit, along texture x
  glm::vec3 up{0.0f, 0.0f, -1.0f};    // unit, along texture y; right x up = -fall
  float side_m = 128.0f;
  float depth_m = 100.0f;  // from the upper end to the lower
  int texels = 1024;
  friend bool operator==(const OcclusionPlacement&, const OcclusionPlacement&) = default;
};

// A map around a camera. The direction is the given one; the corner is snapped to a lattice of step_m that is fixed in
// the world, so a moving camera keeps the same texels until it has gone step_m. low and high: what the map must hold
// along the fall (the scene's box, relative to the camera). shift_m moves the lattice along right and up: several maps,
// each shifted by a share of the step and of a texel, step one after another and put their texels' edges elsewhere.
OcclusionPlacement place_occlusion_map(const glm::dvec3& camera_m, const glm::vec3& fall, float side_m, int texels,
                                       float step_m, const glm::vec3& low_m, const glm::vec3& high_m,
                                       const glm::dvec2& shift_m = glm::dvec2(0.0));

// Camera-relative world -> texture coordinates x, y in 0..1 and metres along the fall from the upper end.
glm::mat4 occlusion_matrix(const OcclusionPlacement&, const glm::dvec3& camera_m);
// Camera-relative world -> clip space, depth 1 at the upper end and 0 at the lower.
glm::mat4 occlusion_clip(const OcclusionPlacement&, const glm::dvec3& camera_m);

// The direction that the map is drawn along: a fixed lattice point at most tolerance_rad from `fall`, so that gusts do
// not redraw the map in every frame. No memory: a frame looks the same whichever frames came before. Straight down,
// and the lattice, are exact for still air.
glm::vec3 lattice_direction(const glm::vec3& fall, float tolerance_rad);

}  // namespace petrichor
