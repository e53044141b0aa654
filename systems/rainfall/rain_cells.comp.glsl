#version 450 core
// Enumerates the cells of every layer's box, keeps those that the view can see, and lists them with the
// count of their drops and the lamps that matter to them.
layout(local_size_x = 64) in;
#include "systems/frame.glsl"
#include "systems/rainfall/field.glsl"

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
uniform float least_radiance;  // output units: lamps that cannot make a drop of the cell this bright are left out

// Whether a box (centre, half extent) reaches into the side planes of a clip matrix.
bool touches(mat4 clip, vec3 centre, vec3 extent) {
  mat4 rows = transpose(clip);
  vec4 planes[4] = vec4[](rows[3] + rows[0], rows[3] - rows[0], rows[3] + rows[1], rows[3] - rows[1]);
  for (int i = 0; i < 4; ++i) {
    if (dot(planes[i].xyz, centre) + planes[i].w + dot(abs(planes[i].xyz), extent) < 0.0) return false;
  }
  return dot(rows[3].xyz, centre) + rows[3].w + dot(abs(rows[3].xyz), extent) > distances.x;
}

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

void main() {
  uint index = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationID.x;
  if (index >= candidates) return;
  uint l = find_layer(index);
  RainLayerGpu layer = layers[l];
  uvec3 cell = cell_in_box(layer, index);
  float edge = layer.corner_edge.w;
  vec3 corner = layer.corner_edge.xyz + vec3(cell) * edge;

  // The cell's own drops, and where they were when the shutter opened.
  vec3 swept = -layer.velocity_diameter.xyz * frame.camera_velocity_mps.w;
  vec3 low = corner + min(swept, 0.0), high = corner + edge + max(swept, 0.0);
  vec3 nearest = max(max(corner, -(corner + edge)), 0.0);
  if (dot(nearest, nearest) > distances.z * distances.z) return;
  vec3 centre = 0.5 * (low + high), extent = 0.5 * (high - low);
  if (!touches(frame.view_projection, centre, extent) &&
      !(camera_moves && touches(frame.shutter_view_projection, centre, extent))) return;

  uvec3 key;
  uint count = drops_of_cell(layer, cell, key);
  if (count == 0u) return;

  uint chosen[RAIN_CELL_LIGHTS];
  float weights[RAIN_CELL_LIGHTS];
  int lights_here = 0;
  for (int i = 0; i < RAIN_CELL_LIGHTS; ++i) chosen[i] = 0u;
  vec3 middle = corner + 0.5 * edge + 0.5 * swept;
  float radius = length(extent);
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

  uint slot = atomicAdd(cell_count, 1u);
  if (slot >= capacity) return;
  const uint per_row = uint(RAIN_COMMAND_WIDTH * (RAIN_SPLAT_GROUP / RAIN_LANES));
  if (slot % per_row == 0u) atomicMax(groups_y, slot / per_row + 1u);
  cells[slot].corner_edge = vec4(corner, edge);
  cells[slot].key = uvec4(key, count << 16u | uint(lights_here) << 12u | l);
  cells[slot].lights = uvec4(chosen[0] | chosen[1] << 16u, chosen[2] | chosen[3] << 16u,
                             chosen[4] | chosen[5] << 16u, chosen[6] | chosen[7] << 16u);
}
