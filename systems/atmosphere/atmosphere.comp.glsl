#version 450 core
// What lies between surfaces and eye: extinction by mist and far rain, and the mist's own light. Modifies colour in
// place.
#include "systems/geometry/position.glsl"
#include "systems/lighting/environment.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D depth_map;
layout(binding = 1) uniform sampler2D airlight;
layout(binding = 0, rgba16f) uniform image2D colour;
uniform vec2 airlight_size;
uniform float airlight_scale;
uniform float mist_height_m;    // of the layer that a ray to the sky passes through
uniform float street_height_m;  // above the camera: so far up the mist is lit by the street, higher by the sky's glow
uniform float reach_m;

// The four nearest airlight pixels, those at the same distance foremost: halos do not leak across edges.
vec3 enlarged_airlight(vec2 pixel, float distance_m) {
  vec2 place = pixel / airlight_scale - 0.5;
  vec2 base = floor(place);
  vec2 f = place - base;
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 offset = ivec2(i & 1, i >> 1);
    vec4 sampled = texelFetch(airlight, clamp(ivec2(base) + offset, ivec2(0), ivec2(airlight_size) - 1), 0);
    float share = (offset.x == 1 ? f.x : 1.0 - f.x) * (offset.y == 1 ? f.y : 1.0 - f.y);
    float weight = (share + 1e-3) / (0.02 + abs(sampled.a - distance_m) / distance_m);
    sum += sampled.rgb * weight;
    weights += weight;
  }
  return sum / weights;
}

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, ivec2(frame.size.xy)))) return;
  float depth = texelFetch(depth_map, texel, 0).r;
  vec3 place = relative_position(vec2(texel) + 0.5, max(depth, 1e-7));
  float squared = dot(place, place);
  vec3 ray = place * inversesqrt(squared);
  // Without a surface: through the layer of mist, at most reach_m.
  float distance_m = depth > 0.0 ? sqrt(squared) : min(mist_height_m / max(ray.y, 1e-3), reach_m);
  float thickness = frame.mist.x * distance_m + undrawn_rain_depth(distance_m);
  float passes = exp(-thickness);

  vec3 result = imageLoad(colour, texel).rgb * passes;
  vec3 glow = frame.sky_horizon.rgb * (0.5 * frame.sky_zenith.w);
#ifdef ENVIRONMENT
  float in_street = min(street_height_m / max(ray.y, 1e-3), distance_m);
  float street_passes = exp(-thickness * in_street / distance_m);
  result += (environment_mean() * frame.sky_zenith.w * (1.0 - street_passes) + glow * (street_passes - passes)) *
            frame.mist.yzw;
#else
  result += glow * (1.0 - passes) * frame.mist.yzw;
#endif
#ifdef AIRLIGHT
  result += enlarged_airlight(vec2(texel) + 0.5, min(depth > 0.0 ? distance_m : reach_m, reach_m));
#endif
  imageStore(colour, texel, vec4(result, 1.0));
}
