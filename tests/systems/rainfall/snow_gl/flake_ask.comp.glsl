#version 450 core
// Asks flakes where they are: x of a place is the flake's bits, y seconds before the shutter closes; the answer is the
// sway (m) and the frequency (Hz).
#include "systems/rainfall/snow/flake.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 7) buffer Asked { uvec4 asked[]; };
layout(std430, binding = 8) writeonly buffer Answers { vec4 answers[]; };
uniform float diameter;
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= uint(asked.length())) return;
  Flake f = flake_of(asked[i].x, diameter);
  answers[2u * i] = vec4(flake_sway(f, uintBitsToFloat(asked[i].y)), f.turns_per_s);
  answers[2u * i + 1u] = vec4(flake_tumble(f, uintBitsToFloat(asked[i].y)), f.size, float(flake_pieces(f, 0.1)), 0.0);
}
