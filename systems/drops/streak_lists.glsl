// Streaks that another dispatch draws: long ones, and in software OpenGL all but points.
#ifndef SYSTEMS_DROPS_STREAK_LISTS_GLSL
#define SYSTEMS_DROPS_STREAK_LISTS_GLSL
#include "systems/drops/rain_shared.h"

// Lists. Software OpenGL: 0 .. RAIN_LENGTHS-1 faint lines of at least 2^list pixels, as many smooth ones, capsules.
// GPUs: lines, capsules.
layout(std430, binding = RAIN_COMMAND_BINDING) buffer RainCommand {
  uint groups_x, groups_y, groups_z, cell_count, drops_drawn;
  uint list_count[RAIN_LISTS];
  uint list_groups[6];  // x, y, z of the two lists' indirect dispatches (GPUs)
};
layout(std430, binding = RAIN_STREAKS_BINDING) buffer RainStreaks { RainStreakGpu streaks[]; };

uvec3 streak_bands = uvec3(0u);  // of the streak that is listed next: pack_bands() of streaks/bands.glsl, or 0

// False: the list is full.
bool list_streak(Streak s, float reach, bool smooth_line, vec3 light, uint bits) {
#ifdef SOFTWARE
  const uint capacity_each = uint(RAIN_STREAK_CAPACITY);
  int list = min(int(log2(reach)), RAIN_LENGTHS - 1) + (smooth_line ? RAIN_LENGTHS : 0);
  if (s.radius >= 0.5) list = RAIN_LISTS - 1;
#else
  const uint capacity_each = uint(RAIN_LONG_CAPACITY);
  int list = s.radius >= 0.5 ? 1 : 0;
#endif
  uint slot = atomicAdd(list_count[list], 1u);
  if (slot >= capacity_each) return false;
#ifndef SOFTWARE
  // Who opens a row of the dispatch makes it one longer.
  uint per_row = uint(RAIN_COMMAND_WIDTH * RAIN_LINES_GROUP) / uint(list == 1 ? RAIN_CAPSULE_LANES : RAIN_LINE_LANES);
  if (slot % per_row == 0u) atomicMax(list_groups[3 * list + 1], slot / per_row + 1u);
#endif
  slot += uint(list) * capacity_each;
  streaks[slot].from_to = vec4(s.from, s.to);
  streaks[slot].depths_area = vec4(s.depths, s.area, s.radius);
#ifdef LAMPS
  streaks[slot].light = vec4(light, 0.0);
#endif
  streaks[slot].bits = uvec4(bits, streak_bands);
  return true;
}

#endif
