#version 450 core
// Which lights can be seen on the surfaces of each tile of 8x8 pixels: a mask a tile. One invocation a
// tile; it bounds place, normals, roughness and albedo of the tile's pixels and from them, light by light, the radiance
// that could leave towards the camera. Lights whose bound stays below `threshold` of a white pixel are left out:
// that keeps the long mirror image of a lamp on a wet road 80 m away, and drops its glow on the wall beside it.
#define GBUFFER_FIRST_UNIT 0
#include "systems/geometry/gbuffer.glsl"
#include "systems/brdf.h"
#include "systems/lighting/lighting_shared.h"
#ifdef SHADOWS
#include "systems/lighting/shadow.glsl"
#endif

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32ui) uniform writeonly uimage2D light_lists;
layout(std430, binding = TILES_BINDING) buffer Tiles { uint tiles[]; };
uniform float threshold;
uniform uint list_length;  // of each kind's list

void append(ivec2 tile, uint kind) {
  uint at = atomicAdd(tiles[kind * 4u], 1u);
  tiles[uint(TILES_HEADER) + kind * list_length + at] = uint(tile.x) | uint(tile.y) << 16u;
}

// Cosine of max(0, angle - spread), from the cosines of both.
float widened_cosine(float cosine, float spread_cosine) {
  if (cosine >= spread_cosine) return 1.0;
  float s = sqrt(max((1.0 - cosine * cosine) * (1.0 - spread_cosine * spread_cosine), 0.0));
  return clamp(cosine * spread_cosine + s, -1.0, 1.0);
}

void main() {
  ivec2 tile = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = ivec2(frame.size.xy);
  ivec2 first = tile * LIGHT_TILE;
  if (any(greaterThanEqual(first, size))) return;

  float near_depth = 0.0, far_depth = 1.0, smoothest = 1.0, whitest = 0.0, count = 0.0;
  vec3 normal_sum = vec3(0.0);
  for (int i = 0; i < LIGHT_TILE * LIGHT_TILE / 2; ++i) {  // the black fields of the board
    int row = i / (LIGHT_TILE / 2);
    ivec2 texel = min(first + ivec2(2 * (i % (LIGHT_TILE / 2)) + (row & 1), row), size - 1);
    float depth = read_depth(texel);
    vec4 encoded = texelFetch(gbuffer_normal, texel, 0);
    float solid = depth > 0.0 ? 1.0 : 0.0;
    near_depth = max(near_depth, depth);
    far_depth = min(far_depth, depth > 0.0 ? depth : 1.0);
    smoothest = min(smoothest, depth > 0.0 ? encoded.z : 1.0);
    vec3 colour = texelFetch(gbuffer_albedo, texel, 0).rgb;  // square roots
    whitest = max(whitest, solid * max(colour.r, max(colour.g, colour.b)));
    normal_sum += solid * unit_from_octahedral(encoded.xy * 2.0 - 1.0);
    count += solid;
  }
  if (count == 0.0) {
    imageStore(light_lists, tile, uvec4(0u));
    append(tile, uint(TILES_SKY));
    return;
  }

  // A sphere round the tile's surfaces.
  vec3 ray = view_ray(vec2(first) + 0.5 * float(LIGHT_TILE));
  vec3 corner = view_ray(vec2(first));
  vec3 forward = -vec3(frame.view[0][2], frame.view[1][2], frame.view[2][2]);
  float along = 1.0 / max(dot(ray, forward), 0.05);
  float near_m = axial_distance_m(near_depth) * along, far_m = axial_distance_m(far_depth) * along;
  float half_angle = sqrt(max(1.0 - dot(ray, corner) * dot(ray, corner), 0.0));
  vec3 centre = ray * 0.5 * (near_m + far_m);
  float radius = length(vec2(0.5 * (far_m - near_m), half_angle * far_m)) + 0.01;

  // Normals uniform in a cone of half angle t have a mean of length (1 + cos t) / 2.
  float mean_length = length(normal_sum) / count;
  vec3 normal = normal_sum / max(mean_length * count, 1e-6);
  float normal_cosine = clamp(2.0 * mean_length - 1.0 - 0.02, -1.0, 1.0);
  float alpha = max(smoothest * smoothest, 2e-3);
  float n_dot_v = max(widened_cosine(dot(normal, -ray), normal_cosine), 0.1);

  uvec4 mask = uvec4(0u);
  for (uint i = 0u; i < chosen.counts.x; ++i) {
    LightGpu light = chosen.lights[i];
    vec3 to_light = light.position_range.xyz - centre;
    float d = max(length(to_light), 1e-3);
    float nearest = max(d - radius, 0.05);
    vec3 l = to_light / d;
    bool directional = light.direction_kind.w == float(LIGHT_DIRECTIONAL);
    float spread = directional ? 0.0 : min(radius / d, 1.0);  // sine of the angle that the tile fills, seen from the light
    if (directional) l = -light.direction_kind.xyz;
    float spread_cosine = sqrt(1.0 - spread * spread);

    float illuminance = max(light.intensity_radius.r, max(light.intensity_radius.g, light.intensity_radius.b));
    if (!directional) {
      illuminance *= distance_attenuation(nearest * nearest, light.position_range.w);
      float cone = spread < 1.0 ? widened_cosine(dot(-l, light.direction_kind.xyz), spread_cosine) : 1.0;
      illuminance *= spot_attenuation(cone, light.cone_shadow.x, light.cone_shadow.y);
    }
    float n_dot_l = spread < 1.0 ? widened_cosine(widened_cosine(dot(normal, l), normal_cosine), spread_cosine) : 1.0;
    float bound = 0.0;
    if (n_dot_l > 0.0) {
      bound = whitest * whitest / PI * n_dot_l;
      vec2 lobe = sphere_light_lobe(alpha, light.intensity_radius.w, 1.0 / nearest);
      vec3 h = normalize(l - ray);
      // The half vector turns by half of what the light's direction and the view ray turn.
      float half_spread = 0.5 * (spread + half_angle + min(light.intensity_radius.w / nearest, 1.0));
      float n_dot_h = spread < 1.0 ? widened_cosine(widened_cosine(dot(normal, h), normal_cosine),
                                                    sqrt(max(1.0 - half_spread * half_spread, 0.0)))
                                   : 1.0;
      float facet = clamp(dot(h, -ray), 0.0, 1.0);
      float f = 0.06 + pow(1.0 - facet, 5.0);
      bound += ggx_distribution(n_dot_h, lobe.x * lobe.x) * lobe.y * f * 0.25 / n_dot_v;
    }
    if (bound * illuminance * frame.lens.w > threshold) mask[i >> 5] |= 1u << (i & 31u);
  }
#ifdef SHADOWS
  // Four places of the tile ask the shadow maps, by their blurred half: it sees what lies between the places.
  uint in_shadow = (1u << chosen.counts.y) - 1u, in_light = in_shadow;
  for (int i = 0; i < 4; ++i) {
    ivec2 texel = min(first + ivec2((i & 1) * 5 + 1, (i >> 1) * 5 + 1), size - 1);
    float depth = read_depth(texel);
    if (depth <= 0.0) continue;
    vec3 place = relative_position(vec2(texel) + 0.5, depth);
    vec3 n = unit_from_octahedral(texelFetch(gbuffer_normal, texel, 0).xy * 2.0 - 1.0);
    float bias_m = shadow_bias_m(place);
    for (uint c = 0u; c < chosen.counts.y; ++c) {
      LightGpu light = chosen.lights[c];
      float share = blurred_share(light.cone_shadow.z, place + n * bias_m - light.position_range.xyz,
                                  light.cone_shadow.w, bias_m);
      in_shadow &= ~(share > 0.12 ? 1u << c : 0u);
      in_light &= ~(share < 0.99 ? 1u << c : 0u);
    }
  }
  mask.x &= ~in_shadow;
  mask.w |= (in_light & mask.x) << 16;
  uint asks = mask.x & ((1u << chosen.counts.y) - 1u) & ~in_light;
#else
  uint asks = 0u;
#endif
  imageStore(light_lists, tile, mask);
  append(tile, asks == 0u ? uint(TILES_LIT) : uint(TILES_SHADOWED));
}
