#version 450 core
// The mean of the four phases that rays are sent in: weights 1 2 1 along either axis hold each phase alike, and stay
// centred. Of texels of the same surface alone. One work group a tile of the list.
#define GBUFFER_FIRST_UNIT 0
#include "systems/reflection/mirror_texel.glsl"
#include "systems/reflection/reflection_shared.h"

layout(local_size_x = REFLECTION_TILE, local_size_y = REFLECTION_TILE) in;
layout(binding = 4) uniform sampler2D phases;
layout(std430, binding = REFLECTION_TILES_BINDING) readonly buffer Tiles { uint tiles[]; };
layout(binding = 0, rgba16f) uniform writeonly image2D reflections;

void main() {
  uint listed = tiles[uint(REFLECTION_TILES_HEADER) + gl_WorkGroupID.x];
  ivec2 tile = ivec2(listed & 0xffffu, listed >> 16u);
  ivec2 texel = tile * REFLECTION_TILE + ivec2(gl_LocalInvocationID.xy), last = imageSize(reflections) - 1;
  if (any(greaterThan(texel, last))) return;
  float depth = read_depth(picture_texel(texel));
  vec4 sum = vec4(0.0);
  float weights = 1e-6;
  for (int i = 0; i < 9; ++i) {
    ivec2 step = ivec2(i % 3, i / 3) - 1, from = clamp(texel + step, ivec2(0), last);
    ivec2 stands = picture_texel(from);
    bool mirrors = mirror_share(texelFetch(gbuffer_normal, stands, 0).z) > 0.0;
    float same = max(1.0 - abs(read_depth(stands) - depth) / (0.1 * depth + 1e-7), 0.0) + 1e-4;
    float weight = mirrors ? same * float((2 - abs(step.x)) * (2 - abs(step.y))) : 0.0;
    sum += texelFetch(phases, from, 0) * weight;
    weights += weight;
  }
  imageStore(reflections, texel, sum / weights);
}
