// How much of the open ground's rain a surface gets, with a soft edge: drops of all sizes and gusts fall about the
// mean, so the edge of a roof's shelter is as wide as the roof is high times the spread of their tilts. systems/occlusion
// answers with hard edges of its texels; here its maps are read with weights.
#ifndef SYSTEMS_WETNESS_EXPOSURE_GLSL
#define SYSTEMS_WETNESS_EXPOSURE_GLSL
#include "systems/occlusion/occlusion.glsl"

// Share of the four texels about a place on a map that do not shelter it, weighted by how near they are. p: texels, and
// metres along the fall. Their bias is twice a texel's own, because they reach twice as far. Texels, not a gather: that
// costs software OpenGL ten times as much.
float open_on_map(uint map, vec3 p, vec3 size) {
  vec2 low = floor(p.xy);
  ivec3 at = ivec3(ivec2(low), int(map));
  vec4 depth = vec4(texelFetch(occlusion_depth, at, 0).r, texelFetch(occlusion_depth, at + ivec3(1, 0, 0), 0).r,
                    texelFetch(occlusion_depth, at + ivec3(0, 1, 0), 0).r,
                    texelFetch(occlusion_depth, at + ivec3(1, 1, 0), 0).r);
  vec4 above = vec4(p.z) - (vec4(1.0) - depth) * size.y;  // m that a texel's surface stands above the place
  vec4 open = vec4(lessThanEqual(above, vec4(2.0 * size.z)));
  vec2 f = p.xy - low;
  return mix(mix(open.x, open.y, f.x), mix(open.z, open.w, f.x), f.y);
}

// Texels and metres along the fall of a place; outside the map nothing shelters.
vec3 on_map(uint map, vec3 place) {
  vec3 p = (occlusion.map_from_relative[map] * vec4(place, 1.0)).xyz;
  float texels = occlusion.size_depth[map].x;
  return vec3(clamp(p.xy, vec2(0.002), vec2(0.998)) * texels - 0.5, p.z);
}

float open_about(uint map, vec3 place) { return open_on_map(map, on_map(map, place), occlusion.size_depth[map].xyz); }

// Metres that the map's surface stands above a place along the fall; 0 or less: it is in the open.
float covered_m(uint map, vec3 place) {
  float hit = occlusion_first_hit_m(map, place);
  return hit < -2.0 * occlusion.size_depth[map].z ? -hit : 0.0;
}

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
  vec3 reach = spread * 7.0;
  float here = covered_m(map, off), before = covered_m(map, off - reach), behind = covered_m(map, off + reach);
  float most = max(here, max(before, behind));
  float least = min(here, min(before, behind));
  float open = open_about(map, off);  // edges along the wind are as soft as a texel
  bool mixed = caught > 0.0 && most > 0.0 && least <= 0.0;
  // A loop for an if: software OpenGL leaves a loop that no pixel is in, but walks through both sides of a branch.
  for (int once = 0; once < (mixed ? 1 : 0); ++once) {
    vec3 width = spread * min(here > 0.0 ? here : most, 12.0);
    open = 0.0;
    // A Gaussian by seven points, each as wide as a texel.
    const float weights[4] = float[4](0.2707, 0.2166, 0.1109, 0.0372);
    vec3 middle = on_map(map, off), step_p = (on_map(map, off + width) - middle) * 0.667;
    vec3 size = occlusion.size_depth[map].xyz;
    for (int k = -3; k <= 3; ++k) open += weights[abs(k)] * open_on_map(map, middle + step_p * float(k), size);
  }
  return caught * open;
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
