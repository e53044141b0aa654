// Shelter from precipitation, by the orthographic depth map that pass "occlusion_map" draws along the fall
// direction. Include, bind the map to OCCLUSION_UNIT (context.bind_texture(OCCLUSION_UNIT, "occlusion_map"));
// the pass binds the uniform block each frame. Without a map (nothing drawn yet) everything is in the open.
#ifndef SYSTEMS_OCCLUSION_OCCLUSION_GLSL
#define SYSTEMS_OCCLUSION_OCCLUSION_GLSL
#include "systems/frame_shared.h"

layout(std140, binding = OCCLUSION_UNIFORMS_BINDING) uniform OcclusionBlock { OcclusionUniforms occlusion; };
layout(binding = OCCLUSION_UNIT) uniform sampler2D occlusion_depth;

// Metres that precipitation at this place (relative to the camera) has still to fall, along the map's fall
// direction, until it meets the first surface under the sky. Negative: metres below that surface, i.e. how
// far it would have fallen since its impact. Outside the map or over nothing: a large distance.
float first_hit_distance_m(vec3 relative_position) {
  vec3 p = (occlusion.map_from_relative * vec4(relative_position, 1.0)).xyz;  // texture xy, metres along the fall
  if (occlusion.fall_texel.w <= 0.0 || any(greaterThanEqual(abs(p.xy - 0.5), vec2(0.5)))) return 1e6;
  float depth = texelFetch(occlusion_depth, ivec2(p.xy * occlusion.size_depth.x), 0).r;
  if (depth <= 0.0) return 1e6;
  return (1.0 - depth) * occlusion.size_depth.y - p.z;
}

// Whether a surface stands between the place and the sky along the fall direction. The bias covers the map's
// own steepness over half a texel, so that a surface does not shelter itself.
bool sheltered(vec3 relative_position) { return first_hit_distance_m(relative_position) < -occlusion.size_depth.z; }

#endif
