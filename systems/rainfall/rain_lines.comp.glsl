#version 450 core
// Draws a list of streaks: on GPUs several invocations a streak, for a near drop makes as much work as thousands of far
// ones; in software OpenGL one, for there the streaks of a list are of similar length.
#ifdef LAMPS
#define BANDS
#endif
#include "systems/drops/raster.glsl"
layout(local_size_x = RAIN_LINES_GROUP) in;

layout(std430, binding = RAIN_STREAKS_BINDING) readonly buffer RainStreaks { RainStreakGpu streaks[]; };
#ifdef SOFTWARE
uniform uint list, list_size;
uniform int taps;
#else
layout(std430, binding = RAIN_COMMAND_BINDING) readonly buffer RainCommand {
  uint groups_x, groups_y, groups_z, cell_count, drops_drawn;
  uint list_count[RAIN_LISTS];
};
#endif

void main() {
#ifdef SOFTWARE
  uint slot = gl_GlobalInvocationID.x;
  if (slot >= list_size) return;
  slot += list * uint(RAIN_STREAK_CAPACITY);
#else
#ifdef CAPSULES
  const uint list = 1u;
  lanes = RAIN_CAPSULE_LANES;
#else
  const uint list = 0u;
  lanes = RAIN_LINE_LANES;
#endif
  uint invocation = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * uint(RAIN_LINES_GROUP) +
                    gl_LocalInvocationID.x;
  lane = int(invocation % uint(lanes));
  uint slot = invocation / uint(lanes);
  if (slot >= min(list_count[list], uint(RAIN_LONG_CAPACITY))) return;
  slot += list * uint(RAIN_LONG_CAPACITY);
#endif
  vec4 from_to = streaks[slot].from_to, depths_area = streaks[slot].depths_area;
  drop_bits = streaks[slot].bits.x;
#ifdef LAMPS
  drop_light = streaks[slot].light.rgb;
  unpack_bands(streaks[slot].bits.yzw, drop_bits);
#endif
#ifdef CAPSULES
  draw_capsule(from_to.xy, from_to.zw, depths_area.xy, depths_area.w, depths_area.z);
#else
#ifndef SOFTWARE
  vec2 span = abs(from_to.zw - from_to.xy);
  int taps = taps_of(depths_area.z, max(span.x, span.y));
#endif
  draw_line(from_to.xy, from_to.zw, depths_area.xy, depths_area.z, taps);
#endif
}
