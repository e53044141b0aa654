// How much of the open ground's rain a surface gets, with a soft edge: drops of all sizes and gusts fall about the
// mean, so the edge of a roof's shelter is as wide as the roof is high times the spread of their tilts. systems/occlusion
// answers with hard edges of its texels; here its maps are read with weights.
#ifndef SYSTEMS_WETNESS_EXPOSURE_GLSL
#define SYSTEMS_WETNESS_EXPOSURE_GLSL
#include "systems/occlusion/occlusion.glsl"

// Share of the four texels about a place on a map that do not shelter it, weighted by how near they are. p: texels, and
// metres along the fall; apart: texels from one to the next. Their bias is twice a texel's own, because they reach twice
// as far. Texels, not a gather: that costs software OpenGL ten times as much.
float open_on_map(uint map, vec3 p, vec3 size, int apart) {
  vec2 low = floor(p.xy / float(apart));
  ivec3 at = ivec3(ivec2(low) * apart, int(map));
  vec4 depth = vec4(texelFetch(occlusion_depth, at, 0).r, texelFetch(occlusion_depth, at + ivec3(apart, 0, 0), 0).r,
                    texelFetch(occlusion_depth, at + ivec3(0, apart, 0), 0).r,
                    texelFetch(occlusion_depth, at + ivec3(apart, apart, 0), 0).r);
  vec4 above = vec4(p.z) - (vec4(1.0) - depth) * size.y;  // m that a texel's surface stands above the place
  vec4 open = vec4(lessThanEqual(above, vec4(2.0 * size.z * float(apart))));
  vec2 f = p.xy / float(apart) - low;
  return mix(mix(open.x, open.y, f.x), mix(open.z, open.w, f.x), f.y);
}

// Texels and metres along the fall of a place; outside the map nothing shelters.
vec3 on_map(uint map, vec3 place) {
  vec3 p = (occlusion.map_from_relative[map] * vec4(place, 1.0)).xyz;
  float texels = occlusion.size_depth[map].x;
  return vec3(clamp(p.xy, vec2(0.002), vec2(0.998)) * texels - 0.5, p.z);
}

float open_about(uint map, vec3 place) { 
  return open_on_map(map, on_map(map, place), occlusion.size_depth[map].xyz, 1);
}

// Metres that the map's surface stands above a place along the fall; 0 or less: it is in the open. p: of the map's 0 to
// 1, and metres along the fall. As occlusion.glsl's occlusion_first_hit_m.
float covered_m(uint map, vec3 p) {
  vec4 size = occlusion.size_depth[map];
  bool off_map = any(greaterThanEqual(abs(p.xy - 0.5), vec2(0.5)));
  float depth = texelFetch(occlusion_depth, ivec3(ivec2(clamp(p.xy, vec2(0.0), vec2(0.999)) * size.x), int(map)), 0).r;
  float above = p.z - (1.0 - depth) * size.y;
  return !off_map && depth > 0.0 && above > 2.0 * size.z ? above : 0.0;
}

// Gusts blow across the mean wind as well: turbulence near the ground is about 0.75 as strong that way, but of the spread
// most is drops of different sizes, which are blown along it alone. Together a guess.
const float lateral_share = 0.4;

// By one map, as occlusion.glsl's deposit() does. spread: deviation of the tilts, level and along the wind.
float exposure_by(uint map, vec3 place, vec3 normal, vec3 spread) {
  vec3 fall = occlusion.fall_texel[map].xyz;
  float facing = dot(normal, -fall) / max(-fall.y, 1e-3);
  float across = dot(normal, spread);  // of the facing, a deviation of the tilt
  // Mean of max(0, facing - t across) over a three-point Gaussian.
  float caught = 0.6666667 * max(facing, 0.0) +
                 0.1666667 * (max(facing - 1.7320508 * across, 0.0) + max(facing + 1.7320508 * across, 0.0));
  if (occlusion.fall_texel[map].w <= 0.0) return caught;
  vec3 off = occlusion_off_surface(map, place, normal);
  // Is there anything about that could shelter it: here, and to where the spread reaches from a roof 4 m above?
  mat4 to_map = occlusion.map_from_relative[map];
  vec3 p = (to_map * vec4(off, 1.0)).xyz;
  vec3 along_p = mat3(to_map) * spread;
  vec3 across_p = mat3(to_map) * (vec3(-spread.z, 0.0, spread.x) * lateral_share);
  vec3 reach = 7.0 * along_p, aside = 7.0 * across_p;
  float here = covered_m(map, p);
  vec4 about = vec4(covered_m(map, p - reach - aside), covered_m(map, p - reach + aside),
                    covered_m(map, p + reach - aside), covered_m(map, p + reach + aside));
  float most = max(here, max(max(about.x, about.y), max(about.z, about.w)));
  float least = min(here, min(min(about.x, about.y), min(about.z, about.w)));
  float open = here > 0.0 ? 0.0 : 1.0;
  bool mixed = caught > 0.0 && most > 0.0 && least <= 0.0;
  // A loop for an if: software OpenGL leaves a loop that no pixel is in, but walks through both sides of a branch.
  for (int once = 0; once < (mixed ? 1 : 0); ++once) {
    // As high as the lowest of them stands, kerbs apart: the map knows the highest alone, and a cornice's wide edge would
    // leak under the awning that it hides.
    vec4 heights = mix(vec4(4.0), about, greaterThan(about, vec4(1.0)));
    float fallen = min(min(here > 0.0 ? here : 4.0, 4.0),
                       min(min(heights.x, heights.y), min(heights.z, heights.w)));
    open = 0.0;
    // A Gaussian by five points, each a tent about as wide as the steps between them, a power of two of texels so that it
    // stands still in the world. Walls lie along the fall, where far texels would be their own shelter: one tent, a texel
    // wide.
    const float weights[3] = float[3](0.3664, 0.2443, 0.0725);
    const float sides[5] = float[5](0.6, -1.0, 0.0, 1.0, -0.6);
    bool wall = normal.y < 0.7;
    vec3 size = occlusion.size_depth[map].xyz, texels_of = vec3(size.xx, 1.0);
    vec3 middle = vec3(clamp(p.xy, vec2(0.002), vec2(0.998)) * size.x - 0.5, p.z);
    vec3 step_p = along_p * texels_of * (0.9 * fallen), side_p = across_p * texels_of * fallen;
    float texels = length(step_p.xy);
    // At least as wide as hides the map's own stairs.
    step_p *= max(1.0, 0.8 / max(texels, 1e-3));
    side_p *= max(1.0, 1.2 / max(length(side_p.xy), 1e-3));
    int apart = wall || texels < 1.5 ? 1 : texels < 3.0 ? 2 : 4;
    for (int k = wall ? 0 : -2; k <= (wall ? 0 : 2); ++k) {
      vec3 at = wall ? middle : middle + step_p * float(k) + side_p * sides[k + 2];
      open += (wall ? 1.0 : weights[abs(k)]) * open_on_map(map, at, size, apart);
    }
  }
  // A film would show already where a thousandth of the rain arrives; so few drops lie apart and dry on their own, and a
  // film begins where they meet.
  return caught * smoothstep(0.1, 0.9, open);
}

// Of the rain that wets now.
float exposure(vec3 place, vec3 normal, vec3 spread) {
  if (occlusion.counts.x == 0u) return max(normal.y, 0.0);
  if (occlusion.counts.x == 1u) return exposure_by(0u, place, normal, spread);
  float sum = 0.0;
  for (uint i = 0u; i < occlusion.counts.x; ++i) {
    vec3 fall = occlusion.fall_texel[i].xyz;
    float facing = max(dot(normal, -fall), 0.0) / max(-fall.y, 1e-3);
    if (facing > 0.0)
      sum += occlusion.size_depth[i].w * facing * open_about(i, occlusion_off_surface(i, place, normal));
  }
  return sum;
}

// Along the remembered fall, whose map lies behind those of now; 0 where none was drawn.
float remembered_exposure(vec3 place, vec3 normal, vec3 spread) {
  return occlusion.counts.w == 0u ? 0.0 : exposure_by(occlusion.counts.x, place, normal, spread);
}

#endif
