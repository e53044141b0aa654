#version 450 core
// Radiance in cd/m2 -> display values; alpha is their luminance, which antialiasing looks at.
#include "systems/frame.glsl"
#include "systems/image/tone.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D colour;
layout(binding = 1) uniform sampler2D bloom;
#ifdef FINAL
layout(binding = 0, rgba8) uniform writeonly image2D display;
#else
layout(binding = 0, rgba16f) uniform writeonly image2D display;
#endif
uniform float bloom_strength;

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, ivec2(frame.size.xy)))) return;
  vec3 c = texelFetch(colour, texel, 0).rgb;
#ifdef BLOOM
  c = mix(c, textureLod(bloom, (vec2(texel) + 0.5) * frame.size.zw, 0.0).rgb, bloom_strength);
#endif
  vec3 shown = tone_map(c * frame.lens.w);
#ifdef FINAL
  imageStore(display, texel, vec4(dithered(shown, vec2(texel) + 0.5), 1.0));
#else
  imageStore(display, texel, vec4(shown, luminance(shown)));
#endif
}
