#version 450 core
// Draws the flakes that are wider than a pixel, several invocations each.
layout(local_size_x = 64) in;
#include "systems/rainfall/snow/disc.glsl"

layout(std430, binding = RAIN_STREAKS_BINDING) readonly buffer RainStreaks { RainStreakGpu discs[]; };
layout(std430, binding = RAIN_COMMAND_BINDING) readonly buffer SnowCommand {
  uint groups_x, groups_y, groups_z, cell_count, flakes_drawn;
  uint disc_count;
};

void main() {
  lanes = SNOW_DISC_LANES;
  uint invocation = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * uint(SNOW_GROUP) + gl_LocalInvocationID.x;
  lane = int(invocation % uint(lanes));
  uint slot = invocation / uint(lanes);
  if (slot >= min(disc_count, uint(SNOW_DISC_CAPACITY))) return;
  vec4 from_to = discs[slot].from_to, depths_area = discs[slot].depths_area;
  drop_bits = discs[slot].bits.x;
#ifdef LAMPS
  drop_light = discs[slot].light.rgb;
#endif
  draw_soft_disc(from_to.xy, from_to.zw, depths_area.xy, depths_area.w, depths_area.z);
}
