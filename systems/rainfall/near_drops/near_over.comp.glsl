#version 450 core
// Lays near drops over the picture and leaves their sums at zero.
layout(local_size_x = 32, local_size_y = 2) in;
#include "systems/rainfall/near_drops/near_over.glsl"
layout(rgba16f, binding = 0) uniform image2D colour;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) return;
  uint at = uint(pixel.y) * uint(frame.size.x) + uint(pixel.x);
  uvec4 sum = sums[at];
  if (sum == uvec4(0u)) return;
  sums[at] = uvec4(0u);
  vec4 over = near_over(sum);
  imageStore(colour, pixel, vec4(imageLoad(colour, pixel).rgb * over.a + over.rgb, 1.0));
}
