#version 450 core
// Nine coefficients -> an octahedral tile of irradiance / pi: one lookup where it is needed, instead of nine.
#include "systems/lighting/lighting_shared.h"
#include "systems/lighting/octahedral.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba16f) uniform image2D environment;

vec3 coefficient(int i) { return imageLoad(environment, ivec2(i, ENVIRONMENT_TILE)).rgb; }

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, ivec2(ENVIRONMENT_TILE)))) return;
  vec3 n = direction_from_square((vec2(texel) + 0.5 - float(ENVIRONMENT_BORDER)) /
                                 float(ENVIRONMENT_TILE - 2 * ENVIRONMENT_BORDER));
  vec3 sum = coefficient(0) * 0.282095;
  sum += coefficient(1) * (0.488603 * n.y) + coefficient(2) * (0.488603 * n.z) + coefficient(3) * (0.488603 * n.x);
  sum += coefficient(4) * (1.092548 * n.x * n.y) + coefficient(5) * (1.092548 * n.y * n.z) +
         coefficient(6) * (0.315392 * (3.0 * n.z * n.z - 1.0)) + coefficient(7) * (1.092548 * n.x * n.z) +
         coefficient(8) * (0.546274 * (n.x * n.x - n.y * n.y));
  // Nine coefficients ring: a dark side may come out below zero.
  imageStore(environment, texel + ivec2(ENVIRONMENT_LEVELS * ENVIRONMENT_TILE, 0), vec4(max(sum, vec3(0.0)), 1.0));
}
