#version 450 core
// Draws drips as streaks into the sums that all drops share, DRIP_LANES invocations a drop.
#include "systems/drip/drip_shared.h"
layout(local_size_x = DRIP_GROUP) in;
#include "systems/drip/drip_streak.glsl"
#include "systems/drops/raster.glsl"

uniform uint drip_count;

void main() {
  uint index = gl_GlobalInvocationID.x / uint(DRIP_LANES);
  if (index >= drip_count) return;
  DripGpu drip = drips[index];
  Streak s;
  if (!project_drip(drip, s)) return;
  if (hangs(drip)) s.radius *= sqrt(drip.velocity_stretch.w);  // a disc of the ellipse's area
  drop_bits = drip.bits.x;
  lanes = DRIP_LANES;
  lane = int(gl_GlobalInvocationID.x % uint(DRIP_LANES));
  vec2 span = abs(s.to - s.from);
  float reach = max(span.x, span.y);
  bool capsule = s.radius >= 0.5;
  if (!capsule && reach < 1.0 && lane > 0) return;
#ifdef LAMPS
  float distance_to_eye = length(s.middle);
  drop_light = seen_light(lamps_on(drip, s.middle, distance_to_eye), distance_to_eye);
#endif
  if (capsule) draw_capsule(s.from, s.to, s.depths, s.radius, s.area);
  else if (reach < 1.0) draw_point(s.from, s.to, s.depths, s.area);
  else draw_line(s.from, s.to, s.depths, s.area, taps_of(s.area, reach));
}
