#version 450 core
#include "systems/frame.glsl"
#include "systems/geometry/vertex.glsl"

#define GBUFFER_WRITER
#include "systems/geometry/gbuffer.glsl"

layout(location = 0) out vec3 vertex_normal;
layout(location = 1) out vec4 vertex_tangent;
layout(location = 2) out vec4 vertex_uv;
layout(location = 3) out vec4 vertex_colour;
layout(location = 4) out vec3 vertex_position;

void main() {
  vec3 p = vertex_relative_position();
  vertex_position = p;
  vertex_normal = vertex_normal_matrix() * unit_from_octahedral(in_normal);
  // A mirrored instance turns the handedness of its tangent frame.
  vertex_tangent = vec4(vertex_model_matrix() * in_tangent.xyz, in_tangent.w * vertex_handedness());
  vertex_uv = vec4(in_uv0, in_uv1);
  vertex_colour = in_colour;
  gl_Position = frame.view_projection * vec4(p, 1.0);
}
