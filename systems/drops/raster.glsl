// Drops into pixels, by integer atomics. LAMPS: drops carry lamplight. SCENE: there is a depth buffer.
//
// A drop of projected area A (pixels) whose image moves over L pixels covers A / L of the time and width of a
// line one pixel wide, so the sum of its coverage is A at any exposure and any width that is drawn: the mean
// transmittance stays exp(-extinction * distance). Coverages multiply, so their optical depths
// -ln(1 - coverage) add, in any order.
#ifndef SYSTEMS_DROPS_RASTER_GLSL
#define SYSTEMS_DROPS_RASTER_GLSL
#include "systems/frame.glsl"
#include "systems/drops/rain_shared.h"
#ifdef BANDS  // streaks carry bands
#include "systems/rainfall/streaks/bands.glsl"
#endif

// Two rows share a word, the even one in its low half: streaks stand rather than lie, so one atomic serves both.
layout(std430, binding = RAIN_OPTICAL_DEPTH_BINDING) buffer RainOpticalDepth { uint optical_depth[]; };
#ifdef LAMPS
layout(std430, binding = RAIN_RADIANCE_BINDING) buffer RainRadiance { uint radiance[]; };  // 4 per pixel: r, g, b, -
#endif
#if defined(SCENE) && !defined(SYSTEMS_RAINFALL_STREAK_GLSL)
layout(binding = 0) uniform sampler2D scene_depth;
#endif

// The invocations that share a streak, and which of them this is: each draws every lanes-th row or column.
int lane = 0, lanes = 1;

uint drop_bits;     // random, the drop's own
uint dither_state;  // a function of the drop and the place, whichever invocation draws it: so the sums are the same
vec3 drop_light = vec3(0.0);  // output radiance from lamps

void seed_dither(int place) {
  uint h = drop_bits + uint(place) * 0x9e3779b9u;
  h = (h ^ (h >> 16u)) * 0x7feb352du;
  h = (h ^ (h >> 15u)) * 0x846ca68bu;
  dither_state = h ^ (h >> 16u);
}

float dither() {
  dither_state = dither_state * 747796405u + 2891336453u;
  return float(dither_state >> 8u) * 5.9604644775390625e-8;
}

// -ln(1 - coverage). The series is exact to 1e-3 of itself below 0.3, and loses nothing of the smallest coverages, of
// which 1 - coverage is 1.
vec2 series_depth(vec2 c) { return c * (1.0 + c * (0.5 + c * (0.3333333 + c * (0.25 + c * 0.2)))); }
float depth_of(float coverage) {
  return coverage < 0.1 ? series_depth(vec2(coverage)).x : -log(1.0 - min(coverage, 0.98));
}

// Optical depths of two pixels, one above the other, `pixel` the lower one with an even row; or of `pixel` alone
// (any row, amounts.y = 0). Rounding up or down by chance keeps the mean, and most of what is far too faint costs
// no atomic.
void add(ivec2 pixel, vec2 amounts, float depth) {
  uvec2 size = uvec2(frame.size.xy);
  if (uint(pixel.x) >= size.x || uint(pixel.y) >= size.y) return;
  dither_state = dither_state * 747796405u + 2891336453u;
  // 24 bits: millions of drops in a pixel are some 1e-5 units each, and of 16 bits the smallest would all be lost.
  uint turned = dither_state << 16u | dither_state >> 16u;
  vec2 chance = (vec2(dither_state >> 8u, turned >> 8u) + 0.5) * 5.9604644775390625e-8;
  uvec2 units = uvec2(amounts * float(RAIN_DEPTH_ONE) + chance);
  uint word = (units.x | units.y << 16u) << (16u * uint(pixel.y & 1));
#ifdef LAMPS
  uvec3 lamp0 = uvec3(amounts.x * drop_light * float(RAIN_RADIANCE_ONE) + chance.x);
  uvec3 lamp1 = uvec3(amounts.y * drop_light * float(RAIN_RADIANCE_ONE) + chance.y);
  uint any_lamp = lamp0.r | lamp0.g | lamp0.b | lamp1.r | lamp1.g | lamp1.b;
  if ((word | any_lamp) == 0u) return;
#else
  if (word == 0u) return;
#endif
#ifdef SCENE
  int row = amounts.x > 0.0 ? pixel.y : min(pixel.y + 1, int(size.y) - 1);
  if (depth < texelFetch(scene_depth, ivec2(pixel.x, row), 0).r) return;
#endif
  uint at = (uint(pixel.y) >> 1u) * size.x + uint(pixel.x);
  if (word != 0u) atomicAdd(optical_depth[at], word);
#ifdef LAMPS
  if (any_lamp == 0u) return;
  at = 4u * (uint(pixel.y) * size.x + uint(pixel.x));
  if (lamp0.r != 0u) atomicAdd(radiance[at], lamp0.r);
  if (lamp0.g != 0u) atomicAdd(radiance[at + 1u], lamp0.g);
  if (lamp0.b != 0u) atomicAdd(radiance[at + 2u], lamp0.b);
  if (pixel.y + 1 >= int(size.y)) return;
  at += 4u * size.x;
  if (lamp1.r != 0u) atomicAdd(radiance[at], lamp1.r);
  if (lamp1.g != 0u) atomicAdd(radiance[at + 1u], lamp1.g);
  if (lamp1.b != 0u) atomicAdd(radiance[at + 2u], lamp1.b);
#endif
}

// Narrower than a pixel and moving by less: one pixel, at a moment by chance.
void draw_point(vec2 from, vec2 to, vec2 depths, float area) {
  dither_state = drop_bits;
  float t = dither();
  add(ivec2(floor(mix(from, to, t))), vec2(depth_of(area), 0.0), mix(depths.x, depths.y, t));
}

// Coverage of a pixel above which a line is shared between the two nearest pixels; below it falls to one of them by
// chance, which has the same mean.
const float smooth_coverage = 0.004;
int taps_of(float area, float reach) { return area > smooth_coverage * reach ? 2 : 1; }

// Narrower than a pixel: a line one pixel wide, `taps` 1 or 2 pixels across.
void draw_line(vec2 from, vec2 to, vec2 depths, float area, int taps) {
  vec2 span = to - from;
  bool steep = abs(span.y) > abs(span.x);
  // p, q: along the longer axis, rising; the other coordinate is linear in it.
  vec2 p = steep ? from.yx : from, q = steep ? to.yx : to;
  bool falling = p.x > q.x;
  vec2 low_end = falling ? q : p, high_end = falling ? p : q;
  vec2 d = falling ? depths.yx : depths;
  float per_length = 1.0 / (high_end.x - low_end.x);
  float slope = (high_end.y - low_end.y) * per_length, deepening = (d.y - d.x) * per_length;
  float per_pixel = area * per_length;
  // A standing line goes up by pairs of rows, a lying one along by columns.
  float stride = steep ? 2.0 : 1.0;
  float limit = steep ? frame.size.y : frame.size.x;
#ifdef BANDS
  vec3 even_light = drop_light;
#endif
  int first = int(floor(max(low_end.x, 0.0) / stride)), last = int(floor(min(high_end.x, limit - 1.0) / stride));
  for (int i = first + lane; i <= last; i += lanes) {
    seed_dither(i);
    float start = float(i) * stride;
    float low = max(low_end.x, start), high = min(high_end.x, start + stride);
    float middle = 0.5 * (low + high) - low_end.x;
    float place = low_end.y + slope * middle - 0.5;
    float depth = d.x + deepening * middle;
    vec2 covered = max(min(vec2(high_end.x), vec2(start + 1.0, start + stride)) -
                       max(vec2(low_end.x), vec2(start, start + 1.0)), vec2(0.0));
    covered.y = steep ? covered.y : 0.0;
    vec2 coverage = per_pixel * covered;
#ifdef BANDS
    drop_light = banded(even_light, falling ? 1.0 - middle * per_length : middle * per_length);
#endif
    if (taps == 1) place += dither();
    float column = floor(place);
    float share = taps == 1 ? 0.0 : place - column;
    for (int tap = 0; tap < taps; ++tap) {
      int j = int(column) + tap;
      add(steep ? ivec2(j, 2 * i) : ivec2(i, j), series_depth(coverage * (tap == 0 ? 1.0 - share : share)), depth);
    }
  }
}

// A disc of radius r that moves from one place to the other: each pixel centre's share of the time inside.
void draw_capsule(vec2 from, vec2 to, vec2 depths, float r, float area) {
  float kept = area / (3.14159265 * r * r);  // of the exposure
  vec2 span = to - from;
  float len = length(span);
  if (len < 0.5) {  // stands still: a disc with the edge of a pixel
    vec2 centre = 0.5 * (from + to);
    ivec2 low = ivec2(max(floor(centre - r - 1.0), 0.0)), high = ivec2(min(ceil(centre + r + 1.0), frame.size.xy - 1.0));
    for (int y = low.y + lane; y <= high.y; y += lanes) {
      seed_dither(y);
      for (int x = low.x; x <= high.x; ++x) {
        float edge = r + 0.5 - distance(vec2(x, y) + 0.5, centre);
        if (edge > 0.0) add(ivec2(x, y), vec2(depth_of(kept * min(edge, 1.0)), 0.0), 0.5 * (depths.x + depths.y));
      }
    }
    return;
  }
  vec2 along = span / len;
  bool steep = abs(along.y) > abs(along.x);
  float major = steep ? along.y : along.x, minor = steep ? along.x : along.y;
  float start = steep ? from.y : from.x, start_minor = steep ? from.x : from.y;
  float end = steep ? to.y : to.x;
  float limit = steep ? frame.size.y : frame.size.x, limit_minor = steep ? frame.size.x : frame.size.y;
  int first = int(max(floor(min(start, end) - r), 0.0)), last = int(min(ceil(max(start, end) + r), limit - 1.0));
  float half_width = r / abs(major) + r * abs(minor / major);
#ifdef BANDS
  vec3 even_light = drop_light;
#endif
  for (int i = first + lane; i <= last; i += lanes) {
    seed_dither(i);
    float centre = start_minor + (float(i) + 0.5 - start) * (minor / major);
#ifdef BANDS
    drop_light = banded(even_light, clamp((float(i) + 0.5 - start) / (major * len), 0.0, 1.0));
#endif
    // The caps reach beyond the band's own ends by less than the band is wide.
    int low = int(max(floor(centre - half_width), 0.0)), high = int(min(ceil(centre + half_width), limit_minor - 1.0));
    for (int j = low; j <= high; ++j) {
      vec2 pixel = (steep ? vec2(j, i) : vec2(i, j)) + 0.5;
      vec2 offset = pixel - from;
      float s = dot(offset, along), h = offset.x * along.y - offset.y * along.x;
      if (abs(h) >= r) continue;
      float chord = sqrt(r * r - h * h);
      float covered = (min(s + chord, len) - max(s - chord, 0.0)) / len;
      if (covered > 0.0) add(ivec2(pixel), vec2(depth_of(kept * covered), 0.0), mix(depths.x, depths.y, clamp(s / len, 0.0, 1.0)));
    }
  }
}

#endif
