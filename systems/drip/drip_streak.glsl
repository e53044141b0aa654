// From a drip to its streak on the picture.
#ifndef SYSTEMS_DRIP_STREAK_GLSL
#define SYSTEMS_DRIP_STREAK_GLSL
#include "systems/drip/drip_shared.h"
#include "systems/rainfall/streak.glsl"

layout(std430, binding = DRIPS_BINDING) readonly buffer Drips { DripGpu drips[]; };

// What hangs from an edge or falls past it stands a little before it: places are those of the marks, not of the mesh.
const float edge_bias_m = 0.03;

bool hangs(DripGpu drip) { return drip.velocity_stretch.xyz == vec3(0.0); }

bool project_drip(DripGpu drip, out Streak s) {
  bool seen = project(drip.place_width.xyz, 0.0, 1.0, drip.velocity_stretch.xyz, drip.place_width.w, s);
  s.area *= drip.velocity_stretch.w;  // where it moves: of a longer way
  s.depths *= 1.0 + edge_bias_m * s.depths / frame.camera_world_m.w;
  return seen;
}

#ifdef LAMPS
layout(std430, binding = DRIP_LAMPS_BINDING) readonly buffer DripLamps { DripLampsGpu lamps_of[]; };

LightGpu lamp_of(DripLampsGpu here, int i) {
  uint pair = here.lights[i >> 1];
  return lights[(i & 1) == 0 ? pair & 0xffffu : pair >> 16u];
}

// Of all lamps, cd/m2 at the drop.
vec3 lamps_on(DripGpu drip, vec3 at, float distance_to_eye) {
  DripLampsGpu here = lamps_of[drip.bits.y];
  vec3 sum = vec3(0.0);
  for (int i = 0; i < RAIN_CELL_LIGHTS; ++i) {
    if (i >= int(here.count.x)) break;
    sum += lamp_light(lamp_of(here, i), at, distance_to_eye);
  }
  return sum;
}
#endif

#endif
