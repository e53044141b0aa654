#version 450 core
// Lamplight of each shell's mean: the slices of the volume that lie in it, by their lengths.
layout(local_size_x = 8, local_size_y = 8) in;
#include "systems/rainfall/light_volume.glsl"
layout(rgba16f, binding = 0) writeonly uniform image2DArray shell_light;
uniform float edges[5];

void main() {
  ivec3 at = ivec3(gl_GlobalInvocationID);
  ivec3 size = imageSize(shell_light), slices = textureSize(rain_light_volume, 0);
  if (any(greaterThanEqual(at, size))) return;
  vec3 sum = vec3(0.0);
  float lengths = 0.0;
  for (int i = 0; i < slices.z; ++i) {
    // The first slice stands for what is nearer, too.
    float from = i == 0 ? 0.0 : rain_light_edge(float(i), float(slices.z));
    float overlap = min(rain_light_edge(float(i + 1), float(slices.z)), edges[at.z + 1]) - max(from, edges[at.z]);
    if (overlap <= 0.0) continue;
    sum += overlap * texelFetch(rain_light_volume, ivec3(at.xy, i), 0).rgb;
    lengths += overlap;
  }
  imageStore(shell_light, at, vec4(sum / max(lengths, 1e-6), 1.0));
}
