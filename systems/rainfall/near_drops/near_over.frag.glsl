#version 450 core
// As near_over.comp, by blending: software OpenGL stores images slowly. The sums are cleared afterwards.
#include "systems/rainfall/near_drops/near_over.glsl"
out vec4 over;

void main() {
  uvec4 sum = sums[uint(gl_FragCoord.y) * uint(frame.size.x) + uint(gl_FragCoord.x)];
  if (sum.w == 0u) discard;
  over = near_over(sum);
}
