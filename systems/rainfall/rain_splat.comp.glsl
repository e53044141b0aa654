#version 450 core
// Draws the drops of the listed cells, 32 invocations a cell, and lists the long streaks for rain_lines. For GPUs;
// software OpenGL takes rain_drops and rain_lines.
layout(local_size_x = 64) in;
#include "systems/rainfall/streak.glsl"
#include "systems/drops/raster.glsl"
#include "systems/rainfall/near_drops/near_choice.glsl"
#include "systems/drops/streak_lists.glsl"
#include "systems/rainfall/streaks/lamp_bands.glsl"

layout(std430, binding = RAIN_CELLS_BINDING) readonly buffer RainCells { RainCellGpu cells[]; };
uniform uint capacity;
shared uint group_drops;

bool draw_drop(RainCellGpu cell, RainLayerGpu layer, uint m) {
  uint bits;
  vec4 place = drop_of_cell(cell.key.xyz, m, bits);
  vec3 closed = cell.corner_edge.xyz + cell.corner_edge.w * place.xyz;
  Streak s;
  vec4 falls = layer.velocity_diameter;
  if (!project(closed, place.w, layer.expected.z, falls.xyz, falls.w, s) || hidden(s, falls.xyz)) return false;
  if (shows_world(s.middle, s.radius, bits)) return false;  // near_drops draws it
  drop_bits = bits;
#ifdef LAMPS
  float distance_to_eye = length(s.middle);
  vec3 sum = vec3(0.0);
  int lights_here = int(cell.key.w >> 12u & 15u);
  for (int i = 0; i < RAIN_CELL_LIGHTS; ++i) {  // of constant length, so that the cell stays in registers
    if (i >= lights_here) break;
    uint pair = cell.lights[i >> 1];
    sum += lamp_light(lights[(i & 1) == 0 ? pair & 0xffffu : pair >> 16u], s.middle, distance_to_eye);
  }
  drop_light = seen_light(sum, distance_to_eye);
#endif
  vec2 span = abs(s.to - s.from);
  float reach = max(span.x, span.y);
  bool capsule = s.radius >= 0.5;
#ifdef LAMPS
  float cycles = band_cycles(falls.w, s.area, s.radius, reach, drop_light);
  StrongestLamp strongest = StrongestLamp(vec3(0.0, 1.0, 0.0), 0.0);
  for (int i = 0; i < RAIN_CELL_LIGHTS; ++i) {
    if (i >= lights_here || cycles == 0.0) break;
    uint pair = cell.lights[i >> 1];
    compare_lamp(strongest, lights[(i & 1) == 0 ? pair & 0xffffu : pair >> 16u], s.middle, distance_to_eye);
  }
  streak_bands = bands_of(strongest, cycles, s.middle, sum);
#endif
  if ((capsule || reach >= float(RAIN_LONG_PIXELS)) && list_streak(s, reach, false, drop_light, bits)) return true;
  if (capsule) draw_capsule(s.from, s.to, s.depths, s.radius, s.area);
  else if (reach < 1.0) draw_point(s.from, s.to, s.depths, s.area);
  else draw_line(s.from, s.to, s.depths, s.area, taps_of(s.area, reach));
  return true;
}

void main() {
  if (gl_LocalInvocationIndex == 0u) group_drops = 0u;
  barrier();
  uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  uint index = group * uint(RAIN_SPLAT_GROUP / RAIN_LANES) + gl_LocalInvocationIndex / uint(RAIN_LANES);
  uint drawn = 0u;
  if (index < min(cell_count, capacity)) {
    RainCellGpu cell = cells[index];
    RainLayerGpu layer = layers[cell.key.w & 0xfffu];
    uint count = cell.key.w >> 16u;
    for (uint m = gl_LocalInvocationIndex % uint(RAIN_LANES); m < count; m += uint(RAIN_LANES)) {
      if (draw_drop(cell, layer, m)) drawn += 1u;
    }
  }
  if (drawn > 0u) atomicAdd(group_drops, drawn);
  barrier();
  if (gl_LocalInvocationIndex == 0u && group_drops > 0u) atomicAdd(drops_drawn, group_drops);
}
