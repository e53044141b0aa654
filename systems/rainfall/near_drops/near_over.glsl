// What near drops do to a pixel of the picture: picture * a + rgb.
#ifndef SYSTEMS_RAINFALL_NEAR_OVER_GLSL
#define SYSTEMS_RAINFALL_NEAR_OVER_GLSL
#include "systems/frame.glsl"
#include "systems/rainfall/near_drops/near_shared.h"
layout(std430, binding = NEAR_SUMS_BINDING) buffer NearSums { uvec4 sums[]; };

vec4 near_over(uvec4 sum) {
  float depth = float(sum.w) / NEAR_DEPTH_ONE, transmittance = exp(-depth);
  float per_depth = depth > 1e-3 ? (1.0 - transmittance) / depth : 1.0 - 0.5 * depth;
  return vec4(vec3(sum.rgb) * (per_depth / (NEAR_RADIANCE_ONE * frame.lens.w)), transmittance);
}

#endif
