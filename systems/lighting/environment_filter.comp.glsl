#version 450 core
// Radiance on six faces -> octahedral tiles, each the mean over a GGX lobe wider than the last (split sum with
// n = v, Karis 2013), by a fixed spiral of directions. Alpha (1 / distance) and things' own
// light are filtered likewise.
#include "systems/lighting/lighting_shared.h"
#include "systems/lighting/octahedral.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D radiance;
layout(binding = 1) uniform sampler2D own_light;
layout(binding = 0, rgba16f) uniform writeonly image2D environment;
layout(binding = 1, r16f) uniform writeonly image2D own_environment;

vec2 texel_along(vec3 direction) {
  vec3 place = face_from_direction(direction);
  // Half a texel inside the face, so that filtering takes nothing from its neighbour in the strip.
  vec2 texel = clamp(place.xy * float(ENVIRONMENT_FACE), 0.5, float(ENVIRONMENT_FACE) - 0.5);
  return (texel + vec2(place.z * float(ENVIRONMENT_FACE), 0.0)) / vec2(6 * ENVIRONMENT_FACE, ENVIRONMENT_FACE);
}

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (texel.x >= ENVIRONMENT_LEVELS * ENVIRONMENT_TILE || texel.y >= ENVIRONMENT_TILE) return;
  int level = texel.x / ENVIRONMENT_TILE;
  vec2 inside = vec2(texel.x % ENVIRONMENT_TILE, texel.y) + 0.5;
  vec3 n = direction_from_square((inside - float(ENVIRONMENT_BORDER)) /
                                 float(ENVIRONMENT_TILE - 2 * ENVIRONMENT_BORDER));
  float roughness = float(level) / float(ENVIRONMENT_LEVELS - 1);
  float a2 = roughness * roughness * roughness * roughness;
  vec3 side = normalize(cross(abs(n.y) < 0.9 ? vec3(0.0, 1.0, 0.0) : vec3(1.0, 0.0, 0.0), n));
  vec3 up = cross(n, side);

  vec4 sum = vec4(0.0);
  float own = 0.0, weights = 0.0;
  int samples = level == 0 ? 1 : 32;
  for (int i = 0; i < samples; ++i) {
    float u = (float(i) + 0.5) / float(samples);
    float angle = 2.399963 * float(i);  // the golden angle
    // Half vectors distributed as D(h) h.n, reflected about: the weight is n.l.
    float cosine = level == 0 ? 1.0 : sqrt((1.0 - u) / (1.0 + (a2 - 1.0) * u));
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    vec3 h = side * (cos(angle) * sine) + up * (sin(angle) * sine) + n * cosine;
    vec3 l = 2.0 * dot(n, h) * h - n;
    float weight = max(dot(n, l), 0.0);
    vec2 from = texel_along(l);
    sum += textureLod(radiance, from, 0.0) * weight;
    own += textureLod(own_light, from, 0.0).r * weight;
    weights += weight;
  }
  imageStore(environment, texel, sum / max(weights, 1e-4));
  imageStore(own_environment, texel, vec4(own / max(weights, 1e-4), 0.0, 0.0, 0.0));
}
