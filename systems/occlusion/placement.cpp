#include "systems/occlusion/placement.hpp"

#include <cmath>

namespace petrichor {
namespace {

// Metres to the lattice on which the map's ends lie, so that rounding of the scene's box does not move them.
constexpr double end_step_m = 8.0;
constexpr double end_margin_m = 1.37;  // no round number: roofs and floors are often at whole metres

}  // namespace

glm::vec3 lattice_direction(const glm::vec3& fall, float tolerance_rad) {
  const float length = glm::length(fall);
  if (!(length > 0.0f)) return {0.0f, -1.0f, 0.0f};
  const glm::vec3 d = fall / length;
  // Tilt as a flat vector: its length is the angle from straight down. Half a cell's diagonal is the tolerance.
  const float sine = std::hypot(d.x, d.z);
  const float angle = std::atan2(sine, -d.y);
  glm::vec2 tilt = sine > 1e-9f ? glm::vec2(d.x, d.z) / sine * angle : glm::vec2(0.0f);
  if (tolerance_rad > 0.0f) tilt = glm::round(tilt / (1.41421356f * tolerance_rad)) * (1.41421356f * tolerance_rad);
  const float snapped = glm::length(tilt);
  if (snapped < 1e-9f) return {0.0f, -1.0f, 0.0f};
  const glm::vec2 way = tilt / snapped * std::sin(snapped);
  return {way.x, -std::cos(snapped), way.y};
}

OcclusionPlacement place_occlusion_map(const glm::dvec3& camera_m, const glm::vec3& fall, float side_m, int texels,
                                       float step_m, const glm::vec3& low_m, const glm::vec3& high_m,
                                       const glm::dvec2& shift_m) {
  OcclusionPlacement p;
  p.fall = fall;
  p.side_m = side_m;
  p.texels = texels;
  // Along x as far as the fall lets it; falling along x itself, along z.
  const glm::vec3 reference = std::abs(fall.x) < 0.9f ? glm::vec3(1.0f, 0.0f, 0.0f) : glm::vec3(0.0f, 0.0f, 1.0f);
  p.right = glm::normalize(reference - fall * glm::dot(reference, fall));
  p.up = glm::cross(-p.fall, p.right);

  // Whole texels, so that what is redrawn falls on the same samples.
  const double texel = static_cast<double>(side_m) / texels;
  const double step = std::max(1.0, std::round(step_m / texel)) * texel;
  const auto snapped = [&](const glm::vec3& axis, double shift) {
    return std::round((glm::dot(camera_m, glm::dvec3(axis)) - shift) / step) * step + shift - 0.5 * side_m;
  };
  const glm::dvec3 centre = glm::dvec3(0.5f * (low_m + high_m)) + camera_m;
  const double reach = glm::dot(glm::dvec3(0.5f * (high_m - low_m)), glm::abs(glm::dvec3(fall)));
  const double middle = glm::dot(centre, glm::dvec3(fall));
  const double upper = std::floor((middle - reach - end_margin_m) / end_step_m) * end_step_m;
  const double lower = std::ceil((middle + reach + end_margin_m) / end_step_m) * end_step_m;
  p.depth_m = static_cast<float>(lower - upper);
  p.corner_m = glm::dvec3(p.right) * snapped(p.right, shift_m.x) + glm::dvec3(p.up) * snapped(p.up, shift_m.y) +
               glm::dvec3(p.fall) * upper;
  return p;
}

// Chen's Ms Mp Mv Mm V (Snow Accumulation and Generation, step 2), for V already in the world: the view from where the
// snow comes from, its orthographic projection, and the scaling to texture coordinates, in one matrix.
glm::mat4 occlusion_matrix(const OcclusionPlacement& p, const glm::dvec3& camera_m) {
  const glm::dvec3 origin = camera_m - p.corner_m;
  const glm::dvec3 right = glm::dvec3(p.right) / static_cast<double>(p.side_m);
  const glm::dvec3 up = glm::dvec3(p.up) / static_cast<double>(p.side_m);
  const glm::dvec3 fall(p.fall);
  glm::dmat4 rows(1.0);
  rows[0] = glm::dvec4(right, glm::dot(right, origin));
  rows[1] = glm::dvec4(up, glm::dot(up, origin));
  rows[2] = glm::dvec4(fall, glm::dot(fall, origin));
  return glm::mat4(glm::transpose(rows));
}

glm::mat4 occlusion_clip(const OcclusionPlacement& p, const glm::dvec3& camera_m) {
  glm::mat4 clip_from_map(1.0f);
  clip_from_map[0][0] = clip_from_map[1][1] = 2.0f;
  clip_from_map[2][2] = -1.0f / p.depth_m;
  clip_from_map[3] = {-1.0f, -1.0f, 1.0f, 1.0f};
  return clip_from_map * occlusion_matrix(p, camera_m);
}

}  // namespace petrichor
