// Shelter from precipitation, by the orthographic depth maps that pass "occlusion_map" draws along the directions in
// which it falls: one, or several that stand for drops of all sizes and for gusts. Include, bind the maps to
// OCCLUSION_UNIT (context.bind_texture(OCCLUSION_UNIT, "occlusion_map")); the pass binds the uniform block each frame.
// Places are metres relative to the camera. Without a map (nothing drawn yet) everything is in the open.
#ifndef SYSTEMS_OCCLUSION_OCCLUSION_GLSL
#define SYSTEMS_OCCLUSION_OCCLUSION_GLSL
#include "systems/frame_shared.h"

layout(std140, binding = OCCLUSION_UNIFORMS_BINDING) uniform OcclusionBlock { OcclusionUniforms occlusion; };
layout(binding = OCCLUSION_UNIT) uniform sampler2DArray occlusion_depth;

// The map along whose direction things of this velocity fall most nearly.
uint occlusion_map_of(vec3 velocity) {
  if (occlusion.counts.x <= 1u) return 0u;
  uint nearest = 0u;
  float most = -1e30;
  for (uint i = 0u; i < occlusion.counts.x; ++i) {
    float along = dot(velocity, occlusion.fall_texel[i].xyz);
    if (along > most) {
      most = along;
      nearest = i;
    }
  }
  return nearest;
}

// As first_hit_distance_m, by one of the maps.
float occlusion_first_hit_m(uint map, vec3 place) {
  vec3 p = (occlusion.map_from_relative[map] * vec4(place, 1.0)).xyz;  // texture xy, metres along the fall
  if (occlusion.fall_texel[map].w <= 0.0 || any(greaterThanEqual(abs(p.xy - 0.5), vec2(0.5)))) return 1e6;
  vec4 size = occlusion.size_depth[map];
  float depth = texelFetch(occlusion_depth, ivec3(ivec2(p.xy * size.x), int(map)), 0).r;
  if (depth <= 0.0) return 1e6;
  return (1.0 - depth) * size.y - p.z;
}

// The bias covers a map's own steepness over half a texel, so that level ground does not shelter itself.
bool occlusion_sheltered(uint map, vec3 place) {
  return occlusion_first_hit_m(map, place) < -occlusion.size_depth[map].z;
}

// Metres that precipitation at this place has still to fall, along the mean fall, until it meets the first surface
// under the sky. Negative: metres below that surface, i.e. how far it would have fallen since its impact. Outside the
// map or over nothing: a large distance.
float first_hit_distance_m(vec3 place) { return occlusion_first_hit_m(occlusion.counts.y, place); }
// Of something that falls with this velocity.
float first_hit_distance_m(vec3 place, vec3 velocity) { return occlusion_first_hit_m(occlusion_map_of(velocity), place); }

// Whether a surface stands between the place and the sky along the mean fall.
bool sheltered(vec3 place) { return occlusion_sheltered(occlusion.counts.y, place); }
// Along the fall of something of this velocity: a small drop comes in far flatter than a large one.
bool sheltered(vec3 place, vec3 velocity) { return occlusion_sheltered(occlusion_map_of(velocity), place); }

// Share of the precipitation that is kept away from a place in the air or on level ground, 0 to 1.
float shelter(vec3 place) {
  float kept = 0.0;
  for (uint i = 0u; i < occlusion.counts.x; ++i) {
    if (occlusion_sheltered(i, place)) kept += occlusion.size_depth[i].w;
  }
  return kept;
}

// A place on a surface, moved off it along its unit normal by what a texel's own extent may hide: without it slopes
// that the fall grazes are striped (the surface's neighbourhood shelters it).
vec3 occlusion_off_surface(uint map, vec3 place, vec3 normal) {
  vec4 fall = occlusion.fall_texel[map];
  float facing = dot(normal, -fall.xyz);
  return place + normal * (0.75 * fall.w * sqrt(max(1.0 - facing * facing, 0.0)));
}

// Share of the precipitation that a surface's own back or anything above it keeps away.
float shelter(vec3 place, vec3 normal) {
  float kept = 0.0;
  for (uint i = 0u; i < occlusion.counts.x; ++i) {
    bool behind = dot(normal, occlusion.fall_texel[i].xyz) >= 0.0;
    if (behind || occlusion_sheltered(i, occlusion_off_surface(i, place, normal))) kept += occlusion.size_depth[i].w;
  }
  return kept;
}

// Precipitation that settles on a square metre of a surface, in that on a square metre of open level ground: flux times
// max(0, -n.d) of every fall that gets there. In still air this is Chen's incline coefficient, n.y, where his depth map
// finds the place in the open (Snow Accumulation and Generation, steps 2 and 3), and 0 elsewhere.
float deposit(vec3 place, vec3 normal) {
  float sum = 0.0;
  for (uint i = 0u; i < occlusion.counts.x; ++i) {
    vec3 fall = occlusion.fall_texel[i].xyz;
    float facing = max(dot(normal, -fall), 0.0) / max(-fall.y, 1e-3);
    if (facing > 0.0 && !occlusion_sheltered(i, occlusion_off_surface(i, place, normal)))
      sum += occlusion.size_depth[i].w * facing;
  }
  return sum;
}

#endif
