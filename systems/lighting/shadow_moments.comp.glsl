#version 450 core
// Six depth maps round a light become an octahedral map of the first two moments of
// exp(SHADOW_WARP * d / reach), d the distance to the light (Donnelly and Lauritzen 2006, "Variance Shadow Maps";
// Lauritzen and McCool 2008, "Layered Variance Shadow Maps", section on exponential warps). Moments may be
// filtered, which depths may not: one lookup then is a soft shadow. shadow_pack.comp.glsl puts it into the atlas.
#include "systems/lighting/lighting_shared.h"
#include "systems/lighting/octahedral.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2DArray face_depth;  // reversed, infinite: near / axial distance; 0 nothing hit
layout(binding = 0, rg32f) uniform writeonly image2D tile;
uniform float reach_m;

float distance_along(vec3 direction) {
  vec3 place = face_from_direction(direction);
  ivec2 texel = min(ivec2(place.xy * float(SHADOW_FACE)), ivec2(SHADOW_FACE - 1));
  float depth = texelFetch(face_depth, ivec3(texel, int(place.z)), 0).r;
  if (depth <= 0.0) return reach_m;
  vec3 a = abs(direction);
  return min(SHADOW_NEAR_M / depth / max(a.x, max(a.y, a.z)), reach_m);
}

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, ivec2(SHADOW_TILE)))) return;
  // A tent over three by three places, so that neighbours share samples and edges come out smooth.
  const vec3 weights = vec3(0.25, 0.5, 0.25);
  vec2 moments = vec2(0.0);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x) {
      vec2 place = vec2(texel) + 0.5 + (vec2(x, y) - 1.0) * 0.75;
      vec3 direction = direction_from_square((place - float(SHADOW_BORDER)) / float(SHADOW_TILE - 2 * SHADOW_BORDER));
      float warped = exp(SHADOW_WARP * distance_along(direction) / reach_m);
      moments += weights[x] * weights[y] * vec2(warped, warped * warped);
    }
  imageStore(tile, texel, vec4(moments, 0.0, 0.0));
}
