#version 450 core
// Which lamps light the cells of the sprites' box.
layout(local_size_x = 64) in;
#include "systems/rainfall/sprites/sprites_shared.h"
#include "systems/drops/cell_lights.glsl"

layout(std430, binding = SPRITE_LIGHTS_BINDING) writeonly buffer SpriteLights { SpriteLightsGpu light_cells[]; };
uniform float box_m;
uniform int cells_across;

void main() {
  int index = int(gl_GlobalInvocationID.x), n = cells_across;
  if (index >= n * n * n) return;
  vec3 cell = vec3(index % n, index / n % n, index / (n * n));
  vec3 centre = ((cell + 0.5) / float(n) - 0.5) * box_m;
  uvec4 indices;
  int count = lights_of_cell(centre, 0.8660254 * box_m / float(n), indices);
  light_cells[index].lights = indices;
  light_cells[index].count = uvec4(count, 0, 0, 0);
}
