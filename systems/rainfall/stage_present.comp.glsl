#version 450 core
// Linear light to an 8-bit picture: exposure and the sRGB curve.
layout(local_size_x = 8, local_size_y = 8) in;
#include "systems/frame.glsl"
layout(binding = 0) uniform sampler2D colour;
layout(rgba8, binding = 0) writeonly uniform image2D picture;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) return;
  vec3 linear = texelFetch(colour, pixel, 0).rgb * frame.lens.w;
  linear = linear / (1.0 + linear);
  imageStore(picture, pixel, vec4(sqrt(linear), 1.0));
}
