#include "systems/mirror/camera.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace petrichor {
namespace {

constexpr float rim = 0.03f;  // of the drawn rectangle, over which its image fades
constexpr float pad = 0.07f;  // round what lies on the plane, for ripples and rough surfaces
static_assert(0.5f - 0.5f / MIRROR_GUARD > rim, "at the camera's own edges the image is whole");

}  // namespace

glm::dmat4 mirrored_clip(const FrameCamera& camera, double aspect, const FrameMirrors::Plane& plane) {
  const glm::dvec3 n(plane.normal);
  const double eye = plane.eye_m, guard = static_cast<double>(MIRROR_GUARD);
  glm::dmat4 mirror(1.0);  // x -> x - 2 (n.x + eye) n
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) mirror[column][row] -= 2.0 * n[row] * n[column];
  mirror[3] = glm::dvec4(-2.0 * eye * n, 1.0);
  const glm::dmat4 back = glm::mat4_cast(glm::normalize(glm::dquat(camera.orientation)));
  const double f = 1.0 / std::tan(0.5 * static_cast<double>(camera.vertical_fov_rad));
  glm::dmat4 projection(0.0);
  projection[0][0] = -f / (aspect * guard);  // turned left for right
  projection[1][1] = f / guard;
  projection[2][3] = -1.0;
  glm::dmat4 clip = projection * glm::transpose(back) * mirror;

  // Depth = w - a height: the plane itself is at depth 1. Infinity lies at 1 - a n.q, q a direction of unit depth; a is
  // as large as keeps that above 0 in all the picture, for precision.
  double steepest = 0.0;
  for (int i = 0; i < 4; ++i) {
    const glm::dvec4 q((i & 1 ? 1 : -1) * aspect * guard / f, (i & 2 ? 1 : -1) * guard / f, -1.0, 0.0);
    steepest = std::max(steepest, glm::dot(n, glm::dvec3(mirror * (back * q))));
  }
  const double a = 0.99 / std::max(steepest, 1e-3);
  const glm::dvec4 height(n, eye);
  for (int column = 0; column < 4; ++column) clip[column][2] = clip[column][3] - a * height[column];
  return clip;
}

glm::vec4 mirrored_rect(const FrameMirrors::Plane& plane) {
  const glm::vec2 low(-plane.high.x, plane.low.y), high(-plane.low.x, plane.high.y);
  const glm::vec2 from = glm::clamp(low / MIRROR_GUARD * 0.5f + 0.5f - pad, 0.0f, 1.0f);
  const glm::vec2 to = glm::clamp(high / MIRROR_GUARD * 0.5f + 0.5f + pad, 0.0f, 1.0f);
  return {from, to};
}

MirrorsGpu mirrors_of(const Frame& frame, const glm::ivec2& used, const glm::ivec2& texture, int levels) {
  MirrorsGpu gpu{};
  gpu.size = glm::vec4(used, texture);
  gpu.levels = {levels, 0, 0, 0};
  const float strength = frame.techniques.share(Effect::reflections, ReflectionRung::planar);
  const double aspect = static_cast<double>(std::max(frame.width, 1)) / std::max(frame.height, 1);
  const std::optional<FrameMirrors::Plane>* planes[MIRROR_PLANES] = {&frame.mirrors->water, &frame.mirrors->pane};
  for (int i = 0; i < MIRROR_PLANES; ++i) {
    MirrorGpu& out = gpu.planes[i];
    if (!*planes[i]) {  // share 0: the rest is not read, but must be finite
      out.picture_from_relative = out.relative_from_picture = glm::mat4(1.0f);
      continue;
    }
    const FrameMirrors::Plane& plane = **planes[i];
    const glm::dmat4 clip = mirrored_clip(frame.camera, aspect, plane);
    out.picture_from_relative = glm::mat4(clip);
    out.relative_from_picture = glm::mat4(glm::inverse(clip));
    out.plane = {plane.normal, plane.eye_m};
    out.rect = mirrored_rect(plane);
    const float texels_per_rad =
        0.5f * static_cast<float>(used.y) / (MIRROR_GUARD * std::tan(0.5f * frame.camera.vertical_fov_rad));
    out.more = {plane.share * strength, plane.tolerance_m, texels_per_rad, rim};
  }
  return gpu;
}

OnScreen on_screen(const glm::mat4& view_projection, std::span<const glm::vec3> corners) {
  std::vector<glm::vec4> polygon, next;
  for (const glm::vec3& corner : corners) polygon.push_back(view_projection * glm::vec4(corner, 1.0f));
  // Sutherland and Hodgman 1974, in clip space; the eye's own plane first.
  const glm::vec4 sides[5] = {{0, 0, -1, 1}, {1, 0, 0, 1}, {-1, 0, 0, 1}, {0, 1, 0, 1}, {0, -1, 0, 1}};
  for (const glm::vec4& side : sides) {
    next.clear();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const glm::vec4 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const float da = glm::dot(side, a), db = glm::dot(side, b);
      if (da >= 0.0f) next.push_back(a);
      if ((da >= 0.0f) != (db >= 0.0f)) next.push_back(glm::mix(a, b, da / (da - db)));
    }
    std::swap(polygon, next);
    if (polygon.empty()) return {};
  }
  OnScreen out;
  std::vector<glm::vec2> points;
  for (const glm::vec4& p : polygon) {
    points.push_back(glm::vec2(p) / std::max(p.w, 1e-6f));
    out.low = glm::min(out.low, points.back());
    out.high = glm::max(out.high, points.back());
  }
  float twice = 0.0f;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const glm::vec2 &a = points[i], &b = points[(i + 1) % points.size()];
    twice += a.x * b.y - a.y * b.x;
  }
  out.share = 0.125f * std::abs(twice);  // half of it, of the picture's 2 by 2
  out.low = glm::clamp(out.low, -1.0f, 1.0f);
  out.high = glm::clamp(out.high, -1.0f, 1.0f);
  return out;
}

}  // namespace petrichor
