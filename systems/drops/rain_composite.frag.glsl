#version 450 core
// As rain_composite.comp, by blending: software OpenGL stores images slowly. The sums are cleared afterwards.
#include "systems/drops/composite.glsl"

out vec4 over;

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  uint size_x = uint(frame.size.x);
  uint units = optical_depth[(uint(pixel.y) >> 1u) * size_x + uint(pixel.x)];
  units = (pixel.y & 1) == 0 ? units & 0xffffu : units >> 16u;
  uvec3 lamp = uvec3(0u);
#ifdef LAMPS
  uint i = 4u * (uint(pixel.y) * size_x + uint(pixel.x));
  lamp = uvec3(radiance[i], radiance[i + 1u], radiance[i + 2u]);
#endif
  over = rain_over(pixel, units, lamp);
}
