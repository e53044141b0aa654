// What a surface does with light: GGX and Lambert, one text for C++ (tests, truths) and GLSL.
//
// Sources: GGX and Smith, Walter et al. 2007, "Microfacet Models for Refraction through Rough Surfaces";
// height-correlated visibility, Heitz 2014, JCGT 3(2); the lens-shaped correction of Schlick's Fresnel for
// dielectrics, shared physics section 3; sphere lights, Karis 2013, "Real Shading in Unreal Engine 4"; the
// directional albedo of GGX, Karis 2014, "Physically Based Shading on Mobile" (after Lazarov).
#ifndef SYSTEMS_BRDF_H
#define SYSTEMS_BRDF_H

#ifdef __cplusplus
#include <glm/glm.hpp>
#define SHADING_FN inline
namespace petrichor::shading {
using glm::clamp, glm::dot, glm::exp2, glm::inversesqrt, glm::length, glm::max, glm::min, glm::mix, glm::normalize,
    glm::reflect, glm::sqrt, glm::vec2, glm::vec3, glm::vec4;
#else
#define SHADING_FN
#endif

const float PI = 3.14159265358979f;
const float DIELECTRIC_F0 = 0.04f;  // n = 1.5: paint, stone, plastic
const float FILM_F0 = 0.0200f;      // n = 1.33: water on them

// Density of microfacets along the half vector, 1/sr. a2 = alpha^2, alpha = perceptual roughness squared.
SHADING_FN float ggx_distribution(float n_dot_h, float a2) {
  float d = n_dot_h * n_dot_h * (a2 - 1.0f) + 1.0f;
  return a2 / (PI * d * d);
}

// G2 / (4 n.l n.v), height-correlated.
SHADING_FN float smith_visibility(float n_dot_l, float n_dot_v, float a2) {
  float l = n_dot_v * sqrt(n_dot_l * n_dot_l * (1.0f - a2) + a2);
  float v = n_dot_l * sqrt(n_dot_v * n_dot_v * (1.0f - a2) + a2);
  return 0.5f / max(l + v, 1e-6f);
}

// Reflectance at an angle whose cosine to the facet is c. Schlick is up to 0.06 too high near 84 degrees for
// water and glass; the second term takes that away (error below 0.011; the published power 9.41 is drawn as 9.5,
// which is a square root). dielectric: 1, metals: 0.
SHADING_FN vec3 fresnel(vec3 f0, float c, float dielectric) {
  float m = 1.0f - c;
  float m2 = m * m;
  float m4 = m2 * m2;
  float correction = dielectric * 1.611f * c * m4 * m4 * m * sqrt(max(m, 0.0f));
  return max(f0 + (vec3(1.0f) - f0) * (m4 * m) - vec3(correction), vec3(0.0f));
}

// Share of light from everywhere that GGX reflects towards the viewer (directional albedo): f0 * x + y. y is Karis'
// fit. x + y, of a surface whose facets are perfect mirrors, is 1 less what single scattering loses; Karis' is 0.19
// too low, so here is a fit of our own to quadrature (within 0.09 for roughness and n.v from 0.1 to 1).
SHADING_FN vec2 ggx_albedo(float roughness, float n_dot_v) {
  vec2 r = roughness * vec2(-1.0f, -0.0275f) + vec2(1.0f, 0.0425f);
  float y = 1.04f * (min(r.x * r.x, exp2(-9.28f * n_dot_v)) * r.x + r.y) + 0.022f * roughness - 0.04f;
  float r2 = roughness * roughness;
  float lost = r2 * (1.861f - 3.1143f * n_dot_v + roughness * (7.9318f * n_dot_v - 3.3367f) +
                     r2 * (1.7537f - 4.3554f * n_dot_v));
  return vec2(1.0f - lost - y, y);
}

// KHR_lights_punctual: saturate(cos * scale + offset)^2, scale = 1 / max(0.001, cos inner - cos outer).
SHADING_FN float spot_attenuation(float cosine, float scale, float offset) {
  float x = clamp(cosine * scale + offset, 0.0f, 1.0f);
  return x * x;
}

// 1/d^2 with the glTF window that reaches 0 at the range: saturate(1 - (d/range)^4). d2 is the squared distance.
SHADING_FN float distance_attenuation(float d2, float range) {
  float q = d2 / (range * range);
  return clamp(1.0f - q * q, 0.0f, 1.0f) / max(d2, 1e-4f);
}

// The point of a sphere light that the mirror direction r comes nearest to (Karis 2013), unnormalised, seen from
// the surface. to_light: to the sphere's centre.
SHADING_FN vec3 sphere_light_point(vec3 to_light, vec3 r, float radius) {
  vec3 centre_to_ray = dot(to_light, r) * r - to_light;
  float reach = radius * inversesqrt(max(dot(centre_to_ray, centre_to_ray), 1e-12f));
  return to_light + centre_to_ray * min(reach, 1.0f);
}

// What a sphere light does to the lobe: x its widened alpha, y the factor that keeps its energy.
SHADING_FN vec2 sphere_light_lobe(float alpha, float radius, float inverse_distance) {
  float wide = min(alpha + 0.5f * radius * inverse_distance, 1.0f);
  float ratio = alpha / wide;
  return vec2(wide, ratio * ratio);
}

#ifdef __cplusplus
}  // namespace petrichor::shading
#endif
#endif
