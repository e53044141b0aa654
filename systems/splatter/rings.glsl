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
uniform vec2 shifts[3];      // of the lattice of impacts in each slot, so that its borders are nowhere in particular
uniform vec2 fade_px;         // across a ring: none is drawn; all of it is
uniform int slots;           // before now that may still show: 3; 2 without those whose rings end as the shutter opens

// Diameter of an impact's drop: an even share of each of the splashing sizes about the mean; their mean is the crown's.
float strike_size(float u) { return catcher.crown.y * (0.55 + 0.9 * u); }

// Share of the rain on open level ground that strikes here: the includer's. Asked only where there may be a ring.
float struck_here();

// Optical depth of the rings over a place of the surface (local, m; normal local, unit) on `shells` shells from height
// `first_m` m on, `thickness_m` apart; slide: how far along the surface the view moves for each metre of height.
float rings(vec3 place, vec3 normal, vec3 slide, float first_m, int shells, float thickness_m, float crossing_m) {
  // Told by the plane that the surface faces most; distances are the surface's own, so rings on slopes are round.
  vec3 facing = abs(normal);
  uint axis = facing.y >= 0.55 ? 1u : facing.x > facing.z ? 0u : 2u;
  vec2 flat_place = axis == 1u ? place.xz : axis == 0u ? place.yz : place.xy;
  float widest = 1.45 * catcher.crown.y * float(SPLATTER_REACH);
  float margin = catcher.shells.y;  // a view from the side moves a ring's upper shells over its base
  float cell_m = 2.5 * (widest + margin);
  // In the open and to windward, at most.
  float expected = catcher.crown.x / max(max(facing.x, facing.z), facing.y) * cell_m * cell_m * slot_s;
  // Shelter is asked once, when all rings are known.
  vec3 found = vec3(0.0), marks = vec3(1e9);
  for (int i = 0; i < slots; ++i) {
    uint when = slot - uint(i);
    vec2 at = flat_place / cell_m + shifts[i];
    vec2 cell = floor(at);
    uvec4 bits = random_bits4(uvec4(uint(int(cell.x)), uint(int(cell.y)), when * 4u + axis, catcher.key.x ^ (catcher.key.y << 8u)));
    float mark = unit_float(bits.x);
    if (mark >= 1.5 * expected) continue;
    float diameter = strike_size(unit_float(bits.y));
    float unit_s = diameter / catcher.crown.z, life_s = unit_s * float(SPLATTER_LIFE);
    float born_s = (unit_float(bits.w) - float(i)) * slot_s;
    float to = in_slot_s - born_s, from = max(to - window_s, 0.0);
    if (to <= 0.0 || from >= life_s) continue;
    // Its middle stands where the widest ring fits into the cell.
    float reach = diameter * float(SPLATTER_REACH);
    vec2 room = vec2(float(bits.z & 0xffffu), float(bits.z >> 16u)) / 65536.0;
    vec2 away = (at - cell) * cell_m - mix(vec2(reach + margin), vec2(cell_m - reach - margin), room);
    vec2 slope = axis == 1u ? normal.xz / normal.y : axis == 0u ? normal.yz / normal.x : normal.xy / normal.z;
    float rise = -dot(slope, away);
    vec3 from_middle = axis == 1u ? vec3(away.x, rise, away.y) : axis == 0u ? vec3(rise, away) : vec3(away, rise);
    float most = reach + margin * length(slide);
    if (dot(from_middle, from_middle) > most * most) continue;
    // The mean over the exposure, by the difference of two sums: a ring is blurred as a shutter blurs it.
    vec2 ages = min(vec2(from, to) / life_s, vec2(1.0));
    // Texel centres stand for whole ages and radii: 0 is the first one's, 1 the last one's.
    vec2 half_texel = 0.5 / vec2(SPLATTER_RADII, SPLATTER_AGES), inner = 1.0 - 2.0 * half_texel;
    vec2 y = half_texel.y + ages * inner.y;
    float ring = 0.0;
    for (int k = 0; k < shells; ++k) {
      float height = first_m + float(k) * thickness_m;
      float layer = floor(height / (diameter * float(SPLATTER_HEIGHT)) * float(SPLATTER_SHELLS));
      vec3 here = from_middle + slide * height;
      float r = length(here) / reach;
      if (layer >= float(SPLATTER_SHELLS) || r >= 1.0) continue;
      float x = half_texel.x + r * inner.x;
      ring += max(textureLod(crowns, vec3(x, y.y, layer), 0.0).r - textureLod(crowns, vec3(x, y.x, layer), 0.0).r, 0.0);
    }
    found[i] = ring * life_s / max(window_s, 1e-5) * crossing_m / diameter;
    marks[i] = mark;
  }
  if (found.x + found.y + found.z <= 0.0) return 0.0;
  float sum = dot(found, vec3(lessThan(marks, vec3(expected * struck_here()))));
  return sum * catcher.shells.z;
}

#endif
