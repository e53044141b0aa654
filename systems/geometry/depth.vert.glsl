#version 450 core
// Depth alone, for maps: draw_instances(..., DrawWhat::depth_only or shelter).
#include "systems/geometry/vertex.glsl"

uniform mat4 clip_from_relative;

void main() { gl_Position = clip_from_relative * vec4(vertex_relative_position(), 1.0); }
