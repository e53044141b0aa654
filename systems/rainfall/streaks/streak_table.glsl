// The streak table (table.hpp): how bright an oscillating drop is along and across its streak. Include, and call
// bind_streak_table() of systems/rainfall/streaks/gpu.hpp. Without a table, and where streaks are even, all is 1.
#ifndef SYSTEMS_RAINFALL_STREAKS_STREAK_TABLE_GLSL
#define SYSTEMS_RAINFALL_STREAKS_STREAK_TABLE_GLSL

#define STREAK_TABLE_UNIT 13
#define STREAK_PROFILE_UNIT 12
#define STREAK_PHASE_UNIT 11
// A layer a view, in it a tile for each azimuth (side by side) and elevation of the lamp (one above the other).
// Tiles of along the streak by oscillation, with the first column and row again at their ends, for both repeat:
layout(binding = STREAK_TABLE_UNIT) uniform sampler2DArray streak_modulations;
// Tiles of across the streak, one texel high, and in the last texel the logarithm of the mean:
layout(binding = STREAK_PROFILE_UNIT) uniform sampler2DArray streak_profiles;
layout(binding = STREAK_PHASE_UNIT) uniform sampler2D streak_phases;  // of these drops, by sin(turn / 2)
uniform vec4 streak_table_nodes;    // view, light, azimuth; w: 1 nearest four (Tariq 2007), 2 all angles
uniform vec2 streak_table_size;     // texels along and oscillations
uniform float streak_strength;      // 0: even streaks

// Elevations of eye and lamp over the drop's horizon and the turn between their bearings, 0 to pi; unit vectors from
// the drop.
vec3 streak_angles(vec3 to_eye, vec3 to_lamp) {
  float across = length(to_eye.xz) * length(to_lamp.xz);
  float cosine = across > 1e-6 ? dot(to_eye.xz, to_lamp.xz) / across : 1.0;
  return vec3(asin(clamp(to_eye.y, -1.0, 1.0)), asin(clamp(to_lamp.y, -1.0, 1.0)), acos(clamp(cosine, -1.0, 1.0)));
}

struct StreakEntries {
  ivec3 low, high;
  vec3 share;  // of the high ones
  int count;   // that matter: 4 or 8
};

StreakEntries streak_entries(vec3 angles) {
  bool four = streak_table_nodes.w == 1.0;
  if (four) angles = vec3(0.0, abs(angles.y), angles.z);
  vec3 last = streak_table_nodes.xyz - 1.0;
  vec3 at = clamp((angles + vec3(1.5707963268, 1.5707963268, 0.0)) * 0.3183098862, 0.0, 1.0) * last;
  StreakEntries e;
  e.low = ivec3(min(at, last - 1.0));
  e.high = e.low + 1;
  e.share = at - vec3(e.low);
  if (four) {  // the nearest view of the table to level
    e.low.x += e.share.x > 0.5 ? 1 : 0;
    e.share.x = 0.0;
  }
  e.count = four ? 4 : 8;
  return e;
}

// View, light and azimuth of a corner's entry, and its weight.
ivec3 streak_entry(StreakEntries e, int corner, out float weight) {
  bvec3 high = bvec3((corner & 4) != 0, (corner & 2) != 0, (corner & 1) != 0);
  vec3 w = vec3(high.x ? e.share.x : 1.0 - e.share.x, high.y ? e.share.y : 1.0 - e.share.y,
                high.z ? e.share.z : 1.0 - e.share.z);
  weight = w.x * w.y * w.z;
  return ivec3(high.x ? e.high.x : e.low.x, high.y ? e.high.y : e.low.y, high.z ? e.high.z : e.low.z);
}

// Brightness at a place along the streak over that of the whole cycle: mean 1 over `along` and `oscillation`, both in
// cycles.
float streak_table(vec3 angles, float along, float oscillation) {
  if (streak_strength == 0.0) return 1.0;
  StreakEntries e = streak_entries(angles);
  // Texel k is the value at k, not at k + 0.5.
  vec2 at = fract(vec2(along, oscillation)) * streak_table_size + 0.5;
  vec2 per_texel = 1.0 / vec2(textureSize(streak_modulations, 0).xy), tile = streak_table_size + 1.0;
  float sum = 0.0;
  for (int i = 0; i < e.count; ++i) {
    float weight;
    ivec3 entry = streak_entry(e, i, weight);
    vec2 place = (vec2(entry.zy) * tile + at) * per_texel;
    if (weight > 0.0) sum += weight * textureLod(streak_modulations, vec3(place, float(entry.x)), 0.0).r;
  }
  return mix(1.0, sum, streak_strength);
}

// The same across the streak, -1 to 1, positive on the side of the lamp; mean 1 over a disc.
float streak_across(vec3 angles, float across) {
  if (streak_strength == 0.0) return 1.0;
  StreakEntries e = streak_entries(angles);
  vec2 per_texel = 1.0 / vec2(textureSize(streak_profiles, 0).xy);
  float texels = float(textureSize(streak_profiles, 0).x) / streak_table_nodes.z - 1.0;
  float at = clamp(0.5 * (across + 1.0) * texels, 0.5, texels - 0.5);
  float sum = 0.0;
  for (int i = 0; i < e.count; ++i) {
    float weight;
    ivec3 entry = streak_entry(e, i, weight);
    vec2 place = vec2(float(entry.z) * (texels + 1.0) + at, float(entry.y) + 0.5) * per_texel;
    if (weight > 0.0) sum += weight * textureLod(streak_profiles, vec3(place, float(entry.x)), 0.0).r;
  }
  return mix(1.0, sum, streak_strength);
}

// Mean radiance along the streak per irradiance, 1/sr: in the place of drop_phase(), which is a sphere's and which
// even streaks have.
float streak_phase(vec3 angles, float even) {
  if (streak_strength == 0.0) return even;
  StreakEntries e = streak_entries(angles);
  int tile = textureSize(streak_profiles, 0).x / int(streak_table_nodes.z);
  float sum = 0.0;
  for (int i = 0; i < e.count; ++i) {
    float weight;
    ivec3 entry = streak_entry(e, i, weight);
    ivec3 place = ivec3((entry.z + 1) * tile - 1, entry.y, entry.x);
    if (weight > 0.0) sum += weight * texelFetch(streak_profiles, place, 0).r;
  }
  vec2 elevations = streak_table_nodes.w == 1.0 ? vec2(0.0, abs(angles.y)) : angles.xy;
  float cosine = -(sin(elevations.x) * sin(elevations.y) + cos(elevations.x) * cos(elevations.y) * cos(angles.z));
  int bins = textureSize(streak_phases, 0).x;
  int bin = min(int(sqrt(max(0.5 - 0.5 * cosine, 0.0)) * float(bins)), bins - 1);
  return mix(even, exp(sum) * texelFetch(streak_phases, ivec2(bin, 0), 0).r, streak_strength);
}

// Of a drop: bands per second of its fall, by Rayleigh's frequency of mode (2,0): 344 Hz at 1 mm.
float streak_bands_hz(float diameter_m) {
  float mm = diameter_m * 1000.0;
  return 343.93 * inversesqrt(max(mm * mm * mm, 1e-6));
}

// Change of `oscillation` for each cycle along: mode (3,1) is 1.936 times as fast as (2,0), not twice.
const float streak_drift = -0.0635083;

#endif
