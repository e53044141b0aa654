// A texel of the half-size buffer stands for the picture's pixel 2 * texel, with the mean normal of four pixels and a
// roughness that holds what the mean leaves out: ripples finer than a pixel become a wider lobe instead of a flicker
// (Toksvig 2005; Tokuyoshi and Kaplanyan 2019, "Improved Geometric Specular Antialiasing").
#ifndef SYSTEMS_REFLECTION_MIRROR_TEXEL_GLSL
#define SYSTEMS_REFLECTION_MIRROR_TEXEL_GLSL
#include "systems/geometry/gbuffer.glsl"
#include "systems/reflection/streak.h"

ivec2 picture_texel(ivec2 half_texel) { return min(half_texel * 2, ivec2(frame.size.xy) - 1); }

// Roughness of one pixel at full size, with what its block of four holds of ripples.
float filtered_roughness(ivec2 texel, float depth, vec3 normal, float roughness) {
  vec3 sum = vec3(0.0);
  float count = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 other = min((texel & ~1) + ivec2(i & 1, i >> 1), ivec2(frame.size.xy) - 1);
    vec3 n = unit_from_octahedral(texelFetch(gbuffer_normal, other, 0).xy * 2.0 - 1.0);
    bool same = abs(read_depth(other) - depth) < 0.04 * depth && dot(n, normal) > 0.5;
    sum += same ? n : vec3(0.0);
    count += same ? 1.0 : 0.0;
  }
  float alpha = roughness * roughness, mean_length = count > 0.0 ? length(sum) / count : 1.0;
  return sqrt(sqrt(widened_alpha2(alpha * alpha, mean_length)));
}

Surface mirror_surface(ivec2 texel, float depth) {
  Surface s = read_surface(texel);
  vec3 sum = s.normal;
  float count = 1.0;
  for (int i = 1; i < 4; ++i) {
    ivec2 other = min(texel + 2 * ivec2(i & 1, i >> 1), ivec2(frame.size.xy) - 1);
    vec3 n = unit_from_octahedral(texelFetch(gbuffer_normal, other, 0).xy * 2.0 - 1.0);
    bool same = abs(read_depth(other) - depth) < 0.04 * depth && dot(n, s.normal) > 0.5;
    sum += same ? n : vec3(0.0);
    count += same ? 1.0 : 0.0;
  }
  float mean_length = length(sum) / count;
  s.normal = sum / max(mean_length * count, 1e-6);
  float alpha = s.roughness * s.roughness;
  s.roughness = sqrt(sqrt(widened_alpha2(alpha * alpha, mean_length)));
  return s;
}

#endif
