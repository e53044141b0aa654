#version 450 core
// One shell round a marked object: its surface, pushed out along welded normals (Tatarchuk and Isidoro 2006, section
// 3.4, after Lengyel and others 2001).
#include "systems/splatter/catcher.glsl"
#include "systems/occlusion/occlusion.glsl"
uniform bool use_occlusion;
layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
uniform mat4 relative_from_object;
uniform float height_m;

layout(location = 0) out vec3 shell_place;   // relative to the camera
layout(location = 1) out vec3 shell_normal;  // world
layout(location = 2) out float shell_struck;

void main() {
  vec3 base = (relative_from_object * vec4(in_position, 1.0)).xyz;
  mat3 turn = mat3(relative_from_object);
  // Cofactors: right for any scale.
  vec3 normal = normalize(mat3(cross(turn[1], turn[2]), cross(turn[2], turn[0]), cross(turn[0], turn[1])) * in_normal *
                          (determinant(turn) < 0.0 ? -1.0 : 1.0));
  shell_place = base;
  shell_normal = normal;
  shell_struck = use_occlusion ? deposit(base, normal) : max(normal.y, 0.0);
  gl_Position = frame.view_projection * vec4(base + normal * height_m, 1.0);
}
