#version 450 core
// Draws the listed particles as streaks, into the sums that the drop field fills; long streaks, and in software OpenGL
// all but points, are listed by length for rain_lines.
#include "systems/rainfall/sprites/sprites_shared.h"
layout(local_size_x = SPRITE_GROUP) in;
#include "systems/rainfall/streak.glsl"
#include "systems/drops/raster.glsl"
#include "systems/drops/streak_lists.glsl"
#include "systems/rainfall/streaks/lamp_bands.glsl"

layout(std430, binding = SPRITES_BINDING) readonly buffer Sprites { SpriteGpu sprites[]; };
uniform uint first_sprite, end_sprite;
#ifdef LAMPS
layout(std430, binding = SPRITE_LIGHTS_BINDING) readonly buffer SpriteLights { SpriteLightsGpu light_cells[]; };
uniform float box_m;
uniform int cells_across;
uniform vec2 responses;  // to directional lights, and to point and spot lights: his sliders; 1 is true

SpriteLightsGpu lights_near(vec3 at) {
  int n = cells_across;
  ivec3 cell = clamp(ivec3(floor((at / box_m + 0.5) * float(n))), ivec3(0), ivec3(n - 1));
  return light_cells[(cell.z * n + cell.y) * n + cell.x];
}

LightGpu light_of(SpriteLightsGpu here, int i) {
  uint pair = here.lights[i >> 1];
  LightGpu light = lights[(i & 1) == 0 ? pair & 0xffffu : pair >> 16u];
  light.intensity_radius.rgb *= light.direction_kind.w == float(LIGHT_DIRECTIONAL) ? responses.x : responses.y;
  return light;
}
#endif

bool draw_sprite(uint index) {
  SpriteGpu sprite = sprites[index];
  vec3 velocity = uintBitsToFloat(sprite.velocity_bits.xyz);
  uint bits = sprite.velocity_bits.w;
  Streak s;
  if (!project(sprite.place_diameter.xyz, float(bits & 0xffffu) / 65536.0, 1.0, velocity, sprite.place_diameter.w, s) ||
      hidden(s, velocity))
    return false;
  drop_bits = bits;
#ifdef LAMPS
  SpriteLightsGpu here = lights_near(s.middle);
  float distance_to_eye = length(s.middle);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < RAIN_CELL_LIGHTS; ++i) {
    if (i >= int(here.count.x)) break;
    sum += lamp_light(light_of(here, i), s.middle, distance_to_eye);
  }
  drop_light = seen_light(sum, distance_to_eye);
#endif
  vec2 span = abs(s.to - s.from);
  float reach = max(span.x, span.y);
  bool capsule = s.radius >= 0.5;
#ifdef LAMPS
  float cycles = band_cycles(sprite.place_diameter.w, s.area, s.radius, reach, drop_light);
  StrongestLamp strongest = StrongestLamp(vec3(0.0, 1.0, 0.0), 0.0);
  for (int i = 0; i < RAIN_CELL_LIGHTS; ++i) {
    if (i >= int(here.count.x) || cycles == 0.0) break;
    compare_lamp(strongest, light_of(here, i), s.middle, distance_to_eye);
  }
  streak_bands = bands_of(strongest, cycles, s.middle, sum);
#endif
#ifdef SOFTWARE
  if (!capsule && reach < 1.0) draw_point(s.from, s.to, s.depths, s.area);
  else list_streak(s, reach, taps_of(s.area, reach) == 2, drop_light, bits);
#else
  if ((capsule || reach >= float(RAIN_LONG_PIXELS)) && list_streak(s, reach, false, drop_light, bits)) return true;
  if (capsule) draw_capsule(s.from, s.to, s.depths, s.radius, s.area);
  else if (reach < 1.0) draw_point(s.from, s.to, s.depths, s.area);
  else draw_line(s.from, s.to, s.depths, s.area, taps_of(s.area, reach));
#endif
  return true;
}

shared uint group_drops;

void main() {
  if (gl_LocalInvocationIndex == 0u) group_drops = 0u;
  barrier();
  uint index = first_sprite + (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * uint(SPRITE_GROUP) +
               gl_LocalInvocationID.x;
  if (index < min(cell_count, end_sprite) && draw_sprite(index)) atomicAdd(group_drops, 1u);
  barrier();
  if (gl_LocalInvocationIndex == 0u && group_drops > 0u) atomicAdd(drops_drawn, group_drops);
}
