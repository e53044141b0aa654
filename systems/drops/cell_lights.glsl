// Which lamps light the drops of a cell.
#ifndef SYSTEMS_DROPS_CELL_LIGHTS_GLSL
#define SYSTEMS_DROPS_CELL_LIGHTS_GLSL
#include "systems/frame.glsl"
#include "systems/drops/rain_shared.h"
#include "systems/drops/lamp_light.glsl"
uniform float least_radiance;  // output units: lamps that cannot make a drop of the cell this bright are left out

float phase_at(float sine_of_half_turn) {
  return phase[min(int(clamp(sine_of_half_turn, 0.0, 1.0) * float(RAIN_PHASE_BINS)), RAIN_PHASE_BINS - 1)];
}

// About the largest output radiance that a light can give a drop within `radius` of `centre`: the phase falls with the
// turn but for the rainbow, so its largest is at the least turn, or there.
float light_weight(LightGpu light, vec3 centre, float radius) {
  if (light.cone_shadow.w == 0.0) return 0.0;
  float most = max(light.intensity_radius.r, max(light.intensity_radius.g, light.intensity_radius.b)) * frame.lens.w;
  float away = max(length(centre), 1e-3);
  if (light.direction_kind.w == float(LIGHT_DIRECTIONAL)) {
    float half_turn = sqrt(max(0.5 + 0.5 * dot(light.direction_kind.xyz, centre) / away, 0.0));
    float spread = 0.5 * radius / away;
    return most * max(phase_at(half_turn - spread), phase_at(half_turn + spread));
  }
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
  // Directions to lamp and eye turn by radius / distance across the cell; the sine of half the turn by at most half.
  float half_turn = sqrt(max(0.5 + 0.5 * dot(to_centre, centre) / (max(d, 1e-3) * away), 0.0));
  float spread = 0.5 * radius * (1.0 / max(d, 1e-3) + 1.0 / away);
  return most * max(phase_at(half_turn - spread), phase_at(half_turn + spread)) / (nearest * nearest);
}

// The strongest lamps for drops within `radius` of a place, the strongest first: indices of 16 bits. Returns how many.
int lights_of_cell(vec3 middle, float radius, out uvec4 indices) {
  // Sorted by weight, its upper 16 bits with the index below them: no branches, no array that is indexed by a variable.
  uint kept[RAIN_CELL_LIGHTS];
  for (int j = 0; j < RAIN_CELL_LIGHTS; ++j) kept[j] = 0u;
  for (uint i = 0u; i < min(frame.counts.x, 65536u); ++i) {
    float weight = light_weight(lights[i], middle, radius);
    uint key = weight > least_radiance ? floatBitsToUint(weight) & 0xffff0000u | i : 0u;
    for (int j = 0; j < RAIN_CELL_LIGHTS; ++j) {
      uint more = max(kept[j], key);
      key = min(kept[j], key);
      kept[j] = more;
    }
  }
  int lights_here = 0;
  indices = uvec4(0u);
  for (int j = 0; j < RAIN_CELL_LIGHTS; ++j) {
    indices[j >> 1] |= (kept[j] & 0xffffu) << (16u * uint(j & 1));
    lights_here += kept[j] != 0u ? 1 : 0;
  }
  return lights_here;
}

#endif
