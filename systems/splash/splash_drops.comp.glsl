#version 450 core
// Goes through the drops of the listed cells for those that may have a splash, by cheap tests alone: what is asked of
// maps and lamps comes after, of the few that are left and side by side.
layout(local_size_x = 64) in;
#include "systems/splash/splash.glsl"

layout(std430, binding = SPLASH_CELLS_BINDING) readonly buffer SplashCells { SplashCellGpu cells[]; };
layout(std430, binding = SPLASH_CANDIDATES_BINDING) writeonly buffer SplashCandidates { uvec2 candidates[]; };
uniform uint cell_capacity, candidate_capacity;

void main() {
  uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  uint index = group * uint(SPLASH_GROUP / SPLASH_CELL_LANES) + gl_LocalInvocationIndex / uint(SPLASH_CELL_LANES);
  if (index >= min(command.cell_groups.w, cell_capacity)) return;
  SplashCellGpu cell = cells[index];
  RainLayerGpu layer = layers[cell.key.w & 0xfffu];
  uint count = cell.key.w >> 16u;
  for (uint m = gl_LocalInvocationIndex % uint(SPLASH_CELL_LANES); m < count; m += uint(SPLASH_CELL_LANES)) {
    SplashChance chance;
    if (!may_splash_here(cell, layer, m, chance)) continue;
    uint slot = atomicAdd(command.candidate_groups.w, 1u);
    if (slot >= candidate_capacity) continue;
    const uint per_row = uint(SPLASH_ROW * SPLASH_GROUP);
    if (slot % per_row == 0u) atomicMax(command.candidate_groups.y, slot / per_row + 1u);
    candidates[slot] = uvec2(index, m);
  }
}
