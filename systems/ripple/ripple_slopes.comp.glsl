#version 450 core
// Slopes of the lattice by Sobel's filter (Tatarchuk and Isidoro 2006, section 4), into a layer of `ripples`: layer 0
// slopes, height and their squares' sum; layer 1 (NEAR) slopes, and how full of waves the cell is by its age.
#include "systems/ripple/ripple_shared.h"

layout(local_size_x = RIPPLE_GROUP, local_size_y = RIPPLE_GROUP) in;
layout(std430, binding = RIPPLE_STATE_BINDING) readonly buffer State { float state[]; };
layout(binding = 0, rgba16f) uniform image2D ripples_image;
uniform int cells;
uniform float back;     // of the last step that has not gone by yet, 0 to 1
uniform float inverse;  // 1 / (8 cells' edges)
uniform float fill;     // of slopes' variance in a step, the exponent
uniform float strength;
uniform int add;        // to what stands there

float height(ivec2 cell) {
#ifdef NEAR
  ivec2 held = clamp(cell, ivec2(0), ivec2(cells - 1));
#else
  ivec2 held = cell & (cells - 1);
#endif
  int index = held.y * cells + held.x;
  return state[index] - back * state[cells * cells + index];
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, ivec2(cells)))) return;
  float a = height(at + ivec2(-1, -1)), b = height(at + ivec2(0, -1)), c = height(at + ivec2(1, -1));
  float d = height(at + ivec2(-1, 0)), e = height(at), f = height(at + ivec2(1, 0));
  float g = height(at + ivec2(-1, 1)), h = height(at + ivec2(0, 1)), i = height(at + ivec2(1, 1));
  vec2 slope = vec2(c + 2.0 * f + i - (a + 2.0 * d + g), g + 2.0 * h + i - (a + 2.0 * b + c)) * inverse * strength;
#ifdef NEAR
  float age = state[2 * cells * cells + at.y * cells + at.x];
  imageStore(ripples_image, at, vec4(slope, 1.0 - exp(-fill * age), e * strength));
#else
  vec4 kept = add != 0 ? imageLoad(ripples_image, at) : vec4(0.0);
  slope += kept.xy;
  imageStore(ripples_image, at, vec4(slope, kept.z + e * strength, dot(slope, slope)));
#endif
}
