#version 450 core
// An even wall at some distance, through what stands in for undrawn rain: extinction, and the lamps' light that its
// drops would show, by the same phase function and the same coefficient.
layout(local_size_x = 8, local_size_y = 8) in;
#include "systems/geometry/position.glsl"
#include "systems/drops/lamp_light.glsl"
layout(rgba16f, binding = 0) writeonly uniform image2D colour;
uniform vec3 wall;              // cd/m2
uniform float wall_distance_m;  // along the axis
uniform vec3 around;            // what drops show without lamps, cd/m2

// Extinction of undrawn rain at a place.
float undrawn(float x) {
  float sum = frame.rain.z;
  for (uint i = 0u; i < frame.counts.z; ++i) sum += dot(step(frame.rain_onsets[i].yw, vec2(x)), frame.rain_onsets[i].xz);
  return sum;
}

// Equiangular steps about the lamp (Kulla and Fajardo 2012): x = c + h tan(eta).
vec3 glow(LightGpu light, vec3 ray, float reach) {
  const int steps = 48;
  float c = dot(light.position_range.xyz, ray);
  float h = max(length(cross(light.position_range.xyz, ray)), light.intensity_radius.w);
  float first = atan(-c / h), last = atan((reach - c) / h);
  float sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    float eta = mix(first, last, (float(i) + 0.5) / float(steps));
    float x = c + h * tan(eta), d2 = h * h / (cos(eta) * cos(eta));
    float scattering = undrawn(x);
    float cosine = -(x - c) * inversesqrt(d2);
    float ratio = d2 / (light.position_range.w * light.position_range.w);
    float window = clamp(1.0 - ratio * ratio, 0.0, 1.0);
    sum += scattering * window * window * drop_phase(cosine) * exp(-undrawn_rain_depth(x));
  }
  return light.intensity_radius.rgb * (sum * (last - first) / (float(steps) * h));
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) return;
  vec3 place = relative_position(vec2(pixel) + 0.5, depth_of_axial_distance(wall_distance_m));
  float reach = length(place);
  vec3 light = mix(around, wall, exp(-undrawn_rain_depth(reach)));
  for (uint i = 0u; i < frame.counts.x; ++i) light += glow(lights[i], place / reach, reach);
  imageStore(colour, pixel, vec4(light, 1.0));
}
