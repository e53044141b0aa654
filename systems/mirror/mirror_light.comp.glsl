#version 450 core
// Lights the mirrored picture: a small G-buffer becomes radiance, cd/m2, with 1 / distance from the mirrored eye in its
// alpha; 0 outside the rectangle that was drawn. Lamps with shadows, the surroundings' diffuse light, what shines by
// itself, mist on the way from the mirror, and the sky. Lamps are chosen tile by tile: those that could show in none of
// the tile's pixels are left out.
#include "systems/brdf.h"
#include "systems/lighting/lighting_shared.h"
#ifdef SHADOWS
#include "systems/lighting/shadow.glsl"
#endif
#ifdef ENVIRONMENT
#include "systems/lighting/environment.glsl"
#endif
#include "systems/mirror_shared.h"
#include "systems/sky.glsl"
#define GBUFFER_FIRST_UNIT 0
#include "systems/geometry/gbuffer.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba16f) uniform writeonly image2D picture;
layout(std140, binding = MIRRORS_BINDING) uniform MirrorsBlock { MirrorsGpu mirrors; };
uniform int layer;
uniform float brightest;  // of surfaces that shine, cd/m2
uniform float threshold;  // of a white pixel: lamps that add less to a tile are left out

shared ivec3 low_mm, high_mm;  // bounds of the tile's places
shared uint whitest;           // albedo, 1/1024
shared uint listed;
shared uint lamps[MAXIMUM_LIGHTS];

const float to_mm = 1000.0;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = ivec2(mirrors.size.xy);
  vec2 at = (vec2(texel) + 0.5) / mirrors.size.xy;
  vec4 rect = mirrors.planes[layer].rect;
  bool drawn = all(lessThan(texel, size)) && all(greaterThanEqual(at, rect.xy)) && all(lessThanEqual(at, rect.zw));
  float depth = drawn ? read_depth(texel) : 0.0;
  vec4 p = mirrors.planes[layer].relative_from_picture * vec4(at * 2.0 - 1.0, depth, 1.0);
  vec3 place = p.xyz / (abs(p.w) > 1e-20 ? p.w : 1e-20);
  bool solid = depth > 0.0;
  Surface surface = read_surface(clamp(texel, ivec2(0), size - 1));

  uint lane = gl_LocalInvocationIndex;
  if (lane == 0u) {
    low_mm = ivec3(2000000000);
    high_mm = ivec3(-2000000000);
    whitest = 0u;
    listed = 0u;
  }
  barrier();
  if (solid) {
    ivec3 mm = ivec3(clamp(place, vec3(-2e6), vec3(2e6)) * to_mm * 0.5);
    atomicMin(low_mm.x, mm.x); atomicMin(low_mm.y, mm.y); atomicMin(low_mm.z, mm.z);
    atomicMax(high_mm.x, mm.x); atomicMax(high_mm.y, mm.y); atomicMax(high_mm.z, mm.z);
    atomicMax(whitest, uint(1024.0 * max(surface.albedo.r, max(surface.albedo.g, surface.albedo.b))));
  }
  barrier();
  vec3 low = vec3(low_mm) * (2.0 / to_mm), high = vec3(high_mm) * (2.0 / to_mm);
  float white = float(whitest) / 1024.0;
  if (high.x >= low.x) {
    for (uint i = lane; i < chosen.counts.x; i += 64u) {
      LightGpu light = chosen.lights[i];
      bool directional = light.direction_kind.w == float(LIGHT_DIRECTIONAL);
      vec3 nearest = light.position_range.xyz - clamp(light.position_range.xyz, low, high);
      float strongest = max(light.intensity_radius.r, max(light.intensity_radius.g, light.intensity_radius.b));
      float lux = directional ? strongest : strongest * distance_attenuation(dot(nearest, nearest), light.position_range.w);
      if (lux * white / PI * frame.lens.w >= threshold) lamps[atomicAdd(listed, 1u)] = i;
    }
  }
  barrier();
  // In the order of their numbers: a sum of floats depends on the order.
  if (lane == 0u) {
    for (uint i = 1u; i < listed; ++i) {
      uint lamp = lamps[i], j = i;
      for (; j > 0u && lamps[j - 1u] > lamp; --j) lamps[j] = lamps[j - 1u];
      lamps[j] = lamp;
    }
  }
  barrier();
  if (any(greaterThanEqual(texel, size))) return;

  vec4 plane = mirrors.planes[layer].plane;
  vec3 eye = plane.xyz * (-2.0 * plane.w);  // the mirror image of ours
  vec3 light = vec3(0.0);
  float away = MIRROR_FARTHEST_M;
  if (solid) {
    vec3 irradiance = vec3(0.0);
    for (uint k = 0u; k < listed; ++k) {
      LightGpu lamp = chosen.lights[lamps[k]];
      bool directional = lamp.direction_kind.w == float(LIGHT_DIRECTIONAL);
      vec3 to_light = directional ? -lamp.direction_kind.xyz * 1e4 : lamp.position_range.xyz - place;
      float d2 = max(dot(to_light, to_light), 1e-8);
      vec3 l = to_light * inversesqrt(d2);
      float strength = directional ? 1.0
                                   : distance_attenuation(d2, lamp.position_range.w) *
                                         spot_attenuation(-dot(l, lamp.direction_kind.xyz), lamp.cone_shadow.x,
                                                          lamp.cone_shadow.y);
      strength *= max(dot(surface.normal, l), 0.0);
#ifdef SHADOWS
      if (lamp.cone_shadow.z >= 0.0 && strength > 0.0)
        strength *= plain_shadow(lamp.cone_shadow.z, -to_light, lamp.cone_shadow.w);
#endif
      irradiance += lamp.intensity_radius.rgb * strength;
    }
    // Metals shine with what they mirror; their base colour stands for it here.
#ifdef ENVIRONMENT
    irradiance += environment_diffuse(surface.normal) * (PI * surface.occlusion * frame.sky_zenith.w);
#endif
    light = surface.albedo * irradiance / PI + min(surface.emissive, vec3(brightest));
    // The way from the mirror to here; pass atmosphere sees to that from the eye to the mirror.
    away = length(place - eye);
    float height = max(dot(plane.xyz, place) + plane.w, 0.0);
    float clear = exp(-(frame.mist.x + frame.rain.z) * away * height / max(height + plane.w, 1e-4));
    light *= clear;
#ifdef ENVIRONMENT
    light += environment_mean() * frame.mist.yzw * (1.0 - clear);
#endif
  } else {
    // Through the point of the plane itself, which is at depth 1.
    vec4 on = mirrors.planes[layer].relative_from_picture * vec4(at * 2.0 - 1.0, 1.0, 1.0);
    light = sky_radiance(normalize(on.xyz / (abs(on.w) > 1e-20 ? on.w : 1e-20) - eye));
  }
  vec4 seen = vec4(min(light, vec3(6e4)), 1.0 / clamp(away, 0.02, MIRROR_FARTHEST_M));
  imageStore(picture, texel, drawn ? seen : vec4(0.0));
}
