// The light that lamps give falling drops, in a coarse volume of the view: for techniques that do not know their drops
// one by one. Include, and bind pass rain_light's resource to RAIN_LIGHT_UNIT where the slot has() it.
#ifndef SYSTEMS_RAINFALL_LIGHT_VOLUME_GLSL
#define SYSTEMS_RAINFALL_LIGHT_VOLUME_GLSL
#include "systems/frame.glsl"

#define RAIN_LIGHT_UNIT 14
// Slice s holds the mean of the distances between near * ratio^s and near * ratio^(s + 1), m.
const float rain_light_near_m = 0.5;
const float rain_light_far_m = 64.0;

float rain_light_edge(float slice, float slices) {
  return rain_light_near_m * pow(rain_light_far_m / rain_light_near_m, slice / slices);
}

#ifndef RAIN_LIGHT_WRITER
layout(binding = RAIN_LIGHT_UNIT) uniform sampler2DArray rain_light_volume;

// Output radiance (1 is white) of the disc of a drop at a place of the picture (0 to 1) and a distance from the eye,
// from lamps alone, dimmed by mist and fine rain on the way.
vec3 drop_lamps(vec2 place, float distance_m) {
  float slices = float(textureSize(rain_light_volume, 0).z);
  float slice = log(max(distance_m, 1e-3) / rain_light_near_m) / log(rain_light_far_m / rain_light_near_m) * slices - 0.5;
  slice = clamp(slice, 0.0, slices - 1.0);
  float lower = floor(slice);
  vec3 a = textureLod(rain_light_volume, vec3(place, lower), 0.0).rgb;
  vec3 b = textureLod(rain_light_volume, vec3(place, min(lower + 1.0, slices - 1.0)), 0.0).rgb;
  return mix(a, b, slice - lower);
}
#endif

#endif
