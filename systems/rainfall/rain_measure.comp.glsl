#version 450 core
// Counts drops of the running field: those that fall through a level square during a step, or those in a box.
layout(local_size_x = 64) in;
#include "systems/drops/field.glsl"

layout(std430, binding = RAIN_COMMAND_BINDING) buffer RainCounts { uint counts[]; };  // by class
uniform uint candidates;
uniform vec3 low, high;  // the square (its y is 0), or the box; relative, m
uniform bool in_box;

void main() {
  uint index = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationID.x;
  if (index >= candidates) return;
  RainLayerGpu layer = layers[find_layer(index)];
  uvec3 cell = cell_in_box(layer, index);
  vec3 corner = layer.corner_edge.xyz + vec3(cell) * layer.corner_edge.w;
  vec3 moved = layer.velocity_diameter.xyz;  // during the step, m
  uvec3 key;
  uint count = drops_of_cell(layer, cell, key);
  uint found = 0u;
  for (uint m = 0u; m < count; ++m) {
    uint bits;
    vec3 now = corner + layer.corner_edge.w * drop_of_cell(key, m, bits).xyz;
    vec3 at = now;
    bool counts_here = true;
    if (!in_box) {
      vec3 before = now - moved;
      counts_here = before.y > 0.0 && now.y <= 0.0;
      at = mix(before, now, before.y / max(before.y - now.y, 1e-9));
      at.y = 0.0;
    }
    if (counts_here && all(greaterThanEqual(at, low)) && all(lessThan(at.xz, high.xz)) && at.y <= high.y) found += 1u;
  }
  if (found > 0u) atomicAdd(counts[uint(layer.first_cell.w) >> 8u], found);
}
