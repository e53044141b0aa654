// Which drops of the field show the world. The field leaves out those that near_drops draws.
#ifndef SYSTEMS_RAINFALL_NEAR_CHOICE_GLSL
#define SYSTEMS_RAINFALL_NEAR_CHOICE_GLSL

uniform vec4 near_choice;  // x: share of the drops; least radius of the image, px; least distance, m; half the cube, m

// By the drop's own bits, so that a drop does not change over while the share stands still.
bool shows_world(vec3 place, float radius_px, uint bits) {
  uint h = bits * 0x9e3779b1u;
  h ^= h >> 15u;
  vec3 a = abs(place);
  return radius_px >= near_choice.y && float(h >> 8u) < near_choice.x * 16777216.0 &&
         dot(place, place) >= near_choice.z * near_choice.z && max(a.x, max(a.y, a.z)) < near_choice.w;
}

#endif
