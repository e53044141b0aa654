#version 450 core
// Software OpenGL runs both sides of every branch, so there the drops are first sorted by the work they make: one
// invocation goes through a cell; points are drawn at once, streaks are listed by length for rain_lines.
layout(local_size_x = 32) in;
#include "systems/rainfall/streak.glsl"
#include "systems/drops/raster.glsl"
#include "systems/rainfall/near_drops/near_choice.glsl"
#include "systems/drops/cell_lights.glsl"
#include "systems/drops/streak_lists.glsl"
#include "systems/rainfall/streaks/lamp_bands.glsl"

layout(std430, binding = RAIN_CELLS_BINDING) readonly buffer RainCells { RainCellGpu cells[]; };
uniform uint first_cell, end_cell;

void main() {
  uint index = first_cell + gl_GlobalInvocationID.x;
  if (index >= end_cell) return;
  vec4 corner_edge = cells[index].corner_edge;
  uvec4 cell = cells[index].key;
  RainLayerGpu layer = layers[cell.w];
  uvec3 key;
  uint count = drops_of_cell(layer, cell.xyz, key);
#ifdef LAMPS
  vec3 swept = -layer.velocity_diameter.xyz * frame.camera_velocity_mps.w;
  uvec4 pairs;
  int light_count = lights_of_cell(corner_edge.xyz + 0.5 * corner_edge.w + 0.5 * swept,
                                   0.5 * length(corner_edge.w + abs(swept)), pairs);
  // The few lamps stay in registers: reading them again for every drop would cost more than all the rest.
  LightGpu near_lights[RAIN_CELL_LIGHTS];
  for (int i = 0; i < RAIN_CELL_LIGHTS; ++i) {
    near_lights[i] = lights[i < light_count ? (i & 1) == 0 ? pairs[i >> 1] & 0xffffu : pairs[i >> 1] >> 16u : 0u];
    if (i >= light_count) near_lights[i].intensity_radius.rgb = vec3(0.0);
  }
#endif
  uint drawn = 0u;
  for (uint m = 0u; m < count; ++m) {
    uint bits;
    vec4 place = drop_of_cell(key, m, bits);
    vec3 closed = corner_edge.xyz + corner_edge.w * place.xyz;
    Streak s;
    vec4 falls = layer.velocity_diameter;
    if (!project(closed, place.w, layer.expected.z, falls.xyz, falls.w, s) || hidden(s, falls.xyz)) continue;
    if (shows_world(s.middle, s.radius, bits)) continue;  // near_drops draws it
    drawn += 1u;
    drop_bits = bits;
#ifdef LAMPS
    float distance_to_eye = length(s.middle);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < RAIN_CELL_LIGHTS; ++i) sum += lamp_light(near_lights[i], s.middle, distance_to_eye);
    drop_light = seen_light(sum, distance_to_eye);
#endif
    vec2 span = abs(s.to - s.from);
    float reach = max(span.x, span.y);
#ifdef LAMPS
    float cycles = band_cycles(falls.w, s.area, s.radius, reach, drop_light);
    StrongestLamp strongest = StrongestLamp(vec3(0.0, 1.0, 0.0), 0.0);
    for (int i = 0; i < RAIN_CELL_LIGHTS; ++i) {
      if (cycles == 0.0) break;
      compare_lamp(strongest, near_lights[i], s.middle, distance_to_eye);
    }
    streak_bands = bands_of(strongest, cycles, s.middle, sum);
#endif
    if (s.radius < 0.5 && reach < 1.0) {
      draw_point(s.from, s.to, s.depths, s.area);
    } else {
      list_streak(s, reach, taps_of(s.area, reach) == 2, drop_light, bits);
    }
  }
  if (drawn > 0u) atomicAdd(drops_drawn, drawn);
}
