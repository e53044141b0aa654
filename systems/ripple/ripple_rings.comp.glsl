#version 450 core
// Rings in closed form: the slope of each at its age and radius, from a table of the exact solution (truth.hpp). Each
// block of cells has its list; no state.
#include "systems/ripple/ripple_shared.h"

layout(local_size_x = RIPPLE_BLOCK, local_size_y = RIPPLE_BLOCK) in;
layout(std430, binding = RIPPLE_SEEDS_BINDING) readonly buffer Rings { vec4 rings[]; };   // x, y m; age s; amplitude m
layout(std430, binding = RIPPLE_STAMPS_BINDING) readonly buffer Lists { uint lists[]; };  // a block: first, count; then rings
layout(std430, binding = RIPPLE_TABLE_BINDING) readonly buffer Table { float table[]; };  // slopes, of amplitude 1
layout(binding = 0, rgba16f) uniform writeonly image2D ripples_image;
uniform int cells;
uniform float cell_m;
uniform float edge_m;     // 0: not repeated
uniform vec2 table_step;  // m, s
uniform float share;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, ivec2(cells)))) return;
  vec2 place = (vec2(at) + 0.5) * cell_m;
  uint block = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  uint first = lists[2u * block], count = lists[2u * block + 1u];
  vec2 slope = vec2(0.0);
  for (uint i = 0u; i < count; ++i) {
    vec4 ring = rings[lists[first + i]];
    vec2 away = place - ring.xy;
    if (edge_m > 0.0) away -= edge_m * round(away / edge_m);
    float r = length(away);
    float row = min(ring.z / table_step.y, float(RIPPLE_TABLE_TIMES) - 1.001);
    float column = r / table_step.x;
    if (column >= float(RIPPLE_TABLE_RADII) - 1.001) continue;
    int j = int(row), k = int(column);
    float u = row - float(j), v = column - float(k);
    int base = j * RIPPLE_TABLE_RADII + k;
    float early = mix(table[base], table[base + 1], v);
    float late = mix(table[base + RIPPLE_TABLE_RADII], table[base + RIPPLE_TABLE_RADII + 1], v);
    slope += away / max(r, 1e-6) * (ring.w * mix(early, late, u));
  }
  slope *= share;
  imageStore(ripples_image, at, vec4(slope, 0.0, dot(slope, slope)));
}
