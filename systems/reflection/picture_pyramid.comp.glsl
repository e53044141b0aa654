#version 450 core
// The picture at half size and smaller, for rays to look up. What shines by itself is mirrored in closed form
// (stand_ins.glsl) or, lamps, by their highlights of pass shade: rays meet it as dark as the dimmest of those.
#define DIMMEST_REFLECTOR_CD_M2 2.0
#include "systems/frame.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D source;    // the level above
layout(binding = 3) uniform sampler2D emissive;  // of the first level's source
layout(binding = 0, rgba16f) uniform writeonly image2D level;
uniform int source_level;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, imageSize(level)))) return;
  ivec2 last = textureSize(source, source_level) - 1;
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 from = min(texel * 2 + ivec2(i & 1, i >> 1), last);
    vec3 light = texelFetch(source, from, source_level).rgb;
#ifdef FIRST
    vec3 own = texelFetch(emissive, from, 0).rgb;
    light = max(light - own, vec3(0.0)) + min(own, vec3(DIMMEST_REFLECTOR_CD_M2));
#endif
    sum += 0.25 * light;
  }
  imageStore(level, texel, vec4(sum, 1.0));
}
