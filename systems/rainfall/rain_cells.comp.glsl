#version 450 core
// Enumerates the cells of every layer's box, keeps those that the view can see, and lists them with the
// count of their drops and the lamps that matter to them.
layout(local_size_x = 64) in;
#include "systems/frame.glsl"
#include "systems/drops/field.glsl"
#include "systems/drops/cell_lights.glsl"

layout(std430, binding = RAIN_CELLS_BINDING) writeonly buffer RainCells { RainCellGpu cells[]; };
layout(std430, binding = RAIN_COMMAND_BINDING) buffer RainCommand {
  uint groups_x, groups_y, groups_z;  // of the splat's indirect dispatch
  uint cell_count;
  uint drops_drawn;
};
uniform uint candidates;
uniform uint capacity;
uniform vec3 distances;      // nearest axial distance, start and end of the fade, m
uniform bool camera_moves;
uniform float sway_diameters;  // how far flakes stray from their places in the field, in diameters; drops do not

// Whether a box (centre, half extent) reaches into the side planes of a clip matrix.
bool touches(mat4 clip, vec3 centre, vec3 extent) {
  mat4 rows = transpose(clip);
  vec4 planes[4] = vec4[](rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1]);
  for (int i = 0; i < 4; ++i) {
    if (dot(planes[i].xyz, centre) + planes[i].w + dot(abs(planes[i].xyz), extent) < 0.0) return false;
  }
  return dot(rows[3].xyz, centre) + rows[3].w + dot(abs(rows[3].xyz), extent) > distances.x;
}

// Whether the view sees the candidate, and what is known of it.
bool examine(uint index, out RainCellGpu result) {
  uint l = find_layer(index);
  RainLayerGpu layer = layers[l];
  uvec3 cell = cell_in_box(layer, index);
  float edge = layer.corner_edge.w;
  vec3 corner = layer.corner_edge.xyz + vec3(cell) * edge;
  result.corner_edge = vec4(corner, edge);

  // The cell's own drops, and where they were when the shutter opened.
  vec3 swept = -layer.velocity_diameter.xyz * frame.camera_velocity_mps.w;
  float strays = sway_diameters * layer.velocity_diameter.w;
  vec3 low = corner + min(swept, 0.0) - strays, high = corner + edge + max(swept, 0.0) + strays;
  vec3 nearest = max(max(corner, -(corner + edge)) - strays, 0.0);
  float reach = layer.expected.z * distances.z;
  if (dot(nearest, nearest) > reach * reach) return false;
  vec3 centre = 0.5 * (low + high), extent = 0.5 * (high - low);
  if (!touches(frame.view_projection, centre, extent) &&
      !(camera_moves && touches(frame.shutter_view_projection, centre, extent))) return false;

#ifdef SOFTWARE  // counts and lamps come in the next pass, which has fewer cells to look at
  result.key = uvec4(cell, l);
#else
  uvec3 key;
  uint count = drops_of_cell(layer, cell, key);
  if (count == 0u) return false;
  int light_count = lights_of_cell(corner + 0.5 * edge + 0.5 * swept, length(extent), result.lights);
  result.key = uvec4(key, count << 16u | uint(light_count) << 12u | l);
#endif
  return true;
}

#ifdef SOFTWARE
void main() {
  uint index = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationID.x;
  RainCellGpu cell;
  if (index >= candidates || !examine(index, cell)) return;
  uint slot = atomicAdd(cell_count, 1u);
  if (slot >= capacity) return;
  cells[slot].corner_edge = cell.corner_edge;
  cells[slot].key = cell.key;
}
#else
shared uint group_cells, group_first;

// One global atomic a work group: a million on one address would take longer than all else here.
void main() {
  uint index = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationID.x;
  if (gl_LocalInvocationIndex == 0u) group_cells = 0u;
  barrier();
  RainCellGpu cell;
  bool seen = index < candidates && examine(index, cell);
  uint slot = 0u;
  if (seen) slot = atomicAdd(group_cells, 1u);
  barrier();
  if (gl_LocalInvocationIndex == 0u && group_cells > 0u) {
    group_first = atomicAdd(cell_count, group_cells);
    const uint per_row = uint(RAIN_COMMAND_WIDTH * (RAIN_SPLAT_GROUP / RAIN_LANES));
    uint last = min(group_first + group_cells, capacity) - 1u;
    if (group_first < capacity && (group_first % per_row == 0u || last / per_row != group_first / per_row)) {
      atomicMax(groups_y, last / per_row + 1u);
    }
  }
  barrier();
  if (seen && group_first + slot < capacity) cells[group_first + slot] = cell;
}
#endif
