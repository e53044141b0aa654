// Which lamps light the drops of a cell.
#ifndef SYSTEMS_RAINFALL_CELL_LIGHTS_GLSL
#define SYSTEMS_RAINFALL_CELL_LIGHTS_GLSL
#include "systems/frame.glsl"
#include "systems/rainfall/rain_shared.h"
uniform float least_radiance;  // output units: lamps that cannot make a drop of the cell this bright are left out

// Largest output radiance that a light can give a drop within `radius` of `centre` (the phase never exceeds 1.4).
float light_weight(LightGpu light, vec3 centre, float radius) {
  if (light.cone_shadow.w == 0.0) return 0.0;
  float most = max(light.intensity_radius.r, max(light.intensity_radius.g, light.intensity_radius.b)) * 1.4 * frame.lens.w;
  if (light.direction_kind.w == float(LIGHT_DIRECTIONAL)) return most;
  vec3 to_centre = centre - light.position_range.xyz;
  float d = length(to_centre);
  float nearest = d - radius;
  if (nearest > light.position_range.w) return 0.0;
  if (light.direction_kind.w == float(LIGHT_SPOT) && nearest > 0.0) {
    // Outside the cone even at the nearest angle: cos(angle - asin(radius / d)) against the cone's edge.
    float c = dot(to_centre, light.direction_kind.xyz) / d, s = radius / d;
    float nearest_cosine = c * sqrt(1.0 - s * s) + sqrt(max(1.0 - c * c, 0.0)) * s;
    if (nearest_cosine * light.cone_shadow.x + light.cone_shadow.y <= 0.0 && c < sqrt(1.0 - s * s)) return 0.0;
  }
  nearest = max(nearest, 0.1);
  return most / (nearest * nearest);
}

// The strongest lamps for drops within `radius` of a place: indices of 16 bits. Returns how many.
int lights_of_cell(vec3 middle, float radius, out uvec4 indices) {
  uint chosen[RAIN_CELL_LIGHTS];
  float weights[RAIN_CELL_LIGHTS];
  int lights_here = 0;
  for (int i = 0; i < RAIN_CELL_LIGHTS; ++i) chosen[i] = 0u;
  for (uint i = 0u; i < min(frame.counts.x, 65536u); ++i) {
    float weight = light_weight(lights[i], middle, radius);
    if (weight <= least_radiance) continue;
    if (lights_here < RAIN_CELL_LIGHTS) {
      chosen[lights_here] = i;
      weights[lights_here++] = weight;
    } else {
      int weakest = 0;
      for (int j = 1; j < RAIN_CELL_LIGHTS; ++j) if (weights[j] < weights[weakest]) weakest = j;
      if (weight > weights[weakest]) {
        chosen[weakest] = i;
        weights[weakest] = weight;
      }
    }
  }
  indices = uvec4(0u);
  for (int i = 0; i < RAIN_CELL_LIGHTS; ++i) indices[i >> 1] |= chosen[i] << (16u * uint(i & 1));
  return lights_here;
}

#endif
