// Rana's maps: where the rays go that meet each pixel of a drop in the middle of each small cube of the huge cube.
#ifndef SYSTEMS_RAINFALL_NEAR_MAPS_GLSL
#define SYSTEMS_RAINFALL_NEAR_MAPS_GLSL
#include "systems/rainfall/near_drops/near_shared.h"

uniform int cells_aside, map_pixels;

vec3 cell_middle(uint number) {
  uint n = uint(cells_aside);
  vec3 cell = vec3(float(number % n), float(number / n % n), float(number / (n * n)));
  return ((cell + 0.5) / float(cells_aside) - 0.5) * NEAR_CUBE_M;
}

// The image's axes: a camera that looks at the drop, upright.
void image_axes(vec3 d, out vec3 right, out vec3 up) {
  right = normalize(abs(d.y) < 0.999 ? cross(d, vec3(0.0, 1.0, 0.0)) : vec3(1.0, 0.0, 0.0));
  up = cross(right, d);
}

#endif
