#version 450 core
// How much of each reflector is seen, by sixteen looks at the depth of the picture: what something nearer hides from the
// eye is hidden from the ground before the eye, too. Beyond the picture's edge the look is taken at the edge, the more
// kindly the farther beyond: what is hidden does not flare up as it crosses, what lies on a wall that is not does not fade.
#include "systems/geometry/position.glsl"
#include "systems/reflection/reflection_shared.h"

layout(local_size_x = 32) in;
layout(binding = 0) uniform sampler2D depth_map;
layout(std430, binding = REFLECTORS_STORAGE_BINDING) buffer ReflectorsBuffer { ReflectorsGpu reflectors; };

void main() {
  uint i = gl_GlobalInvocationID.x;
  if (i >= reflectors.counts.x) return;
  ReflectorGpu q = reflectors.all[i];
  vec3 to = q.centre_kind.xyz;
  vec3 across = q.centre_kind.w == float(REFLECTOR_PANEL)
                    ? q.across_seen.xyz
                    : normalize(cross(q.up_reach.xyz, to) + vec3(1e-7, 0.0, 0.0)) * length(q.across_seen.xyz);
  float seen = 0.0, asked = 0.0;
  for (int k = 0; k < 16; ++k) {
    vec2 at = (vec2(float(k & 3), float(k >> 2)) - 1.5) * 0.5;
    vec3 place = to + across * at.x + q.up_reach.xyz * at.y;
    vec4 clip = frame.view_projection * vec4(place, 1.0);
    if (clip.w < 0.1) continue;
    vec2 pixel = clamp((clip.xy / clip.w * 0.5 + 0.5) * frame.size.xy, vec2(0.5), frame.size.xy - 0.5);
    float nearest = texelFetch(depth_map, ivec2(pixel), 0).r;
    float surface_m = axial_distance_m(max(nearest, 1e-7));
    vec2 beyond = max(abs(clip.xy / clip.w) - 1.0, vec2(0.0));
    float tolerance = 0.5 + 0.03 * clip.w + q.up_reach.w * 0.5 + clip.w * max(beyond.x, beyond.y);
    seen += smoothstep(clip.w - 2.0 * tolerance, clip.w - tolerance, surface_m);
    asked += 1.0;
  }
  reflectors.all[i].across_seen.w *= asked > 0.0 ? seen / asked : 1.0;
}
