#version 450 core
// A map's moments, sharp (rg) and widely blurred (ba), side by side in the atlas: one lookup gives both, and the
// blurred pair tells where the occluder is and stands for a wide penumbra.
#include "systems/lighting/lighting_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D tile;  // with mip levels
layout(binding = 0, rgba32f) uniform writeonly image2D atlas;
uniform ivec2 tile_origin;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, ivec2(SHADOW_TILE)))) return;
  vec2 place = (vec2(texel) + 0.5) / float(SHADOW_TILE);
  float step = float(1 << SHADOW_BLUR_LEVEL) / float(SHADOW_TILE);
  const vec3 weights = vec3(0.25, 0.5, 0.25);
  vec2 blurred = vec2(0.0);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x)
      blurred += weights[x] * weights[y] *
                 textureLod(tile, place + (vec2(x, y) - 1.0) * step * 0.75, float(SHADOW_BLUR_LEVEL)).rg;
  imageStore(atlas, tile_origin + texel, vec4(texelFetch(tile, texel, 0).rg, blurred));
}
