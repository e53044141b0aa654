#version 450 core
// Irradiance from above, lux, by what shines and is no light of the scene: windows, shop fronts, tubes. On the first
// surface under the sky, a texel a place; unshadowed.
layout(local_size_x = 8, local_size_y = 8) in;
#include "systems/frame.glsl"
#include "systems/occlusion/occlusion.glsl"

struct Glow {
  vec4 place_normal_x;   // relative, m
  vec4 intensity_normal_y;
  vec4 normal_z;
};
layout(std430, binding = 9) readonly buffer Glows { Glow glows[]; };
layout(rgba16f, binding = 0) writeonly uniform image2D overhead;
uniform uint glow_count;
uniform vec3 middle_side;  // xz relative, m; side, m
uniform bool has_map;
uniform vec3 first_block;  // whole numbers: first texel; texels to each side that have one answer

void main() {
  int block = int(first_block.z);
  ivec2 texel = ivec2(first_block.xy) + ivec2(gl_GlobalInvocationID.xy) * block, size = imageSize(overhead);
  if (any(greaterThanEqual(texel, size))) return;
  vec2 at = middle_side.xy + ((vec2(texel) + 0.5 * first_block.z) / vec2(size) - 0.5) * middle_side.z;
  vec3 place = vec3(at.x, 0.0, at.y);
  if (has_map) {
    float hit = first_hit_distance_m(place);
    if (abs(hit) < 1e4) place.y += occlusion.fall_texel[occlusion.counts.y].y * hit;
  }
  vec3 lux = vec3(0.0);
  for (uint i = 0u; i < glow_count; ++i) {
    Glow g = glows[i];
    vec3 way = place - g.place_normal_x.xyz;
    float d2 = dot(way, way) + 0.05;
    vec3 normal = vec3(g.place_normal_x.w, g.intensity_normal_y.w, g.normal_z.x);
    float facing = dot(normal, normal) > 0.5 ? max(dot(way, normal) * inversesqrt(d2), 0.0) : 1.0;
    lux += g.intensity_normal_y.rgb * (facing / d2);
  }
  for (int y = 0; y < block; ++y)
    for (int x = 0; x < block; ++x) imageStore(overhead, texel + ivec2(x, y), vec4(lux, 1.0));
}
