// A flake wider than a pixel: a soft disc, denser in the middle, that moves from one place to the other.
#ifndef SYSTEMS_RAINFALL_SNOW_DISC_GLSL
#define SYSTEMS_RAINFALL_SNOW_DISC_GLSL
#include "systems/drops/raster.glsl"
#include "systems/rainfall/snow/snow_shared.h"

// Coverage 1 - r^2 / R^2 times such a factor that its sum is `area`, in pixels; its mean over the way is closed form.
// radius: of the flake. Each lane draws every lanes-th row.
void draw_soft_disc(vec2 from, vec2 to, vec2 depths, float radius, float area) {
  // No denser than a flake that hides all: such a small one is drawn larger.
  float r = max(radius + SNOW_FILTER, sqrt(area * 0.67));
  float middle_cover = area * 0.63661977 / (r * r);
  vec2 span = to - from;
  float len = length(span);
  vec2 along = len > 0.05 ? span / len : vec2(0.0, 1.0);
  ivec2 low = ivec2(max(floor(min(from, to) - r), 0.0)), high = ivec2(min(ceil(max(from, to) + r), frame.size.xy - 1.0));
  for (int y = low.y + lane; y <= high.y; y += lanes) {
    seed_dither(y);
    // The row's part of the band round the way, so that a long slanted one does not visit its whole box.
    float dy = float(y) + 0.5 - from.y;
    float steep = abs(along.y);
    float reach_low = float(low.x), reach_high = float(high.x);
    if (steep > 0.1) {
      float at = from.x + dy * along.x / along.y, half_width = r / steep;
      reach_low = max(reach_low, floor(at - half_width)), reach_high = min(reach_high, ceil(at + half_width));
    }
    for (int x = int(reach_low); x <= int(reach_high); ++x) {
      vec2 offset = vec2(x, y) + 0.5 - from;
      float s = dot(offset, along), h = offset.x * along.y - offset.y * along.x;
      float chord2 = r * r - h * h;
      if (chord2 <= 0.0) continue;
      float cover;
      if (len > 0.05) {
        float chord = sqrt(chord2);
        float a = max(s - len, -chord), b = min(s, chord);
        if (b <= a) continue;
        cover = (chord2 * (b - a) - (b * b * b - a * a * a) * 0.3333333) / (r * r * len);
      } else {
        cover = (chord2 - s * s) / (r * r);
      }
      if (cover > 0.0)
        add(ivec2(x, y), vec2(depth_of(middle_cover * cover), 0.0),
            mix(depths.x, depths.y, len > 0.05 ? clamp(s / len, 0.0, 1.0) : 0.5));
    }
  }
}

#endif
