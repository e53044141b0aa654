#pragma once
// The half-spaces of a clip matrix (Gribb and Hartmann 2001), for depth in 0..1.

#include <array>
#include <glm/glm.hpp>

namespace petrichor {

struct Frustum {
  std::array<glm::vec4, 6> planes;  // xyz inwards, not normalised; a point is inside where dot(plane, (p,1)) >= 0
};

inline Frustum frustum_of(const glm::mat4& clip) {
  const glm::mat4 rows = glm::transpose(clip);
  // With an infinite far plane one of the last two is (0, 0, 0, near): everything is inside it.
  return {{rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1], rows[2], rows[3] - rows[2]}};
}

// False only where the box surely lies outside.
inline bool box_touches(const Frustum& f, const glm::vec3& centre, const glm::vec3& half_extent) {
  for (const glm::vec4& p : f.planes) {
    const glm::vec3 n(p);
    if (glm::dot(n, centre) + p.w + glm::dot(glm::abs(n), half_extent) < 0.0f) return false;
  }
  return true;
}

inline bool sphere_touches(const Frustum& f, const glm::vec3& centre, float radius) {
  for (const glm::vec4& p : f.planes) {
    const glm::vec3 n(p);
    if (glm::dot(n, centre) + p.w < -radius * glm::length(n)) return false;
  }
  return true;
}

}  // namespace petrichor
