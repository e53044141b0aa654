// The night sky as a gradient of luminance: the city's glow over the horizon, falling to 1/e at the sine of
// elevation `glow height`. Below the horizon it is the horizon's.
#ifndef SYSTEMS_SKY_GLSL
#define SYSTEMS_SKY_GLSL
#include "systems/frame.glsl"

vec3 sky_radiance(vec3 direction) {
  float glow = exp(-max(direction.y, 0.0) / max(frame.sky_horizon.w, 1e-3));
  return mix(frame.sky_zenith.rgb, frame.sky_horizon.rgb, glow);
}

#endif
