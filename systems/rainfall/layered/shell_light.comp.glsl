#version 450 core
// What the layered composite needs and what changes slowly over the picture, at a sixteenth of its resolution: light on
// the drops of each part of each shell, and the haze of what is too fine to be drawn singly, summed from the eye on.
layout(local_size_x = 8, local_size_y = 8) in;
#include "systems/frame.glsl"
#include "systems/rainfall/layered/layered_shared.h"
#include "systems/drops/ambient.glsl"
#include "systems/rainfall/light_volume.glsl"
#include "systems/occlusion/occlusion.glsl"
layout(rgba16f, binding = 0) writeonly uniform image2DArray drop_light;  // shells x parts; output units (1 is white)
layout(rgba16f, binding = 1) writeonly uniform image2DArray haze;  // shells + 1: before each shell's end; a: opacity
uniform vec3 ray_corner, ray_x, ray_y;       // ray of a place of the picture (0 to 1), one metre deep
uniform float edges[LAYERED_SHELLS + 1];     // m
uniform float opacities[LAYERED_SHELLS];     // of the haze of each shell
uniform int shell_count;
uniform bool use_lamps, use_shelter;
uniform float near_opacity;                  // of all that is nearer than the first shell

vec3 light_between(vec2 place, vec3 around, float from, float to) {
  vec3 light = around;
  if (use_lamps) light += 0.5 * (drop_lamps(place, mix(from, to, 0.25)) + drop_lamps(place, mix(from, to, 0.75)));
  return min(light, vec3(6e4));
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = imageSize(haze).xy;
  if (any(greaterThanEqual(at, size))) return;
  vec2 place = (vec2(at) + 0.5) / vec2(size);
  vec3 ray = normalize(ray_corner + place.x * ray_x + place.y * ray_y);
  vec3 around = drop_ambient(ray) * frame.lens.w;
  float open = use_shelter ? 1.0 - shelter(ray * 0.5 * edges[0]) : 1.0;
  vec4 sum = open * near_opacity * vec4(light_between(place, around, 0.0, edges[0]), 1.0);
  imageStore(haze, ivec3(at, 0), sum);
  for (int shell = 0; shell < shell_count; ++shell) {
    for (int part = 0; part < LAYERED_PARTS; ++part) {
      float from = mix(edges[shell], edges[shell + 1], float(part) / float(LAYERED_PARTS));
      float to = mix(edges[shell], edges[shell + 1], float(part + 1) / float(LAYERED_PARTS));
      vec3 light = light_between(place, around, from, to);
      imageStore(drop_light, ivec3(at, shell * LAYERED_PARTS + part), vec4(light, 1.0));
      if (use_shelter) open = 1.0 - shelter(ray * 0.5 * (from + to));
      sum += open * opacities[shell] / float(LAYERED_PARTS) * vec4(light, 1.0);
    }
    imageStore(haze, ivec3(at, shell + 1), sum);
  }
}
