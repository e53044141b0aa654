// Light of a lamp that mist scatters into the view, single scattering, for C++ (tests) and GLSL.
//
// Equiangular substitution (Kulla and Fajardo 2012, "Importance Sampling Techniques for Path Tracing in
// Participating Media"; shared physics section 4): along the view ray x = c + h tan(eta), where c is the
// distance to the point nearest to the lamp and h its distance from the lamp. The 1/d^2 of the lamp then cancels
// and Gauss-Legendre converges at once. The difference of the two end angles is one atan of two products, which
// keeps its digits where the plain difference of two atans loses them all.
#ifndef SYSTEMS_ATMOSPHERE_AIRLIGHT_H
#define SYSTEMS_ATMOSPHERE_AIRLIGHT_H

#ifdef __cplusplus
#include <cmath>
#include <glm/glm.hpp>
#define AIRLIGHT_FN inline
namespace petrichor::airlight {
using glm::abs, glm::cos, glm::cross, glm::dot, glm::exp, glm::inversesqrt, glm::length, glm::max, glm::min, glm::sin,
    glm::sqrt, glm::vec2, glm::vec3, glm::vec4;
inline float atan(float y, float x) {
  return std::atan2(y, x);
}
#else
#define AIRLIGHT_FN
#endif

// Share of light scattered by an angle with this cosine, 1/sr (Henyey and Greenstein 1941). q: mean cosine.
AIRLIGHT_FN float phase_hg(float cosine, float q) {
  float s = inversesqrt(max(1.0f + q * q - 2.0f * q * cosine, 1e-8f));
  return (1.0f - q * q) * 0.0795774715f * s * s * s;
}

// Where a ray from the origin runs inside a cone: x in [result.x, result.y], empty where y <= x.
// apex relative to the origin; axis and ray unit; cosine of the half angle in (0, 1); the ray ends at `reach`.
AIRLIGHT_FN vec2 ray_in_cone(vec3 apex, vec3 axis, float cosine, vec3 ray, float reach) {
  float od = -dot(apex, axis);
  float rd = dot(ray, axis);
  float k2 = cosine * cosine;
  float a = rd * rd - k2;
  float b = od * rd + k2 * dot(apex, ray);
  float c = od * od - k2 * dot(apex, apex);
  a = abs(a) < 1e-6f ? (a < 0.0f ? -1e-6f : 1e-6f) : a;
  float discriminant = b * b - a * c;
  float root = sqrt(max(discriminant, 0.0f));
  float x1 = min((-b - root) / a, (-b + root) / a);
  float x2 = max((-b - root) / a, (-b + root) / a);
  // a > 0: the ray is steeper than the cone and stays inside from one root on. a < 0: it crosses, between the roots.
  bool steep = a > 0.0f;
  float from = steep ? (rd > 0.0f ? x2 : -1e9f) : x1;
  float to = steep ? (rd > 0.0f ? 1e9f : x1) : x2;
  // The roots of a crossing ray both lie on the cone itself or both on its mirror image behind the lamp.
  bool outside = !steep && (discriminant <= 0.0f || od + 0.5f * (x1 + x2) * rd < 0.0f);
  return outside ? vec2(0.0f, 0.0f) : vec2(max(from, 0.0f), min(to, reach));
}

// Nodes and weights of Gauss-Legendre on [-1, 1], five points.
#define AIRLIGHT_POINTS 5
AIRLIGHT_FN vec2 gauss_point(int i) {
  if (i == 0) return vec2(-0.9061798459f, 0.2369268851f);
  if (i == 1) return vec2(-0.5384693101f, 0.4786286705f);
  if (i == 2) return vec2(0.0f, 0.5688888889f);
  if (i == 3) return vec2(0.5384693101f, 0.4786286705f);
  return vec2(0.9061798459f, 0.2369268851f);
}

// The angles of a stretch [from, to] of the ray: x the first, y their difference.
AIRLIGHT_FN vec2 airlight_angles(float c, float h, float from, float to) {
  return vec2(atan(from - c, h), atan(h * (to - from), h * h + (from - c) * (to - c)));
}

// Metres lamp -> mist -> eye at one angle: x + h / cos(eta), with x = c + h tan(eta).
AIRLIGHT_FN float airlight_path(float sine, float cosine, float c, float h) {
  return max(c + h * (1.0f + sine) / max(cosine, 1e-4f), 0.0f);
}

// Radiance per candela of an even lamp over the stretch [from, to]. scattering in 1/m.
AIRLIGHT_FN float airlight(float c, float h, float from, float to, float scattering, float extinction, float q) {
  vec2 angles = airlight_angles(c, h, from, to);
  float sum = 0.0f;
  for (int i = 0; i < AIRLIGHT_POINTS; ++i) {
    vec2 point = gauss_point(i);
    float eta = angles.x + angles.y * 0.5f * (1.0f + point.x);
    float sine = sin(eta);  // minus the cosine of the scattering angle
    sum += point.y * phase_hg(-sine, q) * exp(-extinction * airlight_path(sine, cos(eta), c, h));
  }
  return sum * 0.5f * angles.y * scattering / h;
}

#ifdef __cplusplus
}  // namespace petrichor::airlight
#endif
#endif
