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
#ifndef SHELLS
#define SHELLS 4  // a constant: unrolled, the loop takes a quarter less time on software OpenGL
#endif
#include "systems/frame.glsl"
#include "systems/rainfall/layered/layered_shared.h"
#ifdef NORMALS
#include "systems/lighting/environment.glsl"
#endif
#include "systems/rainfall/layered/drop_shading.glsl"
layout(binding = 0) uniform sampler2D scene_depth;
uniform bool use_depth;
// Two cells, one above the other, in each texel. 8 bits each: mark, place across, place along, distance.
layout(binding = 1) uniform usampler2D placement;
layout(binding = 2) uniform sampler2DArray drop_light;
layout(binding = 4) uniform sampler2DArray haze;
layout(binding = 5) uniform sampler2D open_share;
layout(rgba16f, binding = 0) uniform image2D colour;

uniform vec3 ray_corner, ray_x, ray_y;  // ray of a pixel, one metre deep: corner + x ray_x + y ray_y
uniform vec3 way, side, across;         // of the rain past the camera, unit; and what azimuths are told by
uniform float streak_cells;             // way past the camera while the shutter is open, in cells
uniform float travelled;                // before that, in cells
uniform float per_cell;                 // cells in a metre
uniform uint stretch;                   // cells are 2^stretch times as tall as the placement's
uniform float odd_share;                // of every other cell: 1, towards 0 before they merge by twos
uniform vec4 shells[LAYERED_SHELLS];    // from, m; depth, m; opacity of the streaks; drops in a cell a metre away
uniform vec2 roots[LAYERED_SHELLS];     // 1 / sqrt of the distances where a shell begins and ends
uniform float columns[LAYERED_SHELLS];  // round the way, at its equator
uniform float pixel_rad;
uniform float drop_m;                   // diameter of the drop that stands for all: by D^4 over D^2
uniform bool use_open_share;
uniform uint salt;
#ifdef TURNING
uniform vec3 turned;                    // of the camera while the shutter is open: axis times angle, world
#endif

uint mixed(uint h) {
  h = (h ^ (h >> 15u)) * 0x9e3779b1u;
  h = (h ^ (h >> 13u)) * 0x85ebca77u;
  return h ^ (h >> 16u);
}

// What all shells share at a pixel.
struct View {
  vec3 ray;
  float end;         // distance to the scene, m
  float azimuth;     // in columns of one turn
  float s;
  float per_metre;   // cells in a metre, here
  float merged;      // columns and rows that are one here
  float travelled;   // cells
  float sine2;
  float aside;       // pixel over the sine, radians
  float drop_cells;  // height of a drop
  float streak;      // cells
  uint salt;
#ifdef TURNING
  vec2 turn;         // of the picture past a still direction while the shutter is open: azimuth (turns), s
#endif
};

struct Streaks {
  float cover;     // of a pixel's time, over its mean
  float along;     // 0 to 1 through the shell: of the strongest drop
  float aside;     // across that drop, -1 to 1
  float distance_m;
  uint kind;
};

Streaks streaks_of(View v, int shell) {
  vec4 extent = shells[shell];
  float around = columns[shell] * v.merged;
  float x = v.azimuth * around;
  float column = floor(x);
  x -= column;
  uint h = mixed(uint(column) + uint(shell) * 0x10000u ^ v.salt);
  // Nearer ones more often: what deviates is mostly near (by 1 / r^2 of the rain's depth). 1 / sqrt(r) is even.
  float root = mix(roots[shell].x, roots[shell].y, float(h & 0xffffu) * (1.0 / 65536.0));
  float distance_m = 1.0 / (root * root);
  float per_s = distance_m * v.per_metre;
  float y = v.s * per_s - v.travelled;
  // A streak reaches from where the shutter opened to where it closed; soft over a pixel or the drop itself.
  vec2 pixel = v.aside * vec2(around * 0.15915494, per_s);
  float soft = min(max(pixel.y, v.drop_cells), 0.5);
  float half_width = max(pixel.x, 0.5 * (v.drop_cells * around * 0.15915494 / per_s + pixel.x));
  float down = y - 0.5 * soft;
#ifdef TURNING
  float streak = v.streak + v.turn.y * per_s, back = streak < 0.0 ? -1.0 : 1.0;
  float along = min(max(abs(streak), 0.5 * soft), 1.0 - soft);
  float slope = v.turn.x * around * back / along;  // columns a cell
  // Of the picture: a column is 2 pi sine / around wide, a cell sine / per_s high.
  float steep = slope * 6.2831853 * per_s / around;
  half_width *= sqrt(1.0 + steep * steep);
  down -= back < 0.0 ? along : 0.0;
#else
  float along = min(max(v.streak, 0.5 * soft), 1.0 - soft);
#endif
  half_width = min(half_width, 0.5);
  float inverse_width = 1.0 / half_width, inverse_ramp = 1.0 / min(along, soft);
  // As many drops as the rain has in a cell; where that is more than one, one stands for all, and the haze for what
  // deviates less.
  float expected = extent.w * distance_m * v.sine2 / (v.merged * v.merged);
  float present = min(1.0, 2.0 * expected / (1.0 + odd_share));

  float row = floor(down);
  uvec2 pair = texelFetch(placement, ivec2(int(h >> 16u) & 255, (int(row) + int((h >> 28u) << 4u >> stretch)) & 255), 0).xy;
  float odd = fract(0.5 * row) > 0.25 ? odd_share : 1.0, even = odd_share + 1.0 - odd;
  Streaks found;
  found.cover = 0.0;
  float most = -1.0;
  float closed = row - y;
  float reach = (v.end - extent.x) / extent.y;  // drops beyond it stand behind the scene
  for (int i = 0; i < 2; ++i) {
    uint drop = i == 0 ? pair.x : pair.y;
    float up = closed + (float((drop >> 16u) & 255u) + 0.5) * (1.0 / 256.0);  // from here to the drop's end
#ifdef TURNING
    float from_end = back * up + 0.5 * soft;
    float aside = x - (float((drop >> 8u) & 255u) + 0.5) * (1.0 / 256.0) + slope * up;
#else
    float from_end = up + 0.5 * soft;
    float aside = x - (float((drop >> 8u) & 255u) + 0.5) * (1.0 / 256.0);
#endif
    aside -= floor(aside + 0.5);  // columns close on themselves, so that the mean over each is even
    float weight = clamp(min(from_end, along + soft - from_end) * inverse_ramp, 0.0, 1.0) *
                   max(1.0 - abs(aside) * inverse_width, 0.0) *
                   clamp(present * 256.0 - float(drop & 255u), 0.0, 1.0) * (i == 0 ? odd : even);
    float through = (float(drop >> 24u) + 0.5) * (1.0 / 256.0);
    weight = through < reach ? weight : 0.0;  // no streak in front of what stands before it
    found.cover += weight;
    if (weight > most) {
      most = weight;
      found.along = through;
      found.aside = aside * inverse_width;
      found.kind = drop >> 8u;
    }
    closed += 1.0;
  }
  found.cover *= extent.z * inverse_width / (max(along, soft) * max(present * 0.5 * (1.0 + odd_share), 1e-6));
  found.distance_m = distance_m;
  return found;
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, ivec2(frame.size.xy)))) return;
  View v;
  vec2 centre = vec2(at) + 0.5, place = centre * frame.size.zw;
  vec3 ray = ray_corner + centre.x * ray_x + centre.y * ray_y;
  float inverse_slant = inversesqrt(dot(ray, ray));
  v.ray = ray * inverse_slant;
  v.end = 1e9;
  if (use_depth) {
    float depth = texelFetch(scene_depth, at, 0).r;
    if (depth > 0.0) v.end = frame.camera_world_m.w / (depth * inverse_slant);
  }
  float cosine = clamp(dot(v.ray, way), -0.99999, 0.99999);
  v.s = 0.34657359 * log2((1.0 + cosine) / (1.0 - cosine));
  v.sine2 = 1.0 - cosine * cosine;
  float inverse_sine = inversesqrt(v.sine2);
  v.azimuth = atan(dot(v.ray, across), dot(v.ray, side)) * 0.15915494 + 0.5;
  v.azimuth = min(v.azimuth - floor(v.azimuth), 0.999999);
  // Towards the apexes columns narrow: there cells double. Which pixels double differs by sector, so that the border is
  // ragged. (The exponent of the float is the logarithm that this takes.)
  float raised = inverse_sine * (1.0 + 0.4 * float(mixed(uint(v.azimuth * 64.0)) & 255u) * (1.0 / 256.0));
  int level = clamp((floatBitsToInt(raised) >> 23) - 127, 0, LAYERED_LEVELS - 1);
  v.merged = intBitsToFloat((127 - level) << 23);
  v.per_metre = per_cell * v.merged;
  v.travelled = travelled * v.merged;
  v.streak = streak_cells * v.merged;
  v.aside = pixel_rad * inverse_slant * inverse_sine;
  v.drop_cells = drop_m * inverse_sine * v.per_metre;
  v.salt = salt ^ (uint(level) << 18u);
#ifdef TURNING
  vec3 past = cross(v.ray, turned);
  v.turn = vec2(dot(past, cross(way, v.ray)) * 0.15915494, dot(past, way)) / v.sine2;
#endif

  vec4 open = use_open_share ? textureLod(open_share, place, 0.0) : vec4(1.0);
  float transmittance = 1.0;
  vec3 light = vec3(0.0);
  float hazy = 0.0;  // how many shells lie before the scene
  for (int shell = 0; shell < SHELLS; ++shell) {
    hazy += clamp((v.end - shells[shell].x) / shells[shell].y, 0.0, 1.0);
    if (v.end <= shells[shell].x) continue;
    Streaks streaks = streaks_of(v, shell);
    float opacity = artist_opacity(streaks.cover * open[shell]);
    float part = floor(streaks.along * float(LAYERED_PARTS)) + float(shell * LAYERED_PARTS);
    vec3 drop = textureLod(drop_light, vec3(place, part), 0.0).rgb;
#ifdef NORMALS
    float width_px = drop_m / (streaks.distance_m * pixel_rad * inverse_slant);
    if (shell == 0 && streaks.cover > 0.0 && width_px > 1.0) {
      vec3 shown = drop_shows(v.ray, way, streaks.aside, streaks.kind, width_px, streak_cells / (per_cell * drop_m));
      // Lamps are in the drop's mean light alone.
      drop += min(width_px - 1.0, 1.0) * (shown - drop_means(v.ray)) * frame.lens.w;
    }
#endif
    light += transmittance * opacity * max(drop, vec3(0.0));
    transmittance *= 1.0 - opacity;
  }
  float below = floor(hazy);
  vec4 even = textureLod(haze, vec3(place, below), 0.0);
  if (hazy > below) even = mix(even, textureLod(haze, vec3(place, below + 1.0), 0.0), hazy - below);
  even *= min(v.end / shells[0].x, 1.0);
  float even_opacity = artist_opacity(even.a);
  // Haze and streaks lie one in the other: each dims half of the other's light.
  light = light * (1.0 - 0.5 * even_opacity) + even.rgb * (even_opacity / max(even.a, 1e-7)) * (0.5 + 0.5 * transmittance);
  float opacity = 1.0 - transmittance * (1.0 - even_opacity);
  light = artist_light(light, opacity);
  imageStore(colour, at, vec4(imageLoad(colour, at).rgb * (1.0 - opacity) + light / frame.lens.w, 1.0));
}
