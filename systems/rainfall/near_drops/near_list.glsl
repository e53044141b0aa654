// The listed drops, for whoever lights and draws them.
#ifndef SYSTEMS_RAINFALL_NEAR_LIST_GLSL
#define SYSTEMS_RAINFALL_NEAR_LIST_GLSL
#include "systems/frame.glsl"
#include "systems/rainfall/near_drops/near_shared.h"

layout(std430, binding = NEAR_LIST_BINDING) readonly buffer NearList { NearDropGpu drops[]; };
layout(std430, binding = NEAR_COMMAND_BINDING) readonly buffer NearCommand {
  uint command[9];
  uint count, cells_wanted;
};
uniform uint capacity;

// The picture's axes in the world.
vec3 picture_right() { return vec3(frame.view[0][0], frame.view[1][0], frame.view[2][0]); }
vec3 picture_up() { return vec3(frame.view[0][1], frame.view[1][1], frame.view[2][1]); }

// A way in the picture as one in the world across the ray to a drop.
vec3 across(vec2 way, vec3 ray) {
  vec3 w = picture_right() * way.x + picture_up() * way.y;
  return w - ray * dot(w, ray);
}

// Unit, across the streak, to the right (or up): columns of its image are counted along it.
vec2 lateral_of(NearDropGpu drop) {
  vec2 span = drop.from_to.zw - drop.from_to.xy;
  float len = length(span);
  if (len < 1e-4) return vec2(1.0, 0.0);
  vec2 side = vec2(-span.y, span.x) / len;
  return abs(side.x) > 1e-6 ? side * sign(side.x) : vec2(0.0, 1.0);
}

// Streaks show the means of the drop's columns; a drop that hardly moves shows its image.
bool is_streak(NearDropGpu drop) { return distance(drop.from_to.xy, drop.from_to.zw) > 4.0 * drop.depths.w; }

#endif
