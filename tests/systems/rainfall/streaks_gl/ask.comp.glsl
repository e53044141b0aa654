#version 450 core
// Reads the streak table at given places.
layout(local_size_x = 64) in;
#include "systems/rainfall/streaks/streak_table.glsl"
struct Ask { vec4 angles_across, along_oscillation; };
layout(std430, binding = 0) readonly buffer Asks { Ask asks[]; };
layout(std430, binding = 1) writeonly buffer Answers { vec4 answers[]; };
uniform uint count;
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= count) return;
  vec3 angles = asks[i].angles_across.xyz;
  answers[i] = vec4(streak_table(angles, asks[i].along_oscillation.x, asks[i].along_oscillation.y),
                    streak_across(angles, asks[i].angles_across.w), streak_phase(angles, 0.5), 0.0);
}
