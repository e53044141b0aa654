#version 450 core
// Draws one list of streaks of similar length (software OpenGL).
layout(local_size_x = 64) in;
#include "systems/rainfall/raster.glsl"

layout(std430, binding = RAIN_STREAKS_BINDING) readonly buffer RainStreaks { RainStreakGpu streaks[]; };
uniform uint list, list_size;
uniform int taps;

void main() {
  if (gl_GlobalInvocationID.x >= list_size) return;
  RainStreakGpu s = streaks[list * uint(RAIN_STREAK_CAPACITY) + gl_GlobalInvocationID.x];
  dither_state = floatBitsToUint(s.from_to.x) * 0x9e3779b9u + floatBitsToUint(s.from_to.y) * 0x85ebca6bu;
#ifdef LAMPS
  drop_light = s.light.rgb;
#endif
#ifdef CAPSULES
  draw_capsule(s.from_to.xy, s.from_to.zw, s.depths_area.xy, s.depths_area.w, s.depths_area.z);
#else
  draw_line(s.from_to.xy, s.from_to.zw, s.depths_area.xy, s.depths_area.z, taps);
#endif
}
