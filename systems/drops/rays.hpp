#pragma once
// Rays through places of the picture, one metre deep along the camera's axis, in world axes: corner + x right + y up.

#include <glm/glm.hpp>

#include "engine/gpu/shader.hpp"
#include "systems/frame_shared.h"

namespace petrichor {

struct ViewRays {
  glm::vec3 corner, right, up;
};
// The whole picture is `across` x `along` units: pixels, or 1 x 1.
inline ViewRays view_rays(const FrameUniforms& u, int across = 1, int along = 1) {
  const float tall = u.lens.x, wide = tall * u.lens.y;
  const glm::mat3 to_world = glm::transpose(glm::mat3(u.view));
  return {to_world * glm::vec3(-wide, -tall, -1.0f),
          to_world * glm::vec3(2.0f * wide / static_cast<float>(across), 0.0f, 0.0f),
          to_world * glm::vec3(0.0f, 2.0f * tall / static_cast<float>(along), 0.0f)};
}
// Uniforms ray_corner, ray_x, ray_y; the program must be in use.
inline void set_rays(const Program& program, const ViewRays& rays) {
  program.set("ray_corner", rays.corner);
  program.set("ray_x", rays.right);
  program.set("ray_y", rays.up);
}

}  // namespace petrichor
