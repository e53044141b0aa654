#version 450 core
// Smooths the stairs of edges in the finished picture, and dithers it to 8 bits. Where luminance changes at once
// between two pixels, the edge is followed to both its ends; how near the nearer end is says how much of the pixel
// lies on the other side (the idea of Lottes 2009, "FXAA", and of Reshetov 2009, "Morphological Antialiasing").
// No earlier frames are used: each frame stands alone.
//
// Two dispatches: FIND writes the pixels that are no edge and lists the others; without it the listed pixels are
// smoothed. Software OpenGL executes what a branch skips, so work that few pixels need goes through a list.
#include "systems/frame.glsl"
#include "systems/image/tone.h"

layout(binding = 0) uniform sampler2D display;  // alpha: luminance of the display values
layout(binding = 0, rgba8) uniform writeonly image2D result;
uniform float least_contrast;    // of white: fainter edges stay
uniform float relative_contrast;  // of the brightest neighbour
uniform float softening;         // 0..1: of single bright or dark pixels

float neighbour(ivec2 texel, ivec2 offset, ivec2 last) {
  return texelFetch(display, clamp(texel + offset, ivec2(0), last), 0).a;
}

#ifdef FIND
layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = 7) buffer Edges {
  uint groups[3];  // indirect dispatch of 64 pixels a group
  uint count;
  uint edges[];  // x in the lower 16 bits, y above
};

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 last = ivec2(frame.size.xy) - 1;
  if (any(greaterThan(texel, last))) return;
  vec4 centre = texelFetch(display, texel, 0);
  float west = neighbour(texel, ivec2(-1, 0), last), east = neighbour(texel, ivec2(1, 0), last);
  float south = neighbour(texel, ivec2(0, -1), last), north = neighbour(texel, ivec2(0, 1), last);
  float brightest = max(centre.a, max(max(west, east), max(north, south)));
  float darkest = min(centre.a, min(min(west, east), min(north, south)));
  if (brightest - darkest > max(least_contrast, relative_contrast * brightest)) {
    // The order of the list varies from run to run; what becomes of each pixel does not.
    uint at = atomicAdd(count, 1u);
    if ((at & 63u) == 0u) atomicAdd(groups[0], 1u);
    edges[at] = uint(texel.x) | uint(texel.y) << 16u;
  } else {
    imageStore(result, texel, vec4(dithered(centre.rgb, vec2(texel) + 0.5), 1.0));
  }
}
#else
layout(local_size_x = 64) in;
layout(std430, binding = 7) readonly buffer Edges {
  uint groups[3];
  uint count;
  uint edges[];
};

const int STEPS = 7;
const float STEP[STEPS] = float[STEPS](1.0, 1.0, 1.5, 2.0, 2.0, 3.0, 4.0);

float luma(vec2 pixel) { return textureLod(display, pixel * frame.size.zw, 0.0).a; }

void main() {
  if (gl_GlobalInvocationID.x >= count) return;
  uint packed_texel = edges[gl_GlobalInvocationID.x];
  ivec2 texel = ivec2(packed_texel & 0xffffu, packed_texel >> 16u);
  ivec2 last = ivec2(frame.size.xy) - 1;
  vec2 pixel = vec2(texel) + 0.5;

  float m = texelFetch(display, texel, 0).a;
  float west = neighbour(texel, ivec2(-1, 0), last), east = neighbour(texel, ivec2(1, 0), last);
  float south = neighbour(texel, ivec2(0, -1), last), north = neighbour(texel, ivec2(0, 1), last);
  float brightest = max(m, max(max(west, east), max(north, south)));
  float darkest = min(m, min(min(west, east), min(north, south)));
  float contrast = brightest - darkest;

  float north_west = neighbour(texel, ivec2(-1, 1), last), north_east = neighbour(texel, ivec2(1, 1), last);
  float south_west = neighbour(texel, ivec2(-1, -1), last), south_east = neighbour(texel, ivec2(1, -1), last);

  // How much the pixel stands out from a tent over its neighbours.
  float mean = (2.0 * (north + south + east + west) + north_west + north_east + south_west + south_east) / 12.0;
  float alone = clamp(abs(mean - m) / max(contrast, 1e-4), 0.0, 1.0);
  alone = alone * alone * (3.0 - 2.0 * alone);
  float by_contrast = alone * alone * softening;

  float across_rows = abs(north_west + south_west - 2.0 * west) + 2.0 * abs(north + south - 2.0 * m) +
                      abs(north_east + south_east - 2.0 * east);
  float across_columns = abs(south_west + south_east - 2.0 * south) + 2.0 * abs(west + east - 2.0 * m) +
                         abs(north_west + north_east - 2.0 * north);
  bool level = across_rows >= across_columns;  // the edge runs along the row
  float one = level ? south : west, other = level ? north : east;
  bool towards_one = abs(one - m) >= abs(other - m);
  float gradient = max(abs(one - m), abs(other - m));
  vec2 normal = (level ? vec2(0.0, 1.0) : vec2(1.0, 0.0)) * (towards_one ? -1.0 : 1.0);
  vec2 along = level ? vec2(1.0, 0.0) : vec2(0.0, 1.0);

  // Walk on the line between the two rows; where the mean of both leaves that of the edge, it ends.
  float edge_luma = 0.5 * (m + (towards_one ? one : other));
  vec2 start = pixel + 0.5 * normal;
  float back = 0.0, forth = 0.0, back_end = 0.0, forth_end = 0.0;
  bool back_done = false, forth_done = false;
  for (int i = 0; i < STEPS; ++i) {
    if (back_done && forth_done) break;
    if (!back_done) {
      back += STEP[i];
      back_end = luma(start - along * back) - edge_luma;
      back_done = abs(back_end) >= 0.25 * gradient;
    }
    if (!forth_done) {
      forth += STEP[i];
      forth_end = luma(start + along * forth) - edge_luma;
      forth_done = abs(forth_end) >= 0.25 * gradient;
    }
  }
  bool back_nearer = back < forth;
  float nearer_end = back_nearer ? back_end : forth_end;
  // Only where the edge ends towards the other side does this pixel hold a piece of that side.
  bool turns = (nearer_end < 0.0) != (m < edge_luma);
  float by_edge = turns ? 0.5 - min(back, forth) / max(back + forth, 1e-4) : 0.0;

  float shift = max(by_edge, by_contrast);
  vec3 shown = textureLod(display, (pixel + normal * shift) * frame.size.zw, 0.0).rgb;
  imageStore(result, texel, vec4(dithered(shown, pixel), 1.0));
}
#endif
