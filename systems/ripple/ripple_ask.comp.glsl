#version 450 core
// Answers what ripple.glsl says of places, for stages and tests.
layout(local_size_x = 64) in;
#include "systems/ripple/ripple.glsl"

layout(std430, binding = 13) readonly buffer Questions { vec4 questions[]; };  // place; share of the rain
layout(std430, binding = 14) writeonly buffer Answers { vec4 answers[]; };
uniform uint count;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  Ripples r = ripples_at(questions[i].xyz, 1.0, 0.0, questions[i].w);
  answers[i] = vec4(r.slope, r.variance, 0.0);
}
