#version 450 core
// Lays the drops over the picture, two rows an invocation, and leaves the sums at zero for the next frame.
layout(local_size_x = 32, local_size_y = 2) in;
#include "systems/drops/composite.glsl"

layout(rgba16f, binding = 0) uniform image2D colour;

void main() {
  ivec2 size = ivec2(frame.size.xy);
  ivec2 pixel = ivec2(gl_GlobalInvocationID.x, 2u * gl_GlobalInvocationID.y);
  if (any(greaterThanEqual(pixel, size))) return;
  uint at = gl_GlobalInvocationID.y * uint(size.x) + uint(pixel.x);
  uint units = optical_depth[at];
  if (units != 0u) optical_depth[at] = 0u;
  for (int row = 0; row < 2 && pixel.y < size.y; ++row) {
    uvec3 lamp = uvec3(0u);
    if (lamps) {
      uint i = 4u * (uint(pixel.y) * uint(size.x) + uint(pixel.x));
      lamp = uvec3(radiance[i], radiance[i + 1u], radiance[i + 2u]);
      if ((lamp.r | lamp.g | lamp.b) != 0u) {
        radiance[i] = 0u;
        radiance[i + 1u] = 0u;
        radiance[i + 2u] = 0u;
      }
    }
    vec4 over = rain_over(pixel, row == 0 ? units & 0xffffu : units >> 16u, lamp);
    imageStore(colour, pixel, vec4(imageLoad(colour, pixel).rgb * over.a + over.rgb, 1.0));
    pixel.y += 1;
  }
}
