#version 450 core
// Share of each shell's drops that nothing shelters, at an eighth of the picture's resolution.
layout(local_size_x = 8, local_size_y = 8) in;
#include "systems/rainfall/layered/layered_shared.h"
#include "systems/occlusion/occlusion.glsl"
layout(rgba8, binding = 0) writeonly uniform image2D open_share;
uniform vec3 ray_corner, ray_x, ray_y;    // ray of a place of the picture (0 to 1), one metre deep
uniform float edges[LAYERED_SHELLS + 1];  // m
uniform int shell_count;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = imageSize(open_share);
  if (any(greaterThanEqual(at, size))) return;
  vec2 place = (vec2(at) + 0.5) / vec2(size);
  vec3 ray = normalize(ray_corner + place.x * ray_x + place.y * ray_y);
  vec4 open = vec4(1.0);
  for (int shell = 0; shell < shell_count; ++shell) {
    float kept = 0.0;
    for (int i = 0; i < 3; ++i) kept += shelter(ray * mix(edges[shell], edges[shell + 1], (float(i) + 0.5) / 3.0)) / 3.0;
    open[shell] = 1.0 - kept;
  }
  imageStore(open_share, at, open);
}
