#version 450 core
// The environment of this camera position: captures at the corners of the grid cell, mixed. Alpha: how much of the
// luminance of what is mirrored is things' own light (windows, signs), which pass reflections draws in its place.
#include "systems/lighting/lighting_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D corner0;
layout(binding = 1) uniform sampler2D corner1;
layout(binding = 2) uniform sampler2D corner2;
layout(binding = 3) uniform sampler2D corner3;
layout(binding = 4) uniform sampler2D own0;
layout(binding = 5) uniform sampler2D own1;
layout(binding = 6) uniform sampler2D own2;
layout(binding = 7) uniform sampler2D own3;
layout(binding = 0, rgba16f) uniform writeonly image2D environment;
uniform vec4 weights;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (texel.x >= ENVIRONMENT_WIDTH || texel.y >= ENVIRONMENT_HEIGHT) return;
  vec3 sum = texelFetch(corner0, texel, 0).rgb * weights.x;
  sum += texelFetch(corner1, texel, 0).rgb * weights.y;
  sum += texelFetch(corner2, texel, 0).rgb * weights.z;
  sum += texelFetch(corner3, texel, 0).rgb * weights.w;
  float own = 0.0;
  if (texel.x < ENVIRONMENT_LEVELS * ENVIRONMENT_TILE && texel.y < ENVIRONMENT_TILE)
    own = dot(weights, vec4(texelFetch(own0, texel, 0).r, texelFetch(own1, texel, 0).r, texelFetch(own2, texel, 0).r,
                            texelFetch(own3, texel, 0).r));
  imageStore(environment, texel, vec4(sum, own));
}
