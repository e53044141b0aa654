// What the drops of a pixel do to the picture behind them: picture * a + rgb.
#ifndef SYSTEMS_DROPS_COMPOSITE_GLSL
#define SYSTEMS_DROPS_COMPOSITE_GLSL
#include "systems/frame.glsl"
#include "systems/drops/rain_shared.h"
#include "systems/drops/ambient.glsl"

layout(std430, binding = RAIN_OPTICAL_DEPTH_BINDING) buffer RainOpticalDepth { uint optical_depth[]; };
layout(std430, binding = RAIN_RADIANCE_BINDING) buffer RainRadiance { uint radiance[]; };
uniform float near_extinction;  // of drops nearer than the first that is drawn: extinction * axial distance
uniform bool lamps;
uniform vec3 ray_corner, ray_x, ray_y;  // ray of a place in the picture, one metre deep: corner + x ray_x + y ray_y

// units: the pixel's sum of optical depths; lamp: its sum of radiance.
vec4 rain_over(ivec2 pixel, uint units, uvec3 lamp) {
  vec2 centre = vec2(pixel) + 0.5;
  vec3 ray = ray_corner + centre.x * ray_x + centre.y * ray_y;
  float slant = length(ray);
  float depth = float(units) / RAIN_DEPTH_ONE + near_extinction * slant;
  float transmittance = exp(-depth);
  float opacity = 1.0 - transmittance;
  vec3 around = drop_ambient(ray / slant);
  // The mean of the drops' lamplight, weighted by their optical depths; (1 - exp(-d)) / d without cancelling.
  float per_depth = depth > 1e-3 ? opacity / depth : 1.0 - 0.5 * depth;
  return vec4(around * opacity + vec3(lamp) * (per_depth / (float(RAIN_RADIANCE_ONE) * frame.lens.w)), transmittance);
}

#endif
