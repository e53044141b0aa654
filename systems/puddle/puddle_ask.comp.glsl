#version 450 core
// Asks about standing water at places (PuddleStage).
layout(local_size_x = 64) in;
#include "systems/puddle/puddle.glsl"

layout(std430, binding = 7) readonly buffer Questions { vec4 questions[]; };   // two each: place; mask in xy
layout(std430, binding = 8) writeonly buffer Answers { vec4 answers[]; };  // two each: depth, influence, s_o, theta_o; tint
uniform uint count;

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  StandingWater w = standing_water(questions[2u * i].xyz, questions[2u * i + 1u].xy);
  answers[2u * i] = vec4(w.depth_m, w.influence, w.ripple_scale, w.ripple_turn_rad);
  answers[2u * i + 1u] = vec4(w.tint, 0.0);
}
