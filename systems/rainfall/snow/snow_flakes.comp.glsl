#version 450 core
// The flakes of the listed cells, 32 invocations a cell: small ones are drawn at once, those wider than a pixel are
// listed for snow_discs.
layout(local_size_x = 64) in;
#include "systems/rainfall/streak.glsl"
#include "systems/rainfall/snow/flake.glsl"
#include "systems/rainfall/snow/disc.glsl"

layout(std430, binding = RAIN_CELLS_BINDING) readonly buffer RainCells { RainCellGpu cells[]; };
layout(std430, binding = RAIN_COMMAND_BINDING) buffer SnowCommand {
  uint groups_x, groups_y, groups_z, cell_count, flakes_drawn;
  uint disc_count;
  uint disc_groups_x, disc_groups_y, disc_groups_z;
};
layout(std430, binding = RAIN_STREAKS_BINDING) writeonly buffer RainStreaks { RainStreakGpu discs[]; };
uniform uint capacity;
shared uint group_flakes;

// A piece of the flake's path, from moment u0 to u1 of the exposure (0 opens, 1 closes the shutter); the places are
// relative to the camera as it is when the shutter closes. False: out of the picture.
bool project_piece(vec3 p0, vec3 p1, float u0, float u1, float diameter, float area_m2, out Streak s) {
  vec4 c0 = mix(frame.shutter_view_projection * vec4(p0, 1.0), frame.view_projection * vec4(p0, 1.0), u0);
  vec4 c1 = mix(frame.shutter_view_projection * vec4(p1, 1.0), frame.view_projection * vec4(p1, 1.0), u1);
  float nearest = distances.x;
  bool seen = max(c0.w, c1.w) > nearest;
  float cut0 = c0.w < nearest ? (nearest - c0.w) / (c1.w - c0.w) : 0.0;
  float cut1 = c1.w < nearest ? (nearest - c1.w) / (c0.w - c1.w) : 0.0;
  vec4 a = mix(c0, c1, cut0), b = mix(c1, c0, cut1);
  vec2 inverse_w = 1.0 / vec2(a.w, b.w);
  s.from = (a.xy * inverse_w.x * 0.5 + 0.5) * frame.size.xy;
  s.to = (b.xy * inverse_w.y * 0.5 + 0.5) * frame.size.xy;
  s.middle = 0.5 * (p0 + p1);
  float axial = 0.5 * (a.w + b.w);
  // As of a sphere's image, which grows towards the edge of the picture: solid angle over cosine cubed.
  float scale2 = frame.lens.z * frame.lens.z * length(s.middle) / (axial * axial * axial);
  s.radius = 0.5 * diameter * sqrt(scale2);
  s.area = area_m2 * scale2 * (1.0 - cut0 - cut1);
  s.depths = frame.camera_world_m.w * inverse_w;
  float reach = s.radius + 2.0;
  return seen && all(greaterThan(max(s.from, s.to) + reach, vec2(0.0))) &&
         all(lessThan(min(s.from, s.to) - reach, frame.size.xy));
}

bool list_disc(Streak s, uint bits) {
  uint slot = atomicAdd(disc_count, 1u);
  if (slot >= uint(SNOW_DISC_CAPACITY)) return false;
  const uint per_row = uint(RAIN_COMMAND_WIDTH * SNOW_GROUP / SNOW_DISC_LANES);
  if (slot % per_row == 0u) atomicMax(disc_groups_y, slot / per_row + 1u);
  discs[slot].from_to = vec4(s.from, s.to);
  discs[slot].depths_area = vec4(s.depths, s.area, s.radius);
#ifdef LAMPS
  discs[slot].light = vec4(drop_light, 0.0);
#endif
  discs[slot].bits.x = bits;
  return true;
}

bool draw_flake(RainCellGpu cell, RainLayerGpu layer, uint m) {
  uint bits;
  vec4 place = drop_of_cell(cell.key.xyz, m, bits);
  vec3 still = cell.corner_edge.xyz + cell.corner_edge.w * place.xyz;  // of its helix, when the shutter closes
  vec4 falls = layer.velocity_diameter;
  Flake f = flake_of(bits, falls.w);
  vec3 closed = still + flake_sway(f, 0.0);
  // Farther flakes turn transparent (Chen); beyond, the haze has taken over, and in the mean it adds up.
  float away = length(closed), reach = layer.expected.z;
  float opacity = clamp((reach * distances.z - away) / max(reach * (distances.z - distances.y), 1e-6), 0.0, 1.0);
  if (opacity <= 0.0) return false;
  float exposure = frame.camera_velocity_mps.w;
  float area = layer.expected.w * f.size * flake_tumble(f, 0.5 * exposure) * opacity;
  float diameter = falls.w * sqrt(f.size);
  int pieces = flake_pieces(f, exposure);
  bool drawn = false;
  vec3 p1 = closed;
  for (int i = 0; i < pieces; ++i) {
    float u1 = 1.0 - float(i) / float(pieces), u0 = 1.0 - float(i + 1) / float(pieces);
    float before = (1.0 - u0) * exposure;
    vec3 p0 = still - falls.xyz * before + flake_sway(f, before);
    Streak s;
    bool seen = project_piece(p0, p1, u0, u1, diameter, area / float(pieces), s);
    p1 = p0;
    if (!seen || hidden(s, falls.xyz)) continue;
    drawn = true;
    drop_bits = bits + uint(i) * 0x632be5abu;
#ifdef LAMPS
    float distance_to_eye = length(s.middle);
    vec3 sum = vec3(0.0);
    int lights_here = int(cell.key.w >> 12u & 15u);
    for (int k = 0; k < RAIN_CELL_LIGHTS; ++k) {  // of constant length, so that the cell stays in registers
      if (k >= lights_here) break;
      uint pair = cell.lights[k >> 1];
      sum += lamp_light(lights[(k & 1) == 0 ? pair & 0xffffu : pair >> 16u], s.middle, distance_to_eye);
    }
    drop_light = seen_light(sum, distance_to_eye);
#endif
    if (s.radius >= SNOW_LEAST_DISC) {
      if (!list_disc(s, drop_bits)) draw_soft_disc(s.from, s.to, s.depths, s.radius, s.area);
      continue;
    }
    vec2 span = s.to - s.from;
    float length_px = max(abs(span.x), abs(span.y));
    if (s.area < smooth_coverage) {
      if (length_px < 1.0) draw_point(s.from, s.to, s.depths, s.area);
      else draw_line(s.from, s.to, s.depths, s.area, 1);
    } else {
      // At least a pixel long: shared between the pixels that it lies between, so that slow flakes glide.
      vec2 grown = length_px >= 1.0 ? span : (abs(span.y) >= abs(span.x) ? vec2(span.x, span.y < 0.0 ? -1.0 : 1.0)
                                                                         : vec2(span.x < 0.0 ? -1.0 : 1.0, span.y));
      vec2 middle = 0.5 * (s.from + s.to);
      draw_line(middle - 0.5 * grown, middle + 0.5 * grown, s.depths, s.area, 2);
    }
  }
  return drawn;
}

void main() {
  if (gl_LocalInvocationIndex == 0u) group_flakes = 0u;
  barrier();
  uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  uint index = group * uint(RAIN_SPLAT_GROUP / RAIN_LANES) + gl_LocalInvocationIndex / uint(RAIN_LANES);
  uint drawn = 0u;
  if (index < min(cell_count, capacity)) {
    RainCellGpu cell = cells[index];
    RainLayerGpu layer = layers[cell.key.w & 0xfffu];
    uint count = cell.key.w >> 16u;
    for (uint m = gl_LocalInvocationIndex % uint(RAIN_LANES); m < count; m += uint(RAIN_LANES)) {
      if (draw_flake(cell, layer, m)) drawn += 1u;
    }
  }
  if (drawn > 0u) atomicAdd(group_flakes, drawn);
  barrier();
  if (gl_LocalInvocationIndex == 0u && group_flakes > 0u) atomicAdd(flakes_drawn, group_flakes);
}
