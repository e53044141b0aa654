// A marked object, and how droplets by it are lit.
#ifndef SYSTEMS_SPLATTER_CATCHER_GLSL
#define SYSTEMS_SPLATTER_CATCHER_GLSL
#include "systems/frame.glsl"
#include "systems/splatter/splatter_shared.h"
#include "systems/drops/ambient.glsl"
#include "systems/drops/lamp_light.glsl"

layout(std140, binding = SPLATTER_CATCHER_BINDING) uniform CatcherBlock { CatcherGpu catcher; };

vec3 local_place(vec3 relative) { return (catcher.local_from_relative * vec4(relative, 1.0)).xyz; }
vec3 local_way(vec3 way) { return mat3(catcher.local_from_relative) * way; }

// Radiance of droplets' discs at a place, from lamps: strongest with a lamp behind them, where the phase has its lobe
// ("the splashes appear the strongest when backlit", section 3.3). Lightning is a light like others.
vec3 droplet_lamps(vec3 place) {
  vec3 sum = vec3(0.0);
  vec3 view = normalize(place);
  for (uint i = 0u; i < catcher.key.z; ++i) {
    LightGpu light = lights[catcher.lamps[i >> 2u][i & 3u]];
    vec3 along = light.direction_kind.xyz;
    float strength = 1.0;
    if (light.direction_kind.w != float(LIGHT_DIRECTIONAL)) {
      vec3 from = place - light.position_range.xyz;
      float square = max(dot(from, from), 0.01);
      from *= inversesqrt(square);
      float x = square / (light.position_range.w * light.position_range.w);
      float window = clamp(1.0 - x * x, 0.0, 1.0);
      strength = window * window / square;
      if (light.direction_kind.w == float(LIGHT_SPOT)) {
        float cone = clamp(dot(from, along) * light.cone_shadow.x + light.cone_shadow.y, 0.0, 1.0);
        strength *= cone * cone;
      }
      along = from;
    }
    // Light that goes on towards the eye is turned by nothing: along the view, which points away from the eye, it is -1.
    sum += light.intensity_radius.rgb * (strength * drop_phase(-dot(along, view)));
  }
  return sum;
}

#endif
