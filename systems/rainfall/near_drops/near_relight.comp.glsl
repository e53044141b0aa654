#version 450 core
// Relighting: the map of a cell that is used turns the captured world into the image of its drops, and that into the
// means of its columns. Both are kept until the world is captured again (Rana's algorithm, steps 6 to 12).
layout(local_size_x = 64) in;
#include "systems/rainfall/near_drops/near_list.glsl"
#include "systems/rainfall/near_drops/near_optics.glsl"
#include "systems/rainfall/near_drops/near_maps.glsl"

layout(std430, binding = NEAR_MAPS_BINDING) readonly buffer NearMaps { uint maps[]; };
layout(std430, binding = NEAR_CELLS_BINDING) readonly buffer NearCells { uint stamps[]; };
// Of each cell first the image, then a row of column means. Coherent: columns are summed of what others wrote.
layout(std430, binding = NEAR_IMAGES_BINDING) coherent buffer NearImages { uvec2 images[]; };

vec3 direction(vec2 p) {
  vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  float t = max(-n.z, 0.0);
  n.x += n.x >= 0.0 ? -t : t;
  n.y += n.y >= 0.0 ? -t : t;
  return normalize(n);
}

void main() {
  uint index = gl_WorkGroupID.y * uint(NEAR_ROW) + gl_WorkGroupID.x;
  if (index >= cells_wanted) return;
  uint cells = uint(cells_aside * cells_aside * cells_aside), cell = stamps[cells + index];
  uint side = uint(map_pixels), area = side * side, image = cell * (area + side);
  vec3 place = cell_middle(cell) - captured_from;
  float pixel = 4.0 / float(area);  // of a disc of area pi
  for (uint i = gl_LocalInvocationIndex; i < area; i += 64u) {
    uint at = (cell * area + i) * uint(NEAR_MAP_WORDS);
    vec4 shares = unpackUnorm4x8(maps[at + 4u]);
    shares *= shares;
    // Solid angles of the pixel's bundles, as near_optics.glsl has them.
    vec2 q = (vec2(float(i % side), float(i / side)) + 0.5) * (2.0 / float(side)) - 1.0;
    float b = clamp(length(q), 0.02, 0.9998), in_angle = asin(b), inside = asin(b / 1.333);
    float cos_in = cos(in_angle), ratio = cos_in / (1.333 * cos(inside));
    vec3 sum = vec3(0.0);
    for (int k = 0; k < 4; ++k) {
      float angle = 2.0 * in_angle - 3.1415926536 + float(k) * (3.1415926536 - 2.0 * inside);
      float slope = max(abs(2.0 - 2.0 * float(k) * ratio) / max(cos_in, 0.15), 0.2);
      float solid = abs(sin(angle)) * slope * pixel / b;
      if (shares[k] > 0.0) sum += shares[k] * world_seen(place, direction(unpackSnorm2x16(maps[at + uint(k)])), solid);
    }
    sum = min(sum, vec3(6e4));
    images[image + i] = uvec2(packHalf2x16(sum.rg), packHalf2x16(vec2(sum.b, shares.x > 0.0 ? 1.0 : 0.0)));
  }
  memoryBarrierBuffer();
  barrier();
  for (uint x = gl_LocalInvocationIndex; x < side; x += 64u) {
    vec4 sum = vec4(0.0);
    for (uint y = 0u; y < side; ++y) {
      uvec2 texel = images[image + y * side + x];
      vec4 colour = vec4(unpackHalf2x16(texel.x), unpackHalf2x16(texel.y));
      vec2 q = (vec2(float(x), float(y)) + 0.5) * (2.0 / float(side)) - 1.0;
      if (dot(q, q) < 1.0) sum += vec4(colour.rgb, 1.0);
    }
    sum /= max(sum.w, 1.0);
    images[image + area + x] = uvec2(packHalf2x16(sum.rg), packHalf2x16(vec2(sum.b, 1.0)));
  }
}
