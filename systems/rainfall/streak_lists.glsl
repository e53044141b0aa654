// Streaks sorted by length, for software OpenGL.
#ifndef SYSTEMS_RAINFALL_STREAK_LISTS_GLSL
#define SYSTEMS_RAINFALL_STREAK_LISTS_GLSL
#include "systems/rainfall/rain_shared.h"

// Lists: 0 .. RAIN_LENGTHS-1 faint lines of at least 2^list pixels, as many smooth ones, capsules.
layout(std430, binding = RAIN_COMMAND_BINDING) buffer RainCommand {
  uint groups_x, groups_y, groups_z, cell_count, drops_drawn;
  uint list_count[RAIN_LISTS];
};
layout(std430, binding = RAIN_STREAKS_BINDING) buffer RainStreaks { RainStreakGpu streaks[]; };

void list_streak(Streak s, float reach, vec3 light, bool smooth_line) {
  int list = min(int(log2(reach)), RAIN_LENGTHS - 1) + (smooth_line ? RAIN_LENGTHS : 0);
  if (s.radius >= 0.5) list = RAIN_LISTS - 1;
  uint slot = atomicAdd(list_count[list], 1u);
  if (slot >= uint(RAIN_STREAK_CAPACITY)) return;
  slot += uint(list) * uint(RAIN_STREAK_CAPACITY);
  streaks[slot].from_to = vec4(s.from, s.to);
  streaks[slot].depths_area = vec4(s.depths, s.area, s.radius);
#ifdef LAMPS
  streaks[slot].light = vec4(light, 0.0);
#endif
}

#endif
