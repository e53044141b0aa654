#version 450 core
// What wet ground mirrors, half size: rgb radiance (as if the surface were a perfect mirror with its own roughness), a
// the share of its lobe that this replaces; the rest are the captured surroundings. See streak.h and screen_rays.glsl.
#define GBUFFER_FIRST_UNIT 0
#include "systems/reflection/mirror_texel.glsl"
#include "systems/reflection/stand_ins.glsl"
#ifdef SCREEN_SPACE
#include "systems/reflection/screen_rays.glsl"
#endif
#ifdef IMPOSTORS
#include "systems/lighting/lighting_shared.h"
#include "systems/lighting/shadow.glsl"
layout(binding = 4) uniform usampler2D light_lists;
#endif

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 5) uniform usampler2D reflection_lists;
layout(binding = 0, rgba16f) uniform writeonly image2D reflections;
uniform float impostor_share, screen_share;

#ifdef IMPOSTORS
// Lamps: GGX about the nearest point of a sphere, as pass shade has it, on the mean normal.
vec3 lamps_of(ivec2 texel, Facing at, vec3 reflected) {
  float extinction = frame.mist.x + frame.rain.z;
  vec3 irradiance = vec3(0.0), specular = vec3(0.0);
  uvec4 mask = texelFetch(light_lists, texel / LIGHT_TILE, 0);
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
  while ((mask.x | mask.y | mask.z | mask.w) != 0u) {
    int word = mask.x != 0u ? 0 : mask.y != 0u ? 1 : mask.z != 0u ? 2 : 3;
    uint bits = mask[word];
    mask[word] = bits & (bits - 1u);
    add_light(chosen.lights[word * 32 + findLSB(bits)], at, extinction, 1.0, irradiance, specular);
  }
  return specular / reflected;
}
#endif

vec4 mirrored(ivec2 half_texel, ivec2 texel, float depth) {
  Surface surface = mirror_surface(texel, depth);
  Facing at = facing_of(surface, relative_position(vec2(texel) + 0.5, depth));
  Lobe lobe = lobe_of(at, surface.roughness);
  vec4 stands = stand_ins(texelFetch(reflection_lists, half_texel / REFLECTION_TILE, 0), at, lobe);
  vec4 sum = vec4(0.0);
#ifdef SCREEN_SPACE
  // Four phases of two by two texels; pass reflections_over takes their mean.
  float jitter = (float((half_texel.x & 1) + 2 * ((half_texel.x ^ half_texel.y) & 1)) + 0.5) * 0.25;
  vec4 seen = screen_space(at, lobe, jitter);
  sum += screen_share * (seen + (1.0 - seen.a) * stands);
#endif
#ifdef IMPOSTORS
  sum += impostor_share * (stands + vec4(lamps_of(texel, at, lobe.reflected), 0.0));
#endif
  return vec4(min(sum.rgb, vec3(6e4)), sum.a);
}

void main() {
  ivec2 half_texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(half_texel, imageSize(reflections)))) return;
  ivec2 texel = picture_texel(half_texel);
  float depth = read_depth(texel);
  bool mirrors = depth > 0.0 && mirror_share(texelFetch(gbuffer_normal, texel, 0).z) > 0.0;
  vec4 sum = vec4(0.0);
  // A loop for an if: software OpenGL leaves a loop that no pixel is in, but walks through both sides of a branch.
  for (int once = 0; once < (mirrors ? 1 : 0); ++once) sum = mirrored(half_texel, texel, depth);
  imageStore(reflections, half_texel, sum);
}
