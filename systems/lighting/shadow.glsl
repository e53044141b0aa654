// Looking up the shadow atlas: how much of a light reaches a place, with a penumbra that widens with the distance
// between occluder and receiver (the idea of Fernando 2005, "Percentage-Closer Soft Shadows", on filtered moments:
// the blurred moments are solved for the occluder's distance, and the penumbra's width chooses between sharp and
// blurred). One lookup: on software OpenGL each costs as much as half a light.
#ifndef SYSTEMS_LIGHTING_SHADOW_GLSL
#define SYSTEMS_LIGHTING_SHADOW_GLSL
#include "systems/lighting/lighting_shared.h"
#include "systems/lighting/octahedral.glsl"

#ifndef SHADOW_ATLAS_UNIT
#define SHADOW_ATLAS_UNIT 6
#endif
layout(binding = SHADOW_ATLAS_UNIT) uniform sampler2D shadow_atlas;

// Width of the blurred moments, in texels, and radians that a texel of a tile covers, on average over the sphere.
const float SHADOW_BLUR_TEXELS = 1.5 * float(1 << SHADOW_BLUR_LEVEL);
const float SHADOW_TEXEL_RAD = 3.5449077 / float(SHADOW_TILE - 2 * SHADOW_BORDER);

vec2 shadow_place(float slot, vec3 from_light) {
  vec2 tile = vec2(mod(slot, float(SHADOW_TILES_PER_SIDE)), floor(slot / float(SHADOW_TILES_PER_SIDE)));
  const float inner = float(SHADOW_TILE - 2 * SHADOW_BORDER) / float(SHADOW_TILE);
  const float border = float(SHADOW_BORDER) / float(SHADOW_TILE);
  return (tile + border + inner * square_from_direction(from_light)) / float(SHADOW_TILES_PER_SIDE);
}

// Chebyshev's bound on the share of light that passes, for a receiver at this warped distance.
float lit_share(vec2 moments, float warped) {
  float variance = max(moments.y - moments.x * moments.x, 1e-4 * warped * warped);
  float beyond = max(warped - moments.x, 0.0);
  return variance / (variance + beyond * beyond);
}

// from_light: light to receiver, metres. reach_m: of its map, farther receivers are lit.
float soft_shadow(float slot, vec3 from_light, float reach_m, float source_radius_m, float bias_m) {
  vec4 moments = textureLod(shadow_atlas, shadow_place(slot, from_light), 0.0);
  float d = length(from_light);
  float warped = exp(SHADOW_WARP * min((d - bias_m) / reach_m, 1.0));
  float sharp = lit_share(moments.xy, warped), blurred = lit_share(moments.zw, warped);
  // mean = p * receiver + (1 - p) * occluder, in warped distance.
  float occluder_warped = max((moments.z - blurred * warped) / max(1.0 - blurred, 1e-3), 1.0);
  float occluder = clamp(log(occluder_warped) * reach_m / SHADOW_WARP, 0.1, d);
  float penumbra_rad = 2.0 * source_radius_m * (d - occluder) / (occluder * d);
  float share = mix(sharp, blurred, clamp(penumbra_rad / (SHADOW_BLUR_TEXELS * SHADOW_TEXEL_RAD), 0.0, 1.0));
  // The bound lets some light through behind two occluders in a row: its lowest part is taken as dark.
  return clamp((share - 0.15) / 0.85, 0.0, 1.0);
}

// Keeps a surface out of its own shadow: grows with the distance to the camera, as pixels do.
float shadow_bias_m(vec3 place) { return 0.015 + 0.002 * length(place); }

// Chebyshev's bound by the blurred moments alone.
float blurred_share(float slot, vec3 from_light, float reach_m, float bias_m) {
  float warped = exp(SHADOW_WARP * min((length(from_light) - bias_m) / reach_m, 1.0));
  return lit_share(textureLod(shadow_atlas, shadow_place(slot, from_light), 0.0).ba, warped);
}

// A fixed softness, for volumes of mist and for small captures.
float plain_shadow(float slot, vec3 from_light, float reach_m) {
  return clamp((blurred_share(slot, from_light, reach_m, 0.05) - 0.15) / 0.85, 0.0, 1.0);
}

#endif
