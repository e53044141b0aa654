#version 450 core
// The streak of a drop: the mean of its image along each column (Rana, "Making streak raindrop", step 1), in closed
// form. Four invocations a drop.
layout(local_size_x = 64) in;
#include "systems/rainfall/near_drops/near_list.glsl"
#include "systems/rainfall/near_drops/near_optics.glsl"

layout(std430, binding = NEAR_PROFILES_BINDING) writeonly buffer NearProfiles { uvec2 profiles[]; };

void main() {
  uint index = (gl_WorkGroupID.y * uint(NEAR_ROW) + gl_WorkGroupID.x) * 16u + gl_LocalInvocationIndex / 4u;
  if (index >= min(count, capacity)) return;
  NearDropGpu drop = drops[index];
  if (drop.bits.y != 0u || !is_streak(drop)) return;
  int columns = int(drop.place.w), first = int(gl_LocalInvocationIndex % 4u);
  vec3 d = normalize(drop.place.xyz), place = drop.place.xyz - captured_from;
  vec2 side = lateral_of(drop);
  vec3 right = normalize(across(side, d)), up = cross(right, d);
  // So many samples leave a fifth of what one colour a drop is wrong by; drops under a pixel need not so many.
  bool tiny = drop.depths.w < 0.5;
  int along = tiny ? 6 : 8, aside = columns == 4 ? (tiny ? 2 : 3) : columns == 8 ? 2 : 1;
  for (int c = first; c < columns; c += 4) {
    vec3 sum = vec3(0.0);
    float weights = 0.0;
    for (int k = 0; k < aside; ++k) {
      float width = 2.0 / float(columns * aside);
      float x = (float(c * aside + k) + 0.5) * width - 1.0;
      float chord = sqrt(1.0 - x * x), area = width * 2.0 * chord / float(along) * 0.6;  // a little sharper than even
      vec3 column = vec3(0.0);
      for (int j = 0; j < along; ++j) {
        float y = chord * ((2.0 * float(j) + 1.0) / float(along) - 1.0);
        float b = max(length(vec2(x, y)), 1e-5);
        column += seen_in_drop(place, d, (right * x + up * y) / b, b, area);
      }
      sum += column * chord;
      weights += chord * float(along);
    }
    sum = min(sum / weights, vec3(6e4));
    profiles[index * uint(NEAR_COLUMNS) + uint(c)] = uvec2(packHalf2x16(sum.rg), packHalf2x16(vec2(sum.b, 0.0)));
  }
}
