#version 450 core
// Which panels and posts matter in each tile of the half-size buffer: a bit each, nearest first; and the list of tiles
// that have any work, for the indirect dispatches of the passes after this, by a bound on the share of the lobe that a
// rectangle can take anywhere in the tile. In software one thread a tile, as in light_lists. On GPUs a work group, whose
// threads take a texel each and then a reflector or two: there are too few tiles to hide the waits of one thread's 64
// texels and 128 reflectors (2.0 ms of an H200's 1024x768).
#define GBUFFER_FIRST_UNIT 0
#include "systems/reflection/mirror_texel.glsl"
#include "systems/reflection/stand_ins.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32ui) uniform writeonly uimage2D lists;
layout(std430, binding = REFLECTION_TILES_BINDING) buffer Tiles { uint tiles[]; };
uniform float threshold;  // of a white pixel
uniform vec3 backdrop;    // cd/m2 of what a post may hide
uniform uint every_tile;  // 1: rays, mirrors or billboards may show in any tile that mirrors
uniform vec4 probe_spheres[4];  // m relative to the camera, w the radius: moving things that mirror their own probes
uniform int probe_count;

// Cosine of max(0, angle - spread), from the cosines of both.
float widened_cosine(float cosine, float spread_cosine) {
  if (cosine >= spread_cosine) return 1.0;
  float s = sqrt(max((1.0 - cosine * cosine) * (1.0 - spread_cosine * spread_cosine), 0.0));
  return clamp(cosine * spread_cosine + s, -1.0, 1.0);
}

// What is known of a tile: its pixels that mirror.
struct TileBound {
  vec3 ray, centre, normal;
  float radius, half_angle, normal_cosine, a2, n_dot_v;
};

TileBound bound_tile(ivec2 first, float near_depth, float far_depth, float smoothest, vec3 normal_sum, float count) {
  TileBound t;
  t.ray = view_ray(vec2(first) + float(REFLECTION_TILE));
  vec3 corner = view_ray(vec2(first));
  vec3 forward = -vec3(frame.view[0][2], frame.view[1][2], frame.view[2][2]);
  float along = 1.0 / max(dot(t.ray, forward), 0.05);
  float near_m = axial_distance_m(near_depth) * along, far_m = axial_distance_m(far_depth) * along;
  t.centre = t.ray * 0.5 * (near_m + far_m);
  t.half_angle = sqrt(max(1.0 - dot(t.ray, corner) * dot(t.ray, corner), 0.0));
  t.radius = length(vec2(0.5 * (far_m - near_m), t.half_angle * far_m));
  float mean_length = length(normal_sum) / count;
  t.normal = normal_sum / max(mean_length * count, 1e-6);
  t.normal_cosine = clamp(2.0 * mean_length - 1.0 - 0.005, -1.0, 1.0);
  float alpha = max(smoothest * smoothest, 2e-3);
  t.a2 = alpha * alpha + 2.0 * (1.0 - mean_length);
  t.n_dot_v = max(widened_cosine(dot(t.normal, -t.ray), t.normal_cosine), 0.05);
  return t;
}

bool matters(TileBound t, uint i) {
  ReflectorGpu q = reflectors.all[i];
  vec3 to = q.centre_kind.xyz - t.centre;
  float d = max(length(to), 1e-3);
  float spread = min((t.radius + q.up_reach.w) / d, 1.0);
  float spread_cosine = sqrt(1.0 - spread * spread);
  vec3 l = to / d;
  float n_dot_l = widened_cosine(widened_cosine(dot(t.normal, l), t.normal_cosine), spread_cosine);
  float share = 1.0;
  if (spread < 0.7) {
    vec3 h = normalize(l - t.ray);
    float half_spread = min(0.5 * (spread + t.half_angle), 1.0);
    float n_dot_h = widened_cosine(widened_cosine(dot(t.normal, h), t.normal_cosine), sqrt(1.0 - half_spread * half_spread));
    float v_dot_h = max(dot(h, -t.ray) - half_spread, 0.05);
    float solid = 4.0 * length(q.across_seen.xyz) * length(q.up_reach.xyz) / ((d - t.radius) * (d - t.radius) + 1e-4);
    // Lobe density over directions is D (n.h) / (4 v.h).
    share = min(ggx_distribution(n_dot_h, min(t.a2, 1.0)) * n_dot_h * solid / (4.0 * v_dot_h), 1.0);
  }
  float reflectance = 0.04 + pow(1.0 - t.n_dot_v, 5.0);
  bool post = q.centre_kind.w == float(REFLECTOR_POST);
  vec3 shines = post ? backdrop : q.radiance.rgb;
  float bright = max(shines.r, max(shines.g, shines.b)) * reflectance * frame.lens.w * share * q.across_seen.w;
  return n_dot_l > 0.0 && bright > threshold;
}

void list_tile(ivec2 tile, vec3 centre, float radius, uvec4 mask) {
  imageStore(lists, tile, mask);
  bool probe = false;
  for (int i = 0; i < probe_count; ++i)
    probe = probe || distance(centre, probe_spheres[i].xyz) < probe_spheres[i].w + radius;
  if ((mask.x | mask.y | mask.z | mask.w | every_tile) == 0u && !probe) return;
  uint at = atomicAdd(tiles[0], 1u);
  atomicAdd(tiles[4], 4u);  // of the picture: a tile of 16 x 16 pixels is four work groups
  tiles[REFLECTION_TILES_HEADER + int(at)] = uint(tile.x) | uint(tile.y) << 16u;
}

// The pixels that the half-size buffer stands for.
ivec2 texel_of(ivec2 first, int i) {
  return min(first + 2 * ivec2(i % REFLECTION_TILE, i / REFLECTION_TILE), ivec2(frame.size.xy) - 1);
}

#ifdef SOFTWARE
void main() {
  ivec2 tile = ivec2(gl_GlobalInvocationID.xy);
  ivec2 first = tile * (2 * REFLECTION_TILE);
  if (any(greaterThanEqual(first, ivec2(frame.size.xy)))) return;
  float near_depth = 0.0, far_depth = 1.0, smoothest = 1.0, count = 0.0;
  vec3 normal_sum = vec3(0.0);
  for (int i = 0; i < REFLECTION_TILE * REFLECTION_TILE; ++i) {
    ivec2 texel = texel_of(first, i);
    vec4 encoded = texelFetch(gbuffer_normal, texel, 0);
    float depth = mirror_share(encoded.z) > 0.0 ? read_depth(texel) : 0.0;
    bool mirrors = depth > 0.0;
    near_depth = max(near_depth, depth);
    far_depth = mirrors ? min(far_depth, depth) : far_depth;
    smoothest = mirrors ? min(smoothest, encoded.z) : smoothest;
    normal_sum += mirrors ? unit_from_octahedral(encoded.xy * 2.0 - 1.0) : vec3(0.0);
    count += mirrors ? 1.0 : 0.0;
  }
  if (count == 0.0) {
    imageStore(lists, tile, uvec4(0u));
    return;
  }
  TileBound t = bound_tile(first, near_depth, far_depth, smoothest, normal_sum, count);
  uvec4 mask = uvec4(0u);
  for (uint i = 0u; i < reflectors.counts.x; ++i)
    if (matters(t, i)) mask[i >> 5] |= 1u << (i & 31u);
  list_tile(tile, t.centre, t.radius, mask);
}
#else
shared uint near_bits, far_bits, smooth_bits, mirror_count;  // depths and roughness are positive: bits order as they do
shared int normal_x, normal_y, normal_z;                     // sums in 2^-16: whole numbers, in whichever order
shared uint masks[4];

void main() {
  ivec2 tile = ivec2(gl_WorkGroupID.xy);
  ivec2 first = tile * (2 * REFLECTION_TILE);
  uint own = gl_LocalInvocationIndex;
  if (own == 0u) {
    near_bits = 0u;
    far_bits = smooth_bits = floatBitsToUint(1.0);
    mirror_count = 0u;
    normal_x = normal_y = normal_z = 0;
  }
  if (own < 4u) masks[own] = 0u;
  barrier();
  ivec2 texel = texel_of(first, int(own));
  vec4 encoded = texelFetch(gbuffer_normal, texel, 0);
  float depth = mirror_share(encoded.z) > 0.0 ? read_depth(texel) : 0.0;
  if (depth > 0.0) {
    atomicMax(near_bits, floatBitsToUint(depth));
    atomicMin(far_bits, floatBitsToUint(depth));
    atomicMin(smooth_bits, floatBitsToUint(max(encoded.z, 0.0)));
    ivec3 n = ivec3(round(unit_from_octahedral(encoded.xy * 2.0 - 1.0) * 65536.0));
    atomicAdd(normal_x, n.x);
    atomicAdd(normal_y, n.y);
    atomicAdd(normal_z, n.z);
    atomicAdd(mirror_count, 1u);
  }
  barrier();
  bool any = mirror_count > 0u;  // the same for the whole group
  TileBound t = bound_tile(first, uintBitsToFloat(near_bits), uintBitsToFloat(far_bits), uintBitsToFloat(smooth_bits),
                           vec3(normal_x, normal_y, normal_z) / 65536.0, float(max(mirror_count, 1u)));
  for (uint i = own; any && i < reflectors.counts.x; i += 64u)
    if (matters(t, i)) atomicOr(masks[i >> 5], 1u << (i & 31u));
  barrier();
  if (own != 0u) return;
  if (any)
    list_tile(tile, t.centre, t.radius, uvec4(masks[0], masks[1], masks[2], masks[3]));
  else
    imageStore(lists, tile, uvec4(0u));
}
#endif
