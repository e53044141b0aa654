// The streak of a reflector: what share of the GGX lobe a rectangle covers, in closed form. One text for C++ (tests,
// charts) and GLSL.
//
// A mirrored direction l stands for one microfacet, h = (l + v) / |l + v|, and so for one slope h_xy / h_z. GGX scatters
// slopes by P(m) = 1 / (pi a^2 (1 + m^2 / a^2)^2) (Walter et al. 2007, in slopes: Heitz 2014). With m in units of a that
// is the form factor, from a facet at unit distance, of a plane parallel to it; so what falls in a polygon of slopes is
// Lambert's sum over its edges (Lambert 1760; Baum et al. 1989, "Improving Radiosity Solutions Through the Use of
// Analytically Determined Form-Factors"). The elongation 1 / sin(elevation), its saturation, the shift of the peak and
// the tail (physics 10a) all come from the map between l and m; none is fitted.
#ifndef SYSTEMS_REFLECTION_STREAK_H
#define SYSTEMS_REFLECTION_STREAK_H
#include "systems/brdf.h"

#ifdef __cplusplus
namespace petrichor::shading {
using glm::abs, glm::atan, glm::cross, glm::pow, glm::smoothstep;
#endif

// How far a surface mirrors single things: those rougher than 0.6 show but a glow, which the captured surroundings and
// the lamps' own highlights give. 0 to 1.
SHADING_FN float mirror_share(float roughness) { return 1.0f - smoothstep(0.45f, 0.6f, roughness); }

// alpha^2 of a surface whose normals' mean over a pixel is shorter than 1: the slopes' variance along either axis is
// about 1 - |mean|, and GGX's alpha^2 holds twice that, as Beckmann's does (Toksvig 2005; the bound: Tokuyoshi and
// Kaplanyan 2019, "Improved Geometric Specular Antialiasing").
SHADING_FN float widened_alpha2(float alpha2, float mean_length) {
  return alpha2 + min(2.0f * (1.0f - min(mean_length, 1.0f)), 0.18f);
}

// One edge's part of the vector form factor, times 2 pi.
SHADING_FN vec3 lobe_edge(vec2 a, vec2 b) {
  vec3 va = vec3(a.x, a.y, 1.0f), vb = vec3(b.x, b.y, 1.0f);
  vec3 c = cross(va, vb);
  float s = length(c);
  return c * (s > 1e-9f ? atan(s, dot(va, vb)) / s : 0.0f);
}

// Of the facets whose slope, in units of alpha, lies in the quadrilateral abcd: z their share of all, 0 to 1; xy their
// mean slope (the vector form factor is the integral of directions, whose x / z is the slope).
SHADING_FN vec3 lobe_part(vec2 a, vec2 b, vec2 c, vec2 d) {
  vec2 p = c - a, q = d - b;
  float area = 0.5f * abs(p.x * q.y - p.y * q.x);
  vec2 middle = 0.25f * (a + b + c + d);
  float r = 1.0f + dot(middle, middle);
  // The sum over edges of a small one is all rounding.
  bool small = area < 2e-3f * r && dot(p, p) + dot(q, q) < 0.2f * r;
  vec3 sum = lobe_edge(a, b) + lobe_edge(b, c) + lobe_edge(c, d) + lobe_edge(d, a);
  float z = abs(sum.z) > 1e-9f ? sum.z : 1e-9f;
  float share = small ? area / (PI * r * r) : abs(sum.z) / (2.0f * PI);
  vec2 mean = small ? middle : vec2(sum.x / z, sum.y / z);
  return vec3(mean.x, mean.y, min(share, 1.0f));
}

// Slope of the microfacet about n that mirrors l to v, in the axes t and b. l is lifted to the horizon: the part of a
// reflector below it is not seen.
SHADING_FN vec2 facet_slope(vec3 l, vec3 v, vec3 n, vec3 t, vec3 b) {
  vec3 h = l + n * max(0.002f - dot(l, n), 0.0f);
  h = normalize(h) + v;
  float up = max(dot(h, n), 1e-3f);
  return vec2(dot(h, t), dot(h, b)) / up;
}

// The part of a rectangle, -1 to 1 along half its width `across`, that a lobe can meet. At grazing angles a wide edge is
// bent in the space of slopes, so that its corners alone would miss the lobe; within 3 alpha, which leave out 5 % of the
// lobe, it is nearly straight. to: to its middle.
SHADING_FN vec2 lobe_window(vec3 to, vec3 across, vec3 up, vec3 mirror, float alpha, float n_dot_v) {
  vec3 facing = cross(across, up);
  float along = dot(facing, mirror);
  float t = dot(facing, to) / (abs(along) > 1e-9f ? along : 1e-9f);
  float width = dot(across, across), far = length(to);
  vec3 met = mirror * (t > 0.0f ? min(t, 4.0f * far) : 4.0f * far) - to;  // where the mirrored ray is in its plane
  float u = dot(met, across) / width, inside = clamp(u, -1.0f, 1.0f);
  float reach = 6.0f * alpha * max(n_dot_v, 0.02f) * length(to + across * inside) / sqrt(width) + abs(u - inside);
  return vec2(max(inside - reach, -1.0f), min(inside + reach, 1.0f));
}

// What a bent edge's ends move by so that the straight one between them has the same mean (Simpson's rule).
SHADING_FN vec2 straightened(vec2 a, vec2 b, vec2 middle) { return (middle - 0.5f * (a + b)) * (2.0f / 3.0f); }

// What the facet of a slope passes on, besides its Fresnel term: G2 (v.h) / ((n.v)(n.h)), whose mean over the facets is
// the directional albedo with every facet a mirror. x the factor, y v.h. slope: true, in the axes of local.
SHADING_FN vec2 facet_weight(vec2 slope, vec3 v_local, float a2) {
  vec3 h = normalize(vec3(slope.x, slope.y, 1.0f));
  float v_dot_h = clamp(dot(h, v_local), 0.0f, 1.0f);
  vec3 l = h * (2.0f * v_dot_h) - v_local;
  float n_dot_l = max(l.z, 0.0f), n_dot_v = max(v_local.z, 0.004f);
  float g = 4.0f * n_dot_l * n_dot_v * smith_visibility(n_dot_l, n_dot_v, a2);
  return vec2(g * v_dot_h / (n_dot_v * h.z), v_dot_h);
}

// ToyShop's edge attenuation (Tatarchuk and Isidoro 2006, section 6.3): f = (1 - n.v)^f_o, k_a = saturate(1 - f^2).
// It takes away what is mirrored at grazing angles, where wet ground mirrors most (physics 3); kept as published.
SHADING_FN float edge_attenuation(float n_dot_v, float f_o) {
  float f = pow(clamp(1.0f - n_dot_v, 0.0f, 1.0f), f_o);
  return clamp(1.0f - f * f, 0.0f, 1.0f);
}

#ifdef __cplusplus
}  // namespace petrichor::shading
#endif
#endif
