// What a flat mirror shows: still water and panes (Tatarchuk and Isidoro 2006, section 6.3). Pass "mirrors" binds the
// block; bind the texture of slot "mirrors" to MIRRORS_UNIT and ask only where has("mirrors").
#ifndef SYSTEMS_MIRROR_MIRROR_GLSL
#define SYSTEMS_MIRROR_MIRROR_GLSL
#include "systems/mirror_shared.h"

#ifndef MIRRORS_UNIT
#define MIRRORS_UNIT 9
#endif
layout(binding = MIRRORS_UNIT) uniform sampler2DArray mirror_pictures;
layout(std140, binding = MIRRORS_BINDING) uniform MirrorsBlock { MirrorsGpu mirrors; };

// rgb cd/m2, a: 1 / distance from the mirrored eye, 1/m; 0: not drawn. place: in the picture, 0..1.
vec4 mirror_texel(int layer, vec2 place, float level) {
  level = clamp(level, 0.0, float(mirrors.levels.x - 1));
  vec2 margin = vec2(0.5 * exp2(ceil(level)));  // filters stay inside the picture, which may fill only part of its texture
  vec2 texel = clamp(place * mirrors.size.xy, margin, max(mirrors.size.xy - margin, margin));
  return textureLod(mirror_pictures, vec3(texel / mirrors.size.zw, float(layer)), level);
}

// Where the mirror image of a place (relative to the camera) stands in the picture; z <= 0: nowhere.
vec3 mirror_place(int layer, vec3 place) {
  vec4 q = mirrors.planes[layer].picture_from_relative * vec4(place, 1.0);
  return vec3(q.xy / max(q.w, 1e-6) * 0.5 + 0.5, q.w);
}

// 1 inside the rectangle that was drawn, falling to 0 at its rim.
float mirror_inside(int layer, vec3 at) {
  vec4 rect = mirrors.planes[layer].rect;
  vec2 rim = min(at.xy - rect.xy, rect.zw - at.xy) / mirrors.planes[layer].more.w;
  return at.z > 0.0 ? smoothstep(0.0, 1.0, min(rim.x, rim.y)) : 0.0;
}

// How far a surface shows this plane's image: by its height above the plane and its (smooth) normal.
float mirror_applies(int layer, vec3 place, vec3 normal) {
  vec4 plane = mirrors.planes[layer].plane;
  float tolerance = mirrors.planes[layer].more.y;
  float height = abs(dot(plane.xyz, place) + plane.w);
  return mirrors.planes[layer].more.x * (1.0 - smoothstep(0.4 * tolerance, tolerance, height)) *
         smoothstep(0.80, 0.92, dot(plane.xyz, normal));
}

// One plane's image along a ray: rgb cd/m2, a confidence. The ray is followed to the place that the picture says it
// hits, so that an image disturbed by ripples or seen from a little off the plane stands where it should.
// spread_rad: of the lobe about the ray, to either side.
vec4 mirror_along(int layer, vec3 place, vec3 direction, float spread_rad) {
  float eye = length(place);
  float way = 5.0;
  vec3 at = mirror_place(layer, place + direction * way);
  for (int i = 0; i < 2; ++i) {
    float inverse = mirror_texel(layer, at.xy, 0.0).a;
    way = inverse > 0.0 ? clamp(1.0 / inverse - eye, 0.05, MIRROR_FARTHEST_M) : way;
    at = mirror_place(layer, place + direction * way);
  }
  float texels = spread_rad * way / (way + eye) * mirrors.planes[layer].more.z;
  vec4 seen = mirror_texel(layer, at.xy, log2(max(2.0 * texels, 1.0)));
  float rising = smoothstep(0.0, 0.03, dot(mirrors.planes[layer].plane.xyz, direction));
  return vec4(seen.rgb, mirror_inside(layer, at) * rising * (seen.a > 0.0 ? 1.0 : 0.0));
}

// One plane's image with the lobe of a rough surface: GGX facets tilted by e turn the ray by 2 e in the plane of
// incidence and by 2 e sin(elevation) across it (shared physics, section 10): seven rays up and down, each about as
// wide as the lobe is across. a: confidence, without mirror_applies.
vec4 mirror_lobe(int layer, vec3 place, vec3 direction, float roughness) {
  float alpha = roughness * roughness;
  if (alpha * mirrors.planes[layer].more.z < 0.7) return mirror_along(layer, place, direction, 0.0);
  vec3 up = mirrors.planes[layer].plane.xyz, view = -normalize(place);
  vec3 facet = normalize(view + direction), away = normalize(direction - view);
  float across = 1.15 * alpha * max(dot(facet, view), 0.05);  // half of the slopes across lie within 0.58 alpha
  vec4 sum = vec4(0.0);
  float weights = 0.0;
  for (int k = -3; k <= 3; ++k) {
    // Middles of sevenths of the slopes along: their density is (1 + t^2)^(-3/2), in alphas.
    float u = float(k) / 3.5;
    vec3 h = normalize(facet - away * (alpha * u * inversesqrt(1.0 - u * u)));
    float facing = dot(view, h);
    vec3 ray = 2.0 * facing * h - view;
    float rise = dot(ray, up);
    if (facing <= 0.0 || rise <= 0.0) continue;  // the horizon clips the lobe
    // Facets count by what of them is seen, and pass what other facets leave (Smith).
    float weight = facing * 2.0 / (1.0 + sqrt(1.0 + alpha * alpha * max(1.0 / (rise * rise) - 1.0, 0.0)));
    vec4 seen = mirror_along(layer, place, ray, max(across, 0.25 * alpha));
    sum += vec4(seen.rgb * seen.a, seen.a) * weight;
    weights += weight;
  }
  return weights > 0.0 && sum.a > 0.0 ? vec4(sum.rgb / sum.a, sum.a / weights) : vec4(0.0);
}

// What a place (metres relative to the camera) mirrors along a unit direction: rgb cd/m2, a confidence (0 off the
// planes or outside their pictures). normal: of the smooth surface or of its ripples; roughness: perceptual.
vec4 mirror_radiance(vec3 place, vec3 normal, float roughness, vec3 mirror_direction) {
  float water = mirror_applies(0, place, normal), pane = mirror_applies(1, place, normal);
  int layer = water >= pane ? 0 : 1;
  float applies = max(water, pane) * (1.0 - smoothstep(0.25, 0.45, roughness));
  if (applies <= 0.0) return vec4(0.0);
  vec4 seen = mirror_lobe(layer, place, mirror_direction, roughness);
  return vec4(seen.rgb, seen.a * applies);
}

#endif
