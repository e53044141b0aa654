#version 450 core
// What wet ground mirrors, half size: rgb radiance (as if the surface were a perfect mirror with its own roughness) less
// the captured surroundings that it stands before, a the share of the lobe that it takes from them. Lamps' highlights are pass shade's,
// at full size. One work group a tile of the list. See streak.h and screen_rays.glsl.
#define GBUFFER_FIRST_UNIT 0
#include "systems/reflection/mirror_texel.glsl"
#include "systems/reflection/stand_ins.glsl"
#include "systems/lighting/environment.glsl"
#ifdef SCREEN_SPACE
#include "systems/reflection/screen_rays.glsl"
#endif

layout(local_size_x = REFLECTION_TILE, local_size_y = REFLECTION_TILE) in;
layout(binding = 5) uniform usampler2D reflection_lists;
layout(std430, binding = REFLECTION_TILES_BINDING) readonly buffer Tiles { uint tiles[]; };
layout(binding = 0, rgba16f) uniform writeonly image2D reflections;
uniform float impostor_share, screen_share;

vec4 mirrored(ivec2 half_texel, ivec2 texel, float depth, uvec4 mask) {
  Surface surface = mirror_surface(texel, depth);
  Facing at = facing_of(surface, relative_position(vec2(texel) + 0.5, depth));
  Lobe lobe = lobe_of(at, surface.roughness);
  vec4 stands = stand_ins(mask, at, lobe);
  vec4 sum = impostor_share * stands;
#ifdef SCREEN_SPACE
  // Four phases of two by two texels; reflections_smooth.comp.glsl takes their mean.
  float jitter = (float((half_texel.x & 1) + 2 * ((half_texel.x ^ half_texel.y) & 1)) + 0.5) * 0.25;
  vec4 seen = screen_space(at, lobe, jitter);
  sum += screen_share * (stands + (1.0 - stands.a) * seen);
#endif
  vec3 hidden = environment_around(at.mirror, surface.roughness).matt * (frame.sky_zenith.w * sum.a);
  return vec4(min(sum.rgb - hidden, vec3(6e4)), sum.a);
}

void main() {
  uint listed = tiles[uint(REFLECTION_TILES_HEADER) + gl_WorkGroupID.x];
  ivec2 tile = ivec2(listed & 0xffffu, listed >> 16u);
  ivec2 half_texel = tile * REFLECTION_TILE + ivec2(gl_LocalInvocationID.xy);
  if (any(greaterThanEqual(half_texel, imageSize(reflections)))) return;
  ivec2 texel = picture_texel(half_texel);
  float depth = read_depth(texel);
  bool mirrors = depth > 0.0 && mirror_share(texelFetch(gbuffer_normal, texel, 0).z) > 0.0;
  uvec4 mask = texelFetch(reflection_lists, tile, 0);
  vec4 sum = vec4(0.0);
  // A loop for an if: software OpenGL leaves a loop that no pixel is in, but walks through both sides of a branch.
  for (int once = 0; once < (mirrors ? 1 : 0); ++once) sum = mirrored(half_texel, texel, depth, mask);
  imageStore(reflections, half_texel, sum);
}
