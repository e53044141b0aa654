#version 450 core
// Radiance on six faces -> nine coefficients, one a work group, convolved with the cosine and divided by pi
// (Ramamoorthi and Hanrahan 2001, "An Efficient Representation for Irradiance Environment Maps").
#include "systems/lighting/lighting_shared.h"
#include "systems/lighting/octahedral.glsl"

layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler2D radiance;
layout(binding = 0, rgba16f) uniform writeonly image2D environment;

shared vec4 partial[64];

float basis(int i, vec3 n) {
  if (i == 0) return 0.282095;
  if (i == 1) return 0.488603 * n.y;
  if (i == 2) return 0.488603 * n.z;
  if (i == 3) return 0.488603 * n.x;
  if (i == 4) return 1.092548 * n.x * n.y;
  if (i == 5) return 1.092548 * n.y * n.z;
  if (i == 6) return 0.315392 * (3.0 * n.z * n.z - 1.0);
  if (i == 7) return 1.092548 * n.x * n.z;
  return 0.546274 * (n.x * n.x - n.y * n.y);
}

void main() {
  int coefficient = int(gl_WorkGroupID.x);
  uint lane = gl_LocalInvocationID.x;
  vec4 sum = vec4(0.0);  // w: solid angle
  for (int i = int(lane); i < 6 * ENVIRONMENT_FACE * ENVIRONMENT_FACE; i += 64) {
    ivec2 texel = ivec2(i % (6 * ENVIRONMENT_FACE), i / (6 * ENVIRONMENT_FACE));
    vec2 q = (vec2(texel.x % ENVIRONMENT_FACE, texel.y) + 0.5) * (2.0 / float(ENVIRONMENT_FACE)) - 1.0;
    float squared = 1.0 + dot(q, q);
    float solid_angle = 1.0 / (squared * sqrt(squared));
    vec3 n = direction_of_face(q, texel.x / ENVIRONMENT_FACE) * inversesqrt(squared);
    sum += vec4(texelFetch(radiance, texel, 0).rgb * (basis(coefficient, n) * solid_angle), solid_angle);
  }
  partial[lane] = sum;
  barrier();
  for (uint half_count = 32u; half_count > 0u; half_count >>= 1u) {
    if (lane < half_count) partial[lane] += partial[lane + half_count];
    barrier();
  }
  if (lane != 0u) return;
  // The sum of the weights stands for 4 pi. Cosine kernel over pi: 1, 2/3, 1/4 for bands 0, 1, 2.
  float band = coefficient == 0 ? 1.0 : coefficient < 4 ? 2.0 / 3.0 : 0.25;
  vec3 value = partial[0].rgb * (12.566371 / partial[0].w * band);
  imageStore(environment, ivec2(coefficient, ENVIRONMENT_TILE), vec4(value, 1.0));
}
