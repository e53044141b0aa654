#version 450 core
// An even wall at some distance, through what fog stands in for: undrawn rain beyond and between the drawn drops.
layout(local_size_x = 8, local_size_y = 8) in;
#include "systems/geometry/position.glsl"
layout(rgba16f, binding = 0) writeonly uniform image2D colour;
uniform vec3 wall;          // cd/m2
uniform float wall_distance_m;  // along the axis; 0: endless darkness, no fog
uniform vec3 around;        // what drops show, cd/m2

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, ivec2(frame.size.xy)))) return;
  float thickness = 0.0;
  if (wall_distance_m > 0.0) {
    float reach = length(relative_position(vec2(pixel) + 0.5, depth_of_axial_distance(wall_distance_m)));
    thickness = frame.rain.z * reach + frame.rain.x * max(reach - frame.rain.y, 0.0);
  }
  imageStore(colour, pixel, vec4(mix(around, wall, exp(-thickness)), 1.0));
}
