// How a pixel faces the eye, and what a lamp's light does there: for every pass that shades or mirrors.
#ifndef SYSTEMS_LIGHTING_FACING_GLSL
#define SYSTEMS_LIGHTING_FACING_GLSL
#include "systems/geometry/gbuffer.glsl"
#include "systems/brdf.h"

struct Facing {  // what a pixel needs for every light
  vec3 place;
  vec3 normal;
  vec3 view;
  vec3 mirror;
  float n_dot_v;
  float alpha;
  float a2;
  float smith_view;  // the view's half of the Smith term, for the unwidened lobe
  vec3 f0;
  float dielectric;
};

// Sums of light: diffuse irradiance, and specular radiance.
void add_light(LightGpu light, Facing at, float extinction, float passes, inout vec3 irradiance, inout vec3 specular) {
  bool directional = light.direction_kind.w == float(LIGHT_DIRECTIONAL);
  vec3 to_light = directional ? -light.direction_kind.xyz * 1e4 : light.position_range.xyz - at.place;
  float d2 = dot(to_light, to_light);
  float inverse_d = inversesqrt(d2);
  vec3 l = to_light * inverse_d;
  float n_dot_l = clamp(dot(at.normal, l), 0.0, 1.0);
  float strength = distance_attenuation(d2, light.position_range.w) * exp(-extinction * d2 * inverse_d);
  strength *= spot_attenuation(-dot(l, light.direction_kind.xyz), light.cone_shadow.x, light.cone_shadow.y);
  strength = (directional ? 1.0 : strength) * n_dot_l * passes;
  vec3 e = light.intensity_radius.rgb * strength;
  irradiance += e;

  vec3 s = normalize(sphere_light_point(to_light, at.mirror, light.intensity_radius.w));
  vec2 lobe = sphere_light_lobe(at.alpha, light.intensity_radius.w, inverse_d);
  vec3 h = normalize(s + at.view);
  float n_dot_h = clamp(dot(at.normal, h), 0.0, 1.0);
  float v_dot_h = clamp(dot(at.view, h), 0.0, 1.0);
  float smith = 0.5 / max(n_dot_l * at.smith_view +
                          at.n_dot_v * sqrt(n_dot_l * n_dot_l * (1.0 - at.a2) + at.a2), 1e-5);
  specular += e * fresnel(at.f0, v_dot_h, at.dielectric) *
              (ggx_distribution(n_dot_h, lobe.x * lobe.x) * lobe.y * smith);
}

Facing facing_of(Surface surface, vec3 place) {
  Facing at;
  at.place = place;
  at.normal = surface.normal;
  at.view = -normalize(at.place);
  at.n_dot_v = clamp(dot(at.normal, at.view), 0.02, 1.0);
  at.mirror = reflect(-at.view, at.normal);
  at.alpha = max(surface.roughness * surface.roughness, 2e-3);
  at.a2 = at.alpha * at.alpha;
  at.smith_view = sqrt(at.n_dot_v * at.n_dot_v * (1.0 - at.a2) + at.a2);
  at.f0 = mix(vec3(mix(DIELECTRIC_F0, FILM_F0, surface.water)), surface.albedo, surface.metallic);
  at.dielectric = 1.0 - surface.metallic;
  return at;
}

// Share of light from all round that is mirrored (directional albedo).
vec3 mirrored_share(Facing at, float roughness) {
  vec2 terms = ggx_albedo(roughness, at.n_dot_v);
  return at.f0 * terms.x + terms.y;
}

// Light from below the horizon of a smooth normal does not arrive; neither does much where it is occluded
// (Lagarde and de Rousiers 2014, "Moving Frostbite to PBR", specular occlusion).
float mirror_open(Facing at, float roughness, float occlusion) {
  return clamp(pow(at.n_dot_v + occlusion, exp2(-16.0 * roughness - 1.0)) - 1.0 + occlusion, 0.0, 1.0);
}

#endif
