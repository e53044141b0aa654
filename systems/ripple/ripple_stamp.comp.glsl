#version 450 core
// Adds the seeds of a tick to whole-number sums, one work group a seed. What rounding leaves of a zero-sum seed's volume
// is taken from its cells again, so its sum is exactly 0.
#include "systems/ripple/seed.glsl"

layout(local_size_x = RIPPLE_STAMP_LANES) in;
layout(std430, binding = RIPPLE_SEEDS_BINDING) readonly buffer Seeds { RippleSeedGpu seeds[]; };
layout(std430, binding = RIPPLE_STAMPS_BINDING) buffer Stamps { int stamps[]; };
uniform int cells;     // per side
uniform int first_seed;
uniform int repeated;  // the lattice goes round
shared int volume;

void main() {
  RippleSeedGpu seed = seeds[uint(first_seed) + gl_WorkGroupID.x];
  ivec2 low = ivec2(ceil(seed.place.xy - seed.place.w)), high = ivec2(floor(seed.place.xy + seed.place.w));
  ivec2 size = high - low + 1;
  int count = size.x * size.y;
  if (gl_LocalInvocationIndex == 0u) volume = 0;
  barrier();
  int sum = 0;
  for (int i = int(gl_LocalInvocationIndex); i < count; i += RIPPLE_STAMP_LANES) {
    ivec2 cell = low + ivec2(i % size.x, i / size.x);
    sum += int(round(ripple_seed(seed, vec2(cell) - seed.place.xy) * float(RIPPLE_STAMP_ONE)));
  }
  atomicAdd(volume, sum);
  barrier();
  bool balanced = uint(seed.way.z) != RIPPLE_SEED_PUBLISHED;
  int whole = balanced ? volume / count : 0;
  int rest = balanced ? volume - whole * count : 0;  // as many cells give one more
  int sign_of_rest = rest < 0 ? -1 : 1;
  for (int i = int(gl_LocalInvocationIndex); i < count; i += RIPPLE_STAMP_LANES) {
    ivec2 cell = low + ivec2(i % size.x, i / size.x);
    int height = int(round(ripple_seed(seed, vec2(cell) - seed.place.xy) * float(RIPPLE_STAMP_ONE)));
    height -= whole + (i < abs(rest) ? sign_of_rest : 0);
    if (repeated != 0) cell = (cell % cells + cells) % cells;
    if (height != 0 && all(greaterThanEqual(cell, ivec2(0))) && all(lessThan(cell, ivec2(cells))))
      atomicAdd(stamps[cell.y * cells + cell.x], height);
  }
}
