// Light from all round, captured from the scene near the camera: an octahedral map at six steps of roughness
// (prefiltered with GGX), and its projection on spherical harmonics for diffuse light. Radiance in cd/m2.
#ifndef SYSTEMS_LIGHTING_ENVIRONMENT_GLSL
#define SYSTEMS_LIGHTING_ENVIRONMENT_GLSL
#include "systems/lighting/lighting_shared.h"
#include "systems/lighting/octahedral.glsl"

#ifndef ENVIRONMENT_UNIT
#define ENVIRONMENT_UNIT 7
#endif
layout(binding = ENVIRONMENT_UNIT) uniform sampler2D environment_map;

vec3 environment_level(vec2 square, float level) {
  const float inner = float(ENVIRONMENT_TILE - 2 * ENVIRONMENT_BORDER);
  vec2 texel = vec2(level * float(ENVIRONMENT_TILE), 0.0) + float(ENVIRONMENT_BORDER) + square * inner;
  return textureLod(environment_map, texel / vec2(ENVIRONMENT_WIDTH, ENVIRONMENT_HEIGHT), 0.0).rgb;
}

// Mean radiance over the GGX lobe of this perceptual roughness about a direction.
vec3 environment_radiance(vec3 direction, float roughness) {
  vec2 square = square_from_direction(direction);
  float level = clamp(roughness, 0.0, 1.0) * float(ENVIRONMENT_LEVELS - 1);
  float below = min(floor(level), float(ENVIRONMENT_LEVELS - 2));
  return mix(environment_level(square, below), environment_level(square, below + 1.0), level - below);
}

vec3 environment_sh(int i) { return texelFetch(environment_map, ivec2(i, ENVIRONMENT_TILE), 0).rgb; }

// Irradiance / pi on a surface with this normal: what a white Lambert surface would shine with. The coefficients
// are stored convolved with the cosine (Ramamoorthi and Hanrahan 2001) and divided by pi.
vec3 environment_diffuse(vec3 n) {
  vec3 sum = environment_sh(0) * 0.282095;
  sum += environment_sh(1) * (0.488603 * n.y) + environment_sh(2) * (0.488603 * n.z) +
         environment_sh(3) * (0.488603 * n.x);
  sum += environment_sh(4) * (1.092548 * n.x * n.y) + environment_sh(5) * (1.092548 * n.y * n.z) +
         environment_sh(6) * (0.315392 * (3.0 * n.z * n.z - 1.0)) + environment_sh(7) * (1.092548 * n.x * n.z) +
         environment_sh(8) * (0.546274 * (n.x * n.x - n.y * n.y));
  return max(sum, vec3(0.0));
}

// Mean radiance over all directions: what scatters into the view where scattering has no preferred direction.
vec3 environment_mean() { return environment_sh(0) * 0.282095; }

#endif
