// Rings of splatter on a shell round a marked object: impacts strewn over its surface by random numbers of its own
// space, so that they stay on it as it moves, and a baked crown about each, animated by time.
#ifndef SYSTEMS_SPLATTER_RINGS_GLSL
#define SYSTEMS_SPLATTER_RINGS_GLSL
#include "engine/core/random.glsl"
#include "systems/splatter/catcher.glsl"

// Optical depth of a crown per height, summed over its age: radius, age, height (systems/splatter/crowns.hpp).
layout(binding = 2) uniform sampler2DArray crowns;
uniform uint slot;          // of time, in which impacts are strewn anew
uniform float slot_s;       // its length
uniform float in_slot_s;    // since it began
uniform float window_s;     // the exposure
uniform int slots;           // before now that may still show: 3; 2 without those whose rings end as the shutter opens

// Diameter of an impact's drop: an even share of each of the splashing sizes about the mean; their mean is the crown's.
float strike_size(float u) { return catcher.crown.y * (0.55 + 0.9 * u); }

// Optical depth on a shell `height` m above a place of the surface (local, m), of `thickness`. normal: local, unit.
// per_m2_s: impacts on a square metre of that surface.
float rings(vec3 place, vec3 normal, float height, float thickness, float per_m2_s) {
  // Told by the plane that the surface faces most; distances are the surface's own, so rings on slopes are round.
  vec3 facing = abs(normal);
  uint axis = facing.y >= 0.55 ? 1u : facing.x > facing.z ? 0u : 2u;
  vec2 flat_place = axis == 1u ? place.xz : axis == 0u ? place.yz : place.xy;
  vec2 slope = axis == 1u ? normal.xz / normal.y : axis == 0u ? normal.yz / normal.x : normal.xy / normal.z;
  float widest = 1.45 * catcher.crown.y * float(SPLATTER_REACH);
  float cell_m = 2.5 * widest;
  float expected = per_m2_s / max(max(facing.x, facing.z), facing.y) * cell_m * cell_m * slot_s;
  float sum = 0.0;
  for (int i = 0; i < slots; ++i) {
    uint when = slot - uint(i);
    // The lattice lies elsewhere in each slot, so that its borders are nowhere in particular.
    uvec4 shift = random_bits4(uvec4(when, catcher.key.x, catcher.key.y, axis));
    vec2 at = flat_place / cell_m + vec2(unit_float(shift.x), unit_float(shift.y));
    vec2 cell = floor(at);
    uvec4 bits = random_bits4(uvec4(uint(int(cell.x)), uint(int(cell.y)), when, catcher.key.x ^ (catcher.key.y << 8u)));
    if (unit_float(bits.x) >= expected) continue;
    float diameter = strike_size(unit_float(bits.y));
    float unit_s = diameter / catcher.crown.z;
    float born_s = float(-i) * slot_s + unit_float(bits.w ^ shift.z) * slot_s;
    float to = in_slot_s - born_s, from = max(to - window_s, 0.0);
    if (to <= 0.0 || from >= unit_s * float(SPLATTER_LIFE)) continue;
    // Its middle stands where the widest ring fits into the cell.
    float reach = diameter * float(SPLATTER_REACH);
    vec2 room = vec2(float(bits.z & 0xffffu), float(bits.z >> 16u)) / 65536.0;
    vec2 away = (at - cell) * cell_m - mix(vec2(reach), vec2(cell_m - reach), room);
    float rise = dot(slope, away);
    float r = sqrt(dot(away, away) + rise * rise) / reach;
    if (r >= 1.0) continue;
    // The mean over the exposure, by the difference of two sums: a ring is blurred as a shutter blurs it.
    float layer = height / (diameter * float(SPLATTER_HEIGHT)) * float(SPLATTER_SHELLS);
    if (layer >= float(SPLATTER_SHELLS)) continue;
    vec2 ages = min(vec2(from, to) / (unit_s * float(SPLATTER_LIFE)), vec2(1.0));
    // Texel centres stand for whole ages and radii: 0 is the first one's, 1 the last one's.
    vec2 half_texel = 0.5 / vec2(SPLATTER_RADII, SPLATTER_AGES), inner = 1.0 - 2.0 * half_texel;
    float x = half_texel.x + r * inner.x;
    vec2 y = half_texel.y + ages * inner.y;
    float seen = textureLod(crowns, vec3(x, y.y, floor(layer)), 0.0).r - textureLod(crowns, vec3(x, y.x, floor(layer)), 0.0).r;
    sum += max(seen, 0.0) * unit_s * float(SPLATTER_LIFE) / max(window_s, 1e-5) * thickness / diameter;
  }
  return sum * catcher.shells.z;
}

#endif
