// The heights that a seed adds at an offset from its middle.
#ifndef SYSTEMS_RIPPLE_SEED_GLSL
#define SYSTEMS_RIPPLE_SEED_GLSL
#include "systems/ripple/ripple_shared.h"

float ripple_seed(RippleSeedGpu seed, vec2 offset_cells) {
  float q = dot(offset_cells, offset_cells) / (seed.place.w * seed.place.w);
  if (q >= 1.0) return 0.0;
  uint kind = uint(seed.way.z);
  float fall = (1.0 - q) * (1.0 - q);
  fall *= fall;
  if (kind == RIPPLE_SEED_WAKE) return seed.place.z * fall * dot(seed.way.xy, offset_cells) / seed.place.w;
  if (kind == RIPPLE_SEED_PUBLISHED) {
    // Two rings of a sine that dies away; its volume is not 0.
    float r = sqrt(q);
    return seed.place.z * exp(-3.0 * r) * cos(4.0 * 3.14159265 * r);
  }
  return seed.place.z * fall * (1.0 - 6.0 * q);
}

#endif
