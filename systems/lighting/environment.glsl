// Light from all round, captured from the scene near the camera: an octahedral map at six steps of roughness
// (prefiltered with GGX), and one more of diffuse light, from its projection on spherical harmonics. Radiance in cd/m2.
#ifndef SYSTEMS_LIGHTING_ENVIRONMENT_GLSL
#define SYSTEMS_LIGHTING_ENVIRONMENT_GLSL
#include "systems/lighting/lighting_shared.h"
#include "systems/lighting/octahedral.glsl"

#ifndef ENVIRONMENT_UNIT
#define ENVIRONMENT_UNIT 7
#endif
layout(binding = ENVIRONMENT_UNIT) uniform sampler2D environment_map;

vec4 environment_texel(vec2 square, float level) {
  const float inner = float(ENVIRONMENT_TILE - 2 * ENVIRONMENT_BORDER);
  vec2 texel = vec2(level * float(ENVIRONMENT_TILE), 0.0) + float(ENVIRONMENT_BORDER) + square * inner;
  return textureLod(environment_map, texel / vec2(ENVIRONMENT_WIDTH, ENVIRONMENT_HEIGHT), 0.0);
}

vec3 environment_level(vec2 square, float level) { return environment_texel(square, level).rgb; }

// Mean radiance over the GGX lobe of this perceptual roughness about a direction.
vec3 environment_radiance(vec3 direction, float roughness) {
  vec2 square = square_from_direction(direction);
  float level = clamp(roughness, 0.0, 1.0) * float(ENVIRONMENT_LEVELS - 1);
  float below = min(floor(level), float(ENVIRONMENT_LEVELS - 2));
  return mix(environment_level(square, below), environment_level(square, below + 1.0), level - below);
}

struct Surroundings {
  vec3 all;   // mean radiance over the lobe
  vec3 matt;  // without windows, signs and lamp glass: for passes that draw these where they really are
};
Surroundings environment_around(vec3 direction, float roughness) {
  vec2 square = square_from_direction(direction);
  float level = clamp(roughness, 0.0, 1.0) * float(ENVIRONMENT_LEVELS - 1);
  float below = min(floor(level), float(ENVIRONMENT_LEVELS - 2));
  vec4 light = mix(environment_texel(square, below), environment_texel(square, below + 1.0), level - below);
  float all = dot(light.rgb, vec3(0.2126, 0.7152, 0.0722));
  return Surroundings(light.rgb, light.rgb * clamp(1.0 - light.a / max(all, 1e-6), 0.0, 1.0));
}

// Irradiance / pi on a surface with this normal: what a white Lambert surface would shine with.
vec3 environment_diffuse(vec3 n) { return environment_level(square_from_direction(n), float(ENVIRONMENT_LEVELS)); }

// Mean radiance over all directions: what scatters into the view where scattering has no preferred direction.
vec3 environment_mean() { return texelFetch(environment_map, ivec2(0, ENVIRONMENT_TILE), 0).rgb * 0.282095; }

#endif
