#version 450 core
// Layers of falling rain in one pass over the picture, after Tatarchuk and Isidoro 2006, section 3.1, mended: directions
// are the world's instead of the screen's, streaks come from the exposure, and each shell's mean opacity is that of the
// rain it stands for, as far as it lies before the scene.
//
// A direction is told by its azimuth about the way of the rain past the camera and by s = atanh(cosine to that way)
// (Mercator's projection, the apexes at s = +-infinity). There a drop at distance r moves by ds/dt = U / r whatever its
// direction, since dpsi/dt = -U sin(psi) / r (physics, section 13a). So columns of azimuth scroll rigidly, each with a
// distance of its own: the paper's "parallax times a random value per drop" as the w of a projective fetch is here
// s * r. In metres along the fall all columns scroll alike, and what repeats, repeats for all at once.
layout(local_size_x = 8, local_size_y = 8) in;
#include "systems/frame.glsl"
#include "systems/rainfall/layered/layered_shared.h"
#include "systems/rainfall/ambient.glsl"
#ifdef LAMPS
#include "systems/rainfall/light_volume.glsl"
layout(binding = 2) uniform sampler2DArray shell_light;  // lamplight of each shell's mean
#endif
#ifdef SCENE
#include "systems/occlusion/occlusion.glsl"
layout(binding = 0) uniform sampler2D scene_depth;
uniform bool use_occlusion;
#endif
layout(binding = 1) uniform usampler2D placement;  // 8 bits each: mark, place across, place along, distance
#include "systems/rainfall/layered/drop_shading.glsl"
layout(rgba16f, binding = 0) uniform image2D colour;

uniform vec3 ray_corner, ray_x, ray_y;  // ray of a pixel, one metre deep: corner + x ray_x + y ray_y
uniform vec3 way, side, across;         // of the rain past the camera, unit; and what azimuths are told by
uniform float streak_m;                 // way past the camera while the shutter is open
uniform vec3 turned;                    // of the camera meanwhile: axis times angle, world
uniform float cell_m;                   // height of a cell along the way
uniform int stretch;                    // log2 of how much more than layered_cell_m that is
uniform float odd_share;                // of every other cell: 1, towards 0 before they merge by twos
uniform float travelled[LAYERED_LEVELS];  // in cells of each level
uniform int turn_level;                   // columns are wider by 2^this while the camera turns fast
uniform vec4 shells[LAYERED_SHELLS];      // from, to, m; opacity of the whole shell; drops per m2 of shell in it
uniform float columns[LAYERED_SHELLS];    // round the way, at its equator
uniform float pixel_rad;
uniform float drop_m;                     // diameter of the drop that stands for all: by D^4 over D^2
uniform float near_depth;                 // optical depth per metre, for what is nearer than the first shell
uniform uint salt;

uint mixed(uint h) {
  h = (h ^ (h >> 15u)) * 0x9e3779b1u;
  h = (h ^ (h >> 13u)) * 0x85ebca77u;
  return h ^ (h >> 16u);
}

// What all shells share at a pixel.
struct View {
  vec3 ray;
  vec2 place;       // of the picture, 0 to 1
  float slant;
  float end;        // distance to the scene, m
  float azimuth;    // turns, 0 to 1
  float s, sine, inverse_sine;
  vec2 turn_rad;    // of the picture past a still direction while the shutter is open: azimuth, s
  float pixel;      // radians
  uint sector;      // azimuth in 64 parts, for the border between levels
};

// Streaks of one shell: share of a pixel's time that they cover, over what it is on average, and the place of the
// strongest. x: cover; y: its distance; z: across the drop, -1 to 1; w: its random byte.
struct Streaks {
  float haze, cover;
  float distance_m;
  float across;
  float width_px;
  uint kind;
};

Streaks streaks_of(View v, int shell) {
  vec4 extent = shells[shell];
  // Towards the apexes columns narrow: there cells double. Which pixels double differs by sector, so that the border is
  // ragged. (Which level it is costs a logarithm, which exponents of floats give.)
  float raised = v.inverse_sine * (1.0 + 0.4 * float(mixed(v.sector + 64u * uint(shell)) & 255u) / 256.0);
  int level = clamp((floatBitsToInt(raised) >> 23) - 127, 0, LAYERED_LEVELS - 1);
  float doubled = float(1 << level);
  float around = columns[shell] / (doubled * float(1 << turn_level));
  float x = v.azimuth * around;
  float column = floor(x);
  x -= column;
  uint h = mixed(uint(column) + (uint(shell) + 4u * uint(level)) * 0x10000u ^ salt);
  float distance_m = mix(extent.x, extent.y, float(h & 0xffffu) / 65536.0);

  float column_rad = v.sine * 6.2831853 / around;
  float cell_height = cell_m * doubled;
  float per_s = distance_m / cell_height;
  float y = v.s * per_s - travelled[level];
  vec2 pixel = v.pixel * vec2(1.0 / column_rad, v.inverse_sine * per_s);
  // The streak, from the opening to the closing of the shutter.
  vec2 streak = vec2(v.turn_rad.x * around * 0.15915494, streak_m / cell_height + v.turn_rad.y * per_s);
  float soft = max(pixel.y, drop_m * v.inverse_sine / cell_height);
  float along = max(abs(streak.y), 0.5 * soft), turned_back = streak.y < 0.0 ? -1.0 : 1.0;
  along = min(along, 1.0 - min(soft, 0.5));
  float slope = streak.x * turned_back / along;  // columns per cell
  float slope_angle = slope * column_rad / (cell_height * v.sine / distance_m);
  float half_width = max(pixel.x, 0.5 * (drop_m / (distance_m * column_rad) + pixel.x));
  half_width = min(half_width * sqrt(1.0 + slope_angle * slope_angle), 0.5);

  // Drops in a cell: as many as the rain has there. Where that is more than one, one stands for all, with the
  // deviation that they would have.
  float expected = extent.w * distance_m * cell_height * v.sine * column_rad;
  float present = min(1.0, 2.0 * expected / (1.0 + odd_share));
  float drops = present * 0.5 * (1.0 + odd_share);
  float contrast = min(1.0, sqrt(drops / max(expected, 1e-9)));

  Streaks found;
  found.distance_m = distance_m;
  found.across = 0.0;
  found.kind = 0u;
  found.width_px = drop_m / (distance_m * v.pixel);
  float sum = 0.0, most = 0.0;
  float first = y - 0.5 * soft - (turned_back < 0.0 ? along : 0.0);
  int row = int(floor(first));
  float inverse_ramp = 1.0 / min(along, soft), inverse_length = 1.0 / max(along, soft);
  for (int i = 0; i < 2; ++i) {
    int cell = row + i;
    uvec4 drop = texelFetch(placement, ivec2(int(h >> 16u) & 255, ((cell << stretch) + int(h >> 24u)) & 255), 0);
    float weight = clamp(present * 256.0 - float(drop.x), 0.0, 1.0);
    if ((cell & 1) != 0) weight *= odd_share;
    float up = float(cell) + (float(drop.z) + 0.5) / float(256 << stretch) - y;  // from here to the drop's end
    float from_end = turned_back * up + 0.5 * soft;
    float length_here = min(from_end, along + soft - from_end);
    weight *= clamp(length_here * inverse_ramp, 0.0, 1.0);
    // Columns close on themselves, so that the mean over each is even.
    float aside = x - (float(drop.y) + 0.5) / 256.0 + slope * up;
    aside -= round(aside);
    weight *= max(1.0 - abs(aside) / half_width, 0.0);
    float stands_m = mix(extent.x, extent.y, (float(drop.w) + 0.5) / 256.0);
    weight = stands_m < v.end ? weight : 0.0;  // no streak in front of what stands before it
    sum += weight;
    if (weight > most) {
      most = weight;
      found.distance_m = stands_m;
      found.across = aside / half_width;
      found.kind = drop.y;
    }
  }
  float before = clamp((v.end - extent.x) / (extent.y - extent.x), 0.0, 1.0);
  found.haze = extent.z * (1.0 - contrast) * before;
  found.cover = extent.z * contrast * sum * inverse_length / (half_width * max(drops, 1e-6));
  return found;
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, ivec2(frame.size.xy)))) return;
  View v;
  vec2 centre = vec2(at) + 0.5;
  vec3 ray = ray_corner + centre.x * ray_x + centre.y * ray_y;
  v.slant = length(ray);
  v.ray = ray / v.slant;
  v.place = centre * frame.size.zw;
  v.end = 1e9;
#ifdef SCENE
  float depth = texelFetch(scene_depth, at, 0).r;
  if (depth > 0.0) v.end = frame.camera_world_m.w / depth * v.slant;
#endif
  float cosine = clamp(dot(v.ray, way), -0.999999, 0.999999);
  v.s = 0.5 * log((1.0 + cosine) / (1.0 - cosine));
  float sine2 = 1.0 - cosine * cosine;
  v.inverse_sine = inversesqrt(sine2);
  v.sine = sine2 * v.inverse_sine;
  v.azimuth = atan(dot(v.ray, across), dot(v.ray, side)) * 0.15915494 + 0.5;
  v.azimuth -= floor(v.azimuth);
  v.sector = uint(v.azimuth * 64.0);
  v.pixel = pixel_rad / v.slant;
  vec3 past = -cross(turned, v.ray);
  v.turn_rad = vec2(dot(past, cross(way, v.ray)), dot(past, way)) / sine2;

  vec3 around = drop_ambient(v.ray);
  float transmittance = exp(-near_depth * min(v.end, shells[0].x));
  vec3 light = around * (1.0 - transmittance);
  for (int shell = 0; shell < LAYERED_SHELLS; ++shell) {
    if (v.end <= shells[shell].x) break;
    Streaks streaks = streaks_of(v, shell);
#ifdef SCENE
    if (use_occlusion && sheltered(v.ray * streaks.distance_m)) continue;
#endif
    float opacity = artist_opacity(streaks.haze + streaks.cover);
    float haze_share = streaks.haze / max(streaks.haze + streaks.cover, 1e-9);
    vec3 drop = around, haze = around;
#ifdef ENVIRONMENT
    if (streaks.cover > 0.0 && streaks.width_px > 1.0) {
      float resolved = min(streaks.width_px - 1.0, 1.0);
      vec3 shown = drop_shows(v.ray, way, streaks.across, streaks.kind, streaks.width_px, streak_m / drop_m);
      drop = mix(drop, shown, resolved);
    }
#endif
#ifdef LAMPS
    float slices = float(textureSize(rain_light_volume, 0).z);
    float slice = log(streaks.distance_m / rain_light_near_m) / log(rain_light_far_m / rain_light_near_m) * slices;
    haze += textureLod(shell_light, vec3(v.place, float(shell)), 0.0).rgb / frame.lens.w;
    drop += textureLod(rain_light_volume, vec3(v.place, clamp(floor(slice), 0.0, slices - 1.0)), 0.0).rgb / frame.lens.w;
#endif
    light += transmittance * opacity * artist_light(mix(drop, haze, haze_share));
    transmittance *= 1.0 - opacity;
  }
  imageStore(colour, at, vec4(imageLoad(colour, at).rgb * transmittance + light, 1.0));
}
