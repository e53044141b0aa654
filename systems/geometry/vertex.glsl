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
layout(location = 6) in uint in_instance;  // advances per instance: gl_InstanceID ignores the base instance

layout(std430, binding = INSTANCES_BINDING) readonly buffer InstanceBlock { InstanceGpu instances[]; };

// Metres relative to the camera.
vec3 vertex_relative_position() { return (instances[in_instance].model * vec4(in_position, 1.0)).xyz; }

// Columns of the cofactor matrix: not unit length.
mat3 vertex_normal_matrix() {
  return mat3(instances[in_instance].normal0.xyz, instances[in_instance].normal1.xyz,
              instances[in_instance].normal2.xyz);
}

#endif
