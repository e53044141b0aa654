#version 450 core
// Asks the map about places: w becomes the distance to the first hit, or 2e6 + that where sheltered.
#include "systems/occlusion/occlusion.glsl"
layout(local_size_x = 64) in;
layout(std430, binding = 7) buffer Places { vec4 places[]; };
void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= uint(places.length())) return;
  vec3 p = places[i].xyz;
  places[i] = vec4(first_hit_distance_m(p), sheltered(p) ? 1.0 : 0.0, 0.0, 0.0);
}
