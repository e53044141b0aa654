// From pixels to places. Row 0 of every texture is the bottom of the picture (GL_LOWER_LEFT); depth is
// reversed and infinite (1 at the near plane, 0 at infinity: Upchurch and Desbrun 2012), so depth 0 is the sky.
#ifndef SYSTEMS_GEOMETRY_POSITION_GLSL
#define SYSTEMS_GEOMETRY_POSITION_GLSL
#include "systems/frame.glsl"

// pixel: continuous, (0.5, 0.5) is the centre of the first texel.
vec2 ndc_of_pixel(vec2 pixel) { return pixel * frame.size.zw * 2.0 - 1.0; }

// Metres relative to the camera. depth must be > 0.
vec3 relative_position(vec2 pixel, float depth) {
  vec4 p = frame.inverse_view_projection * vec4(ndc_of_pixel(pixel), depth, 1.0);
  return p.xyz / p.w;
}

// Unit direction from the camera through a pixel. (A point at infinity has w = 0.)
vec3 view_ray(vec2 pixel) {
  return normalize((frame.inverse_view_projection * vec4(ndc_of_pixel(pixel), 0.0, 1.0)).xyz);
}

// Metres along the optical axis; depth 0 gives a very far, finite distance.
float axial_distance_m(float depth) { return frame.camera_world_m.w / max(depth, 1e-9); }
float depth_of_axial_distance(float distance_m) { return frame.camera_world_m.w / max(distance_m, 1e-9); }

#endif
