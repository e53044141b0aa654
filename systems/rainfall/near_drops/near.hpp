#pragma once
// Near drops (Rana, "Rain: Graphical Rendering"): drops wide enough to resolve show the world refracted and reflected.
// Here: which drops those are, the curve that stands for his maps, and the truth.

#include <functional>
#include <glm/glm.hpp>
#include <vector>

#include "engine/ecs/registry.hpp"
#include "systems/frame.hpp"
#include "systems/drops/layers.hpp"
#include "systems/rainfall/near_drops/near_shared.h"

namespace petrichor {

struct NearChoice {
  float share = 0.0f;       // of the field's drops near the eye that show the world; 0: none
  float maps_share = 0.0f;  // of those, by maps
  float least_width_px = 1.0f;
  float least_distance_m = 0.0f, half_cube_m = 1e6f;
  double expected = 0.0;  // drops whose ways touch the view, on average, or somewhat more
};
// The least width is that asked for, or as much more as keeps to the most drops; so it does not depend on luck. Those
// that are less wide the field draws.
NearChoice near_choice(const Frame&);
// near_choice of near_choice.glsl; all zero where nobody draws near drops.
glm::vec4 near_uniform(const NearChoice&);

// The cells of the field that may hold such drops.
RainLayers near_layers(const Frame&, const NearChoice&);

// near_optics.glsl's curve: NEAR_CURVE + 1 rows of deviation and shares.
std::vector<glm::vec4> make_near_curve();

// What a unit ray from a place sees, cd/m2.
using World = std::function<glm::dvec3(const glm::dvec3& place, const glm::dvec3& direction)>;

// The truth: the radiance that a sphere of that radius about `centre` shows to the eye along a ray that leaves `eye`
// for the point of the disc at `offset` (unit disc, right and up as given), with up to that many interactions of ray
// and surface, Fresnel for either polarisation. Rays start where they leave the sphere.
glm::dvec3 traced_drop(const World&, const glm::dvec3& eye, const glm::dvec3& centre, double radius_m,
                       const glm::dvec3& right, const glm::dvec3& up, const glm::dvec2& offset, int interactions);

void extract_near_drops(const Registry&, Frame&);

}  // namespace petrichor
