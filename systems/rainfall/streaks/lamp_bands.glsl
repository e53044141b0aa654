// Which lamp a drop's bands are of. Include after streak.glsl, with LAMPS.
#ifndef SYSTEMS_RAINFALL_STREAKS_LAMP_BANDS_GLSL
#define SYSTEMS_RAINFALL_STREAKS_LAMP_BANDS_GLSL
#ifdef LAMPS
#include "systems/rainfall/streaks/bands.glsl"

struct StrongestLamp {
  vec3 to_lamp;  // unit, from the drop
  float light;   // luminance that it gives the drop
};

float luminance_of(vec3 light) { return dot(light, vec3(0.2126, 0.7152, 0.0722)); }

void compare_lamp(inout StrongestLamp strongest, LightGpu light, vec3 at, float distance_to_eye) {
  float shine = luminance_of(lamp_light(light, at, distance_to_eye));
  vec3 to_lamp = light.direction_kind.w == float(LIGHT_DIRECTIONAL) ? -light.direction_kind.xyz
                                                                    : normalize(light.position_range.xyz - at);
  bool more = shine > strongest.light;
  strongest.to_lamp = more ? to_lamp : strongest.to_lamp;
  strongest.light = more ? shine : strongest.light;
}

// sum: light of all lamps, in the units of lamp_light().
uvec3 bands_of(StrongestLamp strongest, float cycles, vec3 at, vec3 sum) {
  if (cycles == 0.0 || strongest.light <= 0.0) return uvec3(0u);
  return pack_bands(cycles, at, strongest.to_lamp, min(strongest.light / max(luminance_of(sum), 1e-20), 1.0));
}
#endif

#endif
