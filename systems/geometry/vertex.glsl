// What a vertex shader over draw_instances gets. Depth-only draws feed position and instance alone.
#ifndef SYSTEMS_GEOMETRY_VERTEX_GLSL
#define SYSTEMS_GEOMETRY_VERTEX_GLSL
#include "systems/frame_shared.h"

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec2 in_normal;   // octahedral
layout(location = 2) in vec4 in_tangent;  // w: handedness
layout(location = 3) in vec2 in_uv0;
layout(location = 4) in vec2 in_uv1;
layout(location = 5) in vec4 in_colour;
// The instance's matrix by rows, object -> camera-relative world. Attributes that advance per instance, not a
// buffer: software OpenGL reads buffers lane by lane, which cost half of all vertex work.
layout(location = 6) in vec4 in_row_x;
layout(location = 7) in vec4 in_row_y;
layout(location = 8) in vec4 in_row_z;

// Metres relative to the camera.
vec3 vertex_relative_position() {
  vec4 p = vec4(in_position, 1.0);
  return vec3(dot(in_row_x, p), dot(in_row_y, p), dot(in_row_z, p));
}

mat3 vertex_model_matrix() { return transpose(mat3(in_row_x.xyz, in_row_y.xyz, in_row_z.xyz)); }

// -1 where the instance mirrors.
float vertex_handedness() { return dot(in_row_x.xyz, cross(in_row_y.xyz, in_row_z.xyz)) < 0.0 ? -1.0 : 1.0; }

// Turns normals: the cofactors, which are the inverse transpose times the determinant. No division, so a flattened
// object is well defined. Not of unit length.
mat3 vertex_normal_matrix() {
  mat3 m = vertex_model_matrix();
  return mat3(cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])) * vertex_handedness();
}

#endif
