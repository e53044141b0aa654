#version 450 core
// Fins of mist: a quad on each edge of the outline, pulled out along the normals of its ends (section 3.4).
#include "systems/splatter/catcher.glsl"
#include "systems/occlusion/occlusion.glsl"
uniform bool use_occlusion;
layout(location = 0) in vec4 in_a_depth;
layout(location = 1) in vec4 in_b_depth;
layout(location = 2) in vec4 in_a_normal;
layout(location = 3) in vec4 in_b_normal;
layout(location = 4) in vec4 in_struck;
uniform float length_m;  // as printed; 0: as high as the mist is

layout(location = 0) out vec3 fin_place;
layout(location = 1) out vec2 fin_coordinate;  // along the edge and up, m
layout(location = 2) out float fin_depth;
layout(location = 3) out vec3 fin_lamps;

void main() {
  bool second = (gl_VertexID & 1) == 1, tip = gl_VertexID >= 2;
  vec4 base = second ? in_b_depth : in_a_depth, normal = second ? in_b_normal : in_a_normal;
  float reach = length_m > 0.0 ? length_m : 4.0 * catcher.mist.y;
  fin_place = base.xyz + (tip ? reach : 0.0) * normal.xyz;
  fin_coordinate = vec2(normal.w, tip ? reach : 0.0);
  // Of the face that the rain strikes: none under a roof, more to windward.
  float struck = use_occlusion ? min(deposit(base.xyz + in_struck.xyz * 0.02, in_struck.xyz) / max(in_struck.y, 0.3), 2.0)
                               : clamp(in_struck.y * 4.0, 0.0, 1.0);
  fin_depth = base.w * in_struck.w * (length_m > 0.0 ? 1.0 : struck);  // as printed: no shelter
  fin_lamps = droplet_lamps(fin_place);
  gl_Position = frame.view_projection * vec4(fin_place, 1.0);
}
