// What a pixel mirrors of the panels and posts near it, in closed form (systems/reflection/streak.h).
#ifndef SYSTEMS_REFLECTION_STAND_INS_GLSL
#define SYSTEMS_REFLECTION_STAND_INS_GLSL
#include "systems/lighting/facing.glsl"
#include "systems/reflection/reflection_shared.h"
#include "systems/reflection/streak.h"

layout(std140, binding = REFLECTORS_BINDING) uniform ReflectorsBlock { ReflectorsGpu reflectors; };

struct Lobe {  // the axes of a pixel's microfacets
  vec3 t, b;      // t in the plane of incidence
  vec3 v_local;   // the view in t, b, normal
  vec3 reflected; // directional albedo
};

Lobe lobe_of(Facing at, float roughness) {
  Lobe lobe;
  vec3 flat_view = at.view - at.normal * dot(at.view, at.normal);
  vec3 other = abs(at.normal.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0);
  vec3 aside = cross(at.normal, dot(flat_view, flat_view) > 1e-6 ? flat_view : other);
  lobe.b = normalize(aside);
  lobe.t = cross(lobe.b, at.normal);
  lobe.v_local = vec3(dot(at.view, lobe.t), 0.0, max(dot(at.view, at.normal), 0.004));
  lobe.reflected = max(mirrored_share(at, roughness), vec3(1e-3));
  return lobe;
}

// Half the rectangle's width as it turns to a viewer at -to.
vec3 turned_across(ReflectorGpu q, vec3 to) {
  if (q.centre_kind.w == float(REFLECTOR_PANEL)) return q.across_seen.xyz;
  return normalize(cross(q.up_reach.xyz, to) + vec3(1e-7, 0.0, 0.0)) * length(q.across_seen.xyz);
}

// Share of what this pixel mirrors that comes from the rectangle, rgb (Fresnel's term may differ among them).
vec3 mirrored_of(ReflectorGpu q, Facing at, Lobe lobe) {
  vec3 to = q.centre_kind.xyz - at.place;
  vec3 across = turned_across(q, to), up = q.up_reach.xyz;
  bool behind = q.centre_kind.w == float(REFLECTOR_PANEL) && dot(cross(across, up), to) >= 0.0;
  float per_alpha = 1.0 / at.alpha;
  vec2 cut = lobe_window(to, across, up, at.mirror, at.alpha, lobe.v_local.z);
  vec3 left = to + across * cut.x, right = to + across * cut.y;
  vec2 m0 = facet_slope(left - up, at.view, at.normal, lobe.t, lobe.b) * per_alpha;
  vec2 m1 = facet_slope(right - up, at.view, at.normal, lobe.t, lobe.b) * per_alpha;
  vec2 m2 = facet_slope(right + up, at.view, at.normal, lobe.t, lobe.b) * per_alpha;
  vec2 m3 = facet_slope(left + up, at.view, at.normal, lobe.t, lobe.b) * per_alpha;
  vec3 between = 0.5 * (left + right);
  vec2 low = straightened(m0, m1, facet_slope(between - up, at.view, at.normal, lobe.t, lobe.b) * per_alpha);
  vec2 high = straightened(m3, m2, facet_slope(between + up, at.view, at.normal, lobe.t, lobe.b) * per_alpha);
  vec3 part = lobe_part(m0 + low, m1 + low, m2 + high, m3 + high);
  vec2 weight = facet_weight(part.xy * at.alpha, lobe.v_local, at.a2);
  float share = behind ? 0.0 : part.z * weight.x;
  return min(fresnel(at.f0, weight.y, at.dielectric) * share / lobe.reflected, vec3(1.0));
}

// rgb: their light, nearer ones before farther ones, as a radiance that is mirrored; a: the share of the lobe that they
// take from the surroundings.
vec4 stand_ins(uvec4 mask, Facing at, Lobe lobe) {
  vec3 light = vec3(0.0);
  float passes = 1.0;
  while ((mask.x | mask.y | mask.z | mask.w) != 0u) {
    int word = mask.x != 0u ? 0 : mask.y != 0u ? 1 : mask.z != 0u ? 2 : 3;
    uint bits = mask[word];
    mask[word] = bits & (bits - 1u);
    ReflectorGpu q = reflectors.all[word * 32 + findLSB(bits)];
    vec3 share = mirrored_of(q, at, lobe) * q.across_seen.w;
    light += passes * share * q.radiance.rgb;
    passes *= 1.0 - share.g;
  }
  return vec4(light, 1.0 - passes);
}

#endif
