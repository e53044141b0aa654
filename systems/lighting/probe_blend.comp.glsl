#version 450 core
// A probe's cube map: captures at places of the grid about the object, each turned so that what it saw stands where it
// does as seen from the object's middle, and mixed. Radiance and 1 / distance, as in the captures.
#include "systems/lighting/lighting_shared.h"
#include "systems/lighting/octahedral.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D corner0;
layout(binding = 1) uniform sampler2D corner1;
layout(binding = 2) uniform sampler2D corner2;
layout(binding = 3) uniform sampler2D corner3;
layout(binding = 0, rgba16f) uniform writeonly image2D probe;
uniform vec4 offset_weight[4];  // object minus capture, m; share

vec4 capture_tile(sampler2D map, vec3 direction, int level) {
  const float inner = float(ENVIRONMENT_TILE - 2 * ENVIRONMENT_BORDER);
  vec2 texel = vec2(level * ENVIRONMENT_TILE, 0) + float(ENVIRONMENT_BORDER) + square_from_direction(direction) * inner;
  return textureLod(map, texel / vec2(ENVIRONMENT_WIDTH, ENVIRONMENT_HEIGHT), 0.0);
}

// The way from the object to what is seen is found as in probe.glsl: by spheres of the distances seen.
vec4 seen_from_object(sampler2D map, vec4 from, vec3 direction, int level) {
  vec3 toward = direction;
  float way = 1e3;
  for (int i = 0; i < 3; ++i) {
    float radius = 1.0 / max(capture_tile(map, toward, 0).a, 1e-3);
    float b = dot(from.xyz, direction), c = dot(from.xyz, from.xyz);
    radius = max(radius, 1.05 * sqrt(c));
    way = sqrt(max(b * b + radius * radius - c, 0.0)) - b;
    toward = from.xyz + direction * way;
  }
  return vec4(capture_tile(map, toward, level).rgb, 1.0 / max(way, 0.05)) * from.w;
}

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (texel.x >= ENVIRONMENT_LEVELS * ENVIRONMENT_TILE || texel.y >= ENVIRONMENT_TILE) return;
  int level = texel.x / ENVIRONMENT_TILE;
  vec2 inside = vec2(texel.x % ENVIRONMENT_TILE, texel.y) + 0.5;
  vec3 d = direction_from_square((inside - float(ENVIRONMENT_BORDER)) /
                                 float(ENVIRONMENT_TILE - 2 * ENVIRONMENT_BORDER));
  vec4 sum = seen_from_object(corner0, offset_weight[0], d, level);
  if (offset_weight[1].w > 0.0) sum += seen_from_object(corner1, offset_weight[1], d, level);
  if (offset_weight[2].w > 0.0) sum += seen_from_object(corner2, offset_weight[2], d, level);
  if (offset_weight[3].w > 0.0) sum += seen_from_object(corner3, offset_weight[3], d, level);
  imageStore(probe, texel, sum);
}
