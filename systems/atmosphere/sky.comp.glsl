#version 450 core
// The sky alone, for frames without surfaces.
#include "systems/geometry/position.glsl"
#include "systems/sky.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba16f) uniform writeonly image2D colour;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, ivec2(frame.size.xy)))) return;
  imageStore(colour, texel, vec4(sky_radiance(view_ray(vec2(texel) + 0.5)), 1.0));
}
