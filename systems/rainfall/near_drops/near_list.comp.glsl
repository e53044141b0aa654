#version 450 core
// Goes through the cells of the field near the eye and lists the drops that show the world; a work group a cell.
layout(local_size_x = 32) in;  // NEAR_LANES
#include "systems/rainfall/streak.glsl"
#include "systems/rainfall/near_drops/near_choice.glsl"
#include "systems/rainfall/near_drops/near_shared.h"

layout(std430, binding = NEAR_LIST_BINDING) writeonly buffer NearList { NearDropGpu drops[]; };
layout(std430, binding = NEAR_COMMAND_BINDING) buffer NearCommand {
  uint draw_x, draw_y, draw_z;     // a group a drop
  uint light_x, light_y, light_z;  // four invocations a drop
  uint cell_x, cell_y, cell_z;     // a group a cell to be made anew
  uint count, cells_wanted;
};
layout(std430, binding = NEAR_CELLS_BINDING) buffer NearCells { uint stamps[]; };  // per cell; then the list
uniform uint candidates, capacity, stamp;
uniform int cells_aside;     // of maps
uniform float maps_share;

bool in_view(vec3 low, vec3 high, mat4 clip) {
  vec3 centre = 0.5 * (low + high), extent = 0.5 * (high - low);
  mat4 rows = transpose(clip);
  vec4 planes[4] = vec4[](rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1]);
  for (int i = 0; i < 4; ++i)
    if (dot(planes[i].xyz, centre) + planes[i].w + dot(abs(planes[i].xyz), extent) < 0.0) return false;
  return dot(rows[3].xyz, centre) + rows[3].w + dot(abs(rows[3].xyz), extent) > distances.x;
}

void main() {
  uint index = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  if (index >= candidates) return;
  uint l = find_layer(index);
  RainLayerGpu layer = layers[l];
  uvec3 cell = cell_in_box(layer, index);
  float edge = layer.corner_edge.w;
  vec3 corner = layer.corner_edge.xyz + vec3(cell) * edge;
  vec3 swept = -layer.velocity_diameter.xyz * frame.camera_velocity_mps.w;
  vec3 low = corner + min(swept, 0.0), high = corner + edge + max(swept, 0.0);
  if (!in_view(low, high, frame.view_projection) && !in_view(low, high, frame.shutter_view_projection)) return;
  uvec3 key;
  uint count_here = drops_of_cell(layer, cell, key);
  for (uint m = gl_LocalInvocationIndex; m < count_here; m += uint(NEAR_LANES)) {
    uint bits;
    vec4 at = drop_of_cell(key, m, bits);
    Streak s;
    vec4 falls = layer.velocity_diameter;
    if (!project(corner + edge * at.xyz, at.w, layer.expected.z, falls.xyz, falls.w, s)) continue;
    if (!shows_world(s.middle, s.radius, bits) || hidden(s, falls.xyz)) continue;
    uint slot = atomicAdd(count, 1u);
    if (slot >= capacity) continue;
    if (slot % uint(NEAR_ROW) == 0u) atomicMax(draw_y, slot / uint(NEAR_ROW) + 1u);
    if (slot % uint(16 * NEAR_ROW) == 0u) atomicMax(light_y, slot / uint(16 * NEAR_ROW) + 1u);
    uint map = 0u;
    if (maps_share > 0.0 && float(bits * 0x85ebca6bu >> 8u) < maps_share * 16777216.0) {
      ivec3 c = ivec3(floor((s.middle / NEAR_CUBE_M + 0.5) * float(cells_aside)));
      c = clamp(c, ivec3(0), ivec3(cells_aside - 1));
      uint number = uint((c.z * cells_aside + c.y) * cells_aside + c.x);
      map = number + 1u;
      // Who comes first has the cell made; what it shows is the same whoever that is.
      if (atomicExchange(stamps[number], stamp) != stamp) {
        uint wanted = atomicAdd(cells_wanted, 1u);
        stamps[uint(cells_aside * cells_aside * cells_aside) + wanted] = number;
        if (wanted % uint(NEAR_ROW) == 0u) atomicMax(cell_y, wanted / uint(NEAR_ROW) + 1u);
      }
    }
    float columns = s.radius < 1.0 ? 4.0 : s.radius < 2.0 ? 8.0 : float(NEAR_COLUMNS);
    drops[slot].from_to = vec4(s.from, s.to);
    drops[slot].depths = vec4(s.depths, s.area, s.radius);
    drops[slot].place = vec4(s.middle, columns);
    drops[slot].bits = uvec4(bits, map, 0u, 0u);
  }
}
