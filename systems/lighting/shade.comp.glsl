#version 450 core
// Lights every surface of the G-buffer: chosen lamps with GGX and Lambert, the captured environment, and what the
// surface itself emits; the sky where there is none. Writes radiance in cd/m2. The loops run over the masks of light_lists: first the lamps
// with shadow maps, then the rest, because software OpenGL executes both sides of a branch.
#define GBUFFER_FIRST_UNIT 0
#include "systems/geometry/gbuffer.glsl"
#include "systems/lighting/brdf.h"
#include "systems/lighting/environment.glsl"
#include "systems/lighting/lighting_shared.h"
#include "systems/lighting/shadow.glsl"
#include "systems/sky.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 4) uniform usampler2D light_lists;
layout(binding = 0, rgba16f) uniform writeonly image2D colour;
uniform float diffuse_gain;  // multiplies the environment's diffuse light
layout(std430, binding = TILES_BINDING) readonly buffer Tiles { uint tiles[]; };
uniform uint list_start;  // of this dispatch's kind of tiles; one tile a work group

ivec2 own_texel() {
  uint tile = tiles[list_start + gl_WorkGroupID.x];
  return ivec2(tile & 0xffffu, tile >> 16u) * LIGHT_TILE + ivec2(gl_LocalInvocationID.xy);
}

#ifdef SKY
void main() {
  ivec2 texel = own_texel();
  if (any(greaterThanEqual(texel, ivec2(frame.size.xy)))) return;
  imageStore(colour, texel, vec4(sky_radiance(view_ray(vec2(texel) + 0.5)), 1.0));
}
#else

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

void main() {
  ivec2 texel = own_texel();
  if (any(greaterThanEqual(texel, ivec2(frame.size.xy)))) return;
  float depth = read_depth(texel);
  Surface surface = read_surface(texel);

  Facing at;
  at.place = relative_position(vec2(texel) + 0.5, max(depth, 1e-7));
  at.normal = surface.normal;
  at.view = -normalize(at.place);
  at.n_dot_v = clamp(dot(at.normal, at.view), 0.02, 1.0);
  at.mirror = reflect(-at.view, at.normal);
  at.alpha = max(surface.roughness * surface.roughness, 2e-3);
  at.a2 = at.alpha * at.alpha;
  at.smith_view = sqrt(at.n_dot_v * at.n_dot_v * (1.0 - at.a2) + at.a2);
  at.f0 = mix(vec3(DIELECTRIC_F0), surface.albedo, surface.metallic);
  at.dielectric = 1.0 - surface.metallic;

  float extinction = frame.mist.x + frame.rain.z;
  vec3 irradiance = vec3(0.0), specular = vec3(0.0);
  uvec4 mask = depth > 0.0 ? texelFetch(light_lists, texel / LIGHT_TILE, 0) : uvec4(0u);
  uint in_light = mask.w >> 16;
  mask.w &= 0xffffu;
#ifdef SHADOWS
  uint casters = mask.x & ((1u << chosen.counts.y) - 1u) & ~in_light;
  mask.x &= ~casters;
  float bias_m = shadow_bias_m(at.place);
  while (casters != 0u) {
    int i = findLSB(casters);
    casters &= casters - 1u;
    LightGpu light = chosen.lights[i];
    float passes = soft_shadow(light.cone_shadow.z, at.place + at.normal * bias_m - light.position_range.xyz,
                               light.cone_shadow.w, light.intensity_radius.w, bias_m);
    add_light(light, at, extinction, passes, irradiance, specular);
  }
#endif
  // One loop over all four words: every loop of its own costs software OpenGL one idle turn.
  while ((mask.x | mask.y | mask.z | mask.w) != 0u) {
    int word = mask.x != 0u ? 0 : mask.y != 0u ? 1 : mask.z != 0u ? 2 : 3;
    uint bits = mask[word];
    mask[word] = bits & (bits - 1u);
    add_light(chosen.lights[word * 32 + findLSB(bits)], at, extinction, 1.0, irradiance, specular);
  }

  vec2 albedo_terms = ggx_albedo(surface.roughness, at.n_dot_v);
  vec3 reflected = at.f0 * albedo_terms.x + albedo_terms.y;
  // What GGX reflects does not reach the diffuse layer below it.
  vec3 diffuse = surface.albedo * at.dielectric * (1.0 - max(reflected.r, max(reflected.g, reflected.b)));
  vec3 radiance = diffuse * irradiance / PI + specular + surface.emissive;
#ifdef ENVIRONMENT
  // Light from below the horizon of a smooth normal does not arrive; neither does much where it is occluded
  // (Lagarde and de Rousiers 2014, "Moving Frostbite to PBR", specular occlusion).
  float open = clamp(pow(at.n_dot_v + surface.occlusion, exp2(-16.0 * surface.roughness - 1.0)) - 1.0 + surface.occlusion,
                     0.0, 1.0);
  radiance += (diffuse * environment_diffuse(at.normal) * surface.occlusion * diffuse_gain +
               reflected * environment_radiance(at.mirror, surface.roughness) * open) * frame.sky_zenith.w;
#endif
  imageStore(colour, texel, vec4(depth > 0.0 ? radiance : sky_radiance(-at.view), 1.0));
}
#endif
