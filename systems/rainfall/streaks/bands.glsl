// Bands along a drop's streak, from the streak table: whoever draws drops packs them, whoever draws streaks reads them.
// Their mean over all drops is 1, so that streaks with and without are equally bright. Only of the strongest lamp: the
// others' bands lie elsewhere and wash out.
#ifndef SYSTEMS_RAINFALL_STREAKS_BANDS_GLSL
#define SYSTEMS_RAINFALL_STREAKS_BANDS_GLSL
#include "systems/frame.glsl"
#include "systems/drops/rain_shared.h"
#include "systems/rainfall/streaks/streak_table.glsl"

const float least_band_pixels = 4.0;
const float least_band_shine = 1.0 / 128.0;  // output units, of a pixel of the streak

// Bands in the exposure of a streak that is `reach` pixels long; 0 where they could not be seen. area: of the drop's
// image times the share of the exposure in which it is seen; radius in pixels.
float band_cycles(float diameter_m, float area, float radius, float reach, vec3 light) {
  float kept = min(area / (3.14159265 * radius * radius), 1.0);
  float cycles = streak_bands_hz(diameter_m) * frame.camera_velocity_mps.w * kept;
  float shine = max(light.r, max(light.g, light.b)) * area / (max(reach, 1.0) * max(2.0 * radius, 1.0));
  bool seen = streak_strength > 0.0 && reach >= float(RAIN_LONG_PIXELS) && reach >= least_band_pixels * cycles &&
              shine >= least_band_shine;
  return seen ? cycles : 0.0;
}

// at: of the drop, relative to the camera; to_lamp: unit; share of the drop's light that comes from that lamp.
uvec3 pack_bands(float cycles, vec3 at, vec3 to_lamp, float share) {
  vec3 angles = streak_angles(-normalize(at), to_lamp);
  return uvec3(packHalf2x16(vec2(cycles, share)), packHalf2x16(angles.xy), packHalf2x16(vec2(angles.z, 0.0)));
}

vec3 band_angles = vec3(0.0);
float bands_here = 0.0, band_share = 0.0, band_start = 0.0, band_oscillation = 0.0;

void unpack_bands(uvec3 packed_bands, uint bits) {
  vec2 a = unpackHalf2x16(packed_bands.x);
  bands_here = a.x;
  band_share = a.y;
  band_angles = vec3(unpackHalf2x16(packed_bands.y), unpackHalf2x16(packed_bands.z).x);
  uint h = (bits ^ (bits >> 15u)) * 0x2c1b3c6du;
  h ^= h >> 13u;
  band_start = float(h & 0xffffu) / 65536.0;
  band_oscillation = float(h >> 16u) / 65536.0;
}

// Lamplight at a share of the way from where the shutter opened to where it closed.
vec3 banded(vec3 light, float t) {
  float band = 1.0;
  // A loop, not a branch: software OpenGL would run the branch for every streak.
  for (int once = 0; once < (bands_here > 0.0 ? 1 : 0); ++once) {
    float along = band_start + bands_here * t;
    band = 1.0 + band_share * (streak_table(band_angles, along, band_oscillation + streak_drift * along) - 1.0);
  }
  return light * band;
}

#endif
