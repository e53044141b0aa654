#version 450 core
// Of the bare stage: depth and normals.
#include "systems/frame.glsl"
#include "systems/geometry/vertex.glsl"
layout(location = 0) out vec3 vertex_normal;

vec3 unit_from_octahedral(vec2 p) {
  vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  float t = max(-n.z, 0.0);
  n.x += n.x >= 0.0 ? -t : t;
  n.y += n.y >= 0.0 ? -t : t;
  return normalize(n);
}

void main() {
  vertex_normal = vertex_normal_matrix() * unit_from_octahedral(in_normal);
  gl_Position = frame.view_projection * vec4(vertex_relative_position(), 1.0);
}
