#pragma once
// A street of boxes that shine evenly, with water on it and a pane in it, as a scene for the GPU and as rays for the
// CPU: where charts and tests of mirrors stand, so that the truth is exact.

#include <glm/glm.hpp>
#include <vector>

#include "engine/assets/model.hpp"
#include "systems/frame.hpp"
#include "systems/mirror/extract.hpp"
#include "systems/puddle_frame.hpp"

namespace petrichor {

struct ShiningBox {
  glm::vec3 low_m, high_m;
  glm::vec3 light_cd_m2;  // at most 30, or a capture cuts it
};

struct MirrorStreet {
  std::vector<ShiningBox> boxes;
  FrameSky sky;
  FramePuddles::Puddle puddle;  // level at y = 0
  MirrorPane pane;
};

// Ground, two rows of houses 5 m to either side with lit windows, dark posts, lamps without posts, a shop across the
// end (-z); a puddle 4 x 12 m about (0, 0, -6), a pane 4 x 2.4 m in the wall to the right.
MirrorStreet make_mirror_street();

// One mesh a box.
Model box_model(const std::vector<ShiningBox>&);

struct RayHit {
  glm::dvec3 light_cd_m2{0.0};
  double distance_m = 1e30;  // 1e30: the sky
};
// The nearest box from a place along a unit direction.
RayHit trace_street(const MirrorStreet&, const glm::dvec3& from_m, const glm::dvec3& direction);

// Mean over the GGX lobe of a surface about a mirrored ray: `samples` facets drawn from those that are seen (Heitz
// 2018, "Sampling the GGX Distribution of Visible Normals"), each weighed by what of it is not masked. view: unit, from
// the place to the eye.
glm::dvec3 trace_lobe(const MirrorStreet&, const glm::dvec3& place_m, const glm::dvec3& normal, const glm::dvec3& view,
                      double roughness, int samples);

}  // namespace petrichor
