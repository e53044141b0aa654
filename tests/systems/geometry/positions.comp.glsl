#version 450 core
// Where the pixels are, by the function that every pass uses.
#include "systems/geometry/gbuffer.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32f) uniform writeonly image2D positions;
void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, ivec2(frame.size.xy)))) return;
  float depth = read_depth(texel);
  imageStore(positions, texel, depth > 0.0 ? vec4(relative_position(vec2(texel) + 0.5, depth), 1.0) : vec4(0.0));
}
