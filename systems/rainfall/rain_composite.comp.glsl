#version 450 core
// Lays the drops over the picture: picture * T + radiance * (1 - T), and leaves the sums at zero for the next frame.
layout(local_size_x = 8, local_size_y = 8) in;
#include "systems/geometry/position.glsl"
#include "systems/rainfall/rain_shared.h"
#ifdef ENVIRONMENT
#include "systems/lighting/environment.glsl"
#endif

layout(std430, binding = RAIN_OPTICAL_DEPTH_BINDING) buffer RainOpticalDepth { uint optical_depth[]; };
layout(std430, binding = RAIN_RADIANCE_BINDING) buffer RainRadiance { uint radiance[]; };
layout(std430, binding = RAIN_OPTICS_BINDING) readonly buffer RainOptics {
  float phase[RAIN_PHASE_BINS];
  vec4 ambient[RAIN_AMBIENT_BINS];  // a drop's radiance by the sine of the view's elevation, cd/m2
};
layout(rgba16f, binding = 0) uniform image2D colour;
uniform float near_extinction;  // of drops nearer than the first that is drawn: extinction * axial distance
uniform bool lamps;
uniform vec3 ray_corner, ray_x, ray_y;  // ray of a pixel, one metre deep: corner + x ray_x + y ray_y

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) return;
  uint at = uint(pixel.y) * uint(frame.size.x) + uint(pixel.x);
  uint units = optical_depth[at];
  if (units != 0u) optical_depth[at] = 0u;
  vec3 lamp = vec3(0.0);
  if (lamps) {
    lamp = vec3(radiance[4u * at], radiance[4u * at + 1u], radiance[4u * at + 2u]) / (RAIN_RADIANCE_ONE * frame.lens.w);
    radiance[4u * at] = 0u;
    radiance[4u * at + 1u] = 0u;
    radiance[4u * at + 2u] = 0u;
  }
  vec2 centre = vec2(pixel) + 0.5;
  vec3 ray = ray_corner + centre.x * ray_x + centre.y * ray_y;
  float slant = length(ray);
  float depth = float(units) / RAIN_DEPTH_ONE + near_extinction * slant;
  float transmittance = exp(-depth);
  float opacity = 1.0 - transmittance;
#ifdef ENVIRONMENT
  // A drop shows what lies behind it, inverted and gathered from a lobe about 30 degrees wide (median 25), and a
  // fifteenth of all round it.
  vec3 around = 0.93 * environment_radiance(ray / slant, 0.55) + 0.0664 * environment_mean();
#else
  float place = (ray.y / slant * 0.5 + 0.5) * float(RAIN_AMBIENT_BINS - 1);
  int bin = min(int(place), RAIN_AMBIENT_BINS - 2);
  vec3 around = mix(ambient[bin].rgb, ambient[bin + 1].rgb, place - float(bin));
#endif
  // The mean of the drops' lamplight, weighted by their optical depths; (1 - exp(-d)) / d without cancelling.
  float per_depth = depth > 1e-3 ? opacity / depth : 1.0 - 0.5 * depth;
  vec3 background = imageLoad(colour, pixel).rgb;
  imageStore(colour, pixel, vec4(background * transmittance + around * opacity + lamp * per_depth, 1.0));
}
