#version 450 core
// One step of the water's surface as a membrane, z_tt = c^2 lap z - 2 b z_t (Tatarchuk and Isidoro 2006, section 4;
// shared physics, section 5). Held are z and its increment w over the last step: Verlet's scheme, whose increments keep
// their digits where the difference of two heights would lose them. Planes of the state: z, w, and of the near tile the
// age in steps of what stands in a cell.
#include "systems/ripple/ripple_shared.h"

layout(local_size_x = RIPPLE_GROUP, local_size_y = RIPPLE_GROUP) in;
layout(std430, binding = RIPPLE_STATE_BINDING) readonly buffer State { float state[]; };
layout(std430, binding = RIPPLE_NEXT_BINDING) writeonly buffer Next { float next[]; };
layout(std430, binding = RIPPLE_STAMPS_BINDING) buffer Stamps { int stamps[]; };
uniform int cells;
uniform ivec2 shift;     // the near tile has moved by so many cells
uniform vec4 laplacian;  // weights of straight and slanting neighbours, of the middle; w: Courant number squared
uniform vec4 losses;     // share of w that is lost in a step; pull of the level; this step's length by the last one's; 0
uniform int euler;       // 1: forward Euler, both from old values
uniform int quantised;   // 1: 16 bits, as published
uniform int stamped;     // there are seeds

#ifdef NEAR
// Beyond the tile the water is at rest.
float height(ivec2 cell) {
  bool inside = all(greaterThanEqual(cell, ivec2(0))) && all(lessThan(cell, ivec2(cells)));
  ivec2 held = clamp(cell, ivec2(0), ivec2(cells - 1));
  return inside ? state[held.y * cells + held.x] : 0.0;
}
#else
float height(ivec2 cell) {
  ivec2 held = cell & (cells - 1);  // a power of two
  return state[held.y * cells + held.x];
}
#endif

void main() {
  ivec2 here = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(here, ivec2(cells)))) return;
  ivec2 at = here + shift;
  int index = here.y * cells + here.x, plane = cells * cells;
  float z = height(at);
  float straight = height(at + ivec2(1, 0)) + height(at - ivec2(1, 0)) + height(at + ivec2(0, 1)) + height(at - ivec2(0, 1));
  float slanting = height(at + ivec2(1, 1)) + height(at - ivec2(1, 1)) + height(at + ivec2(1, -1)) + height(at + ivec2(-1, 1));
  float pull = laplacian.w * (laplacian.x * straight + laplacian.y * slanting + laplacian.z * z) - losses.y * z;
  float lost = losses.x;
#ifdef NEAR
  bool inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(cells)));
  int from = clamp(at.y, 0, cells - 1) * cells + clamp(at.x, 0, cells - 1);
  float w = inside ? state[plane + from] : 0.0;
  next[2 * plane + index] = inside ? state[2 * plane + from] + 1.0 : 0.0;
  // Towards its edge the tile swallows waves, lest they come back.
  vec2 middle = abs(vec2(here) + 0.5 - 0.5 * float(cells));
  float edge = clamp(1.0 - (0.5 * float(cells) - max(middle.x, middle.y)) / 14.0, 0.0, 1.0);
  lost = lost + (1.0 - lost) * 0.25 * edge * edge;
#else
  float w = state[plane + index];
#endif
  w *= losses.z;
  float increment = (1.0 - lost) * w + pull;
  float level = z + (euler != 0 ? w : increment);
  if (stamped != 0) {
    level += float(stamps[index]) / float(RIPPLE_STAMP_ONE);
    stamps[index] = 0;
  }
  if (quantised != 0) {
    // Two fixed-point numbers of 16 bits, +-16 mm.
    const float one = 32767.0 / 0.016;
    level = round(clamp(level * one, -32767.0, 32767.0)) / one;
    increment = round(clamp(increment * one, -32767.0, 32767.0)) / one;
  }
  if (euler != 0) {
    // It blows up at every step size; this keeps it from infinities alone.
    level = clamp(level, -0.01, 0.01);
    increment = clamp(increment, -0.01, 0.01);
  }
  next[index] = level;
  next[plane + index] = increment;
}
