#version 450 core
// "Motion blur and strong mistiness" by blurring after the rain pass (the paper's 3.1 and 6.2), and the composite: along
// the rain's way by its velocity, and a little round about, by its opacity.
layout(local_size_x = 8, local_size_y = 8) in;
#include "systems/frame.glsl"
layout(binding = 0) uniform sampler2D rain;
layout(rgba16f, binding = 0) uniform image2D colour;
uniform vec2 smear;  // of the rain while the shutter is open, in pictures

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, ivec2(frame.size.xy)))) return;
  vec2 place = (vec2(at) + 0.5) * frame.size.zw;
  vec4 along = vec4(0.0), misty = vec4(0.0);
  for (int i = 0; i < 9; ++i) along += textureLod(rain, place + smear * (float(i) / 8.0 - 0.5), 0.0) * (1.0 / 9.0);
  // Kawase's four taps.
  for (int i = 0; i < 4; ++i) {
    vec2 corner = vec2(float(i & 1) - 0.5, float(i >> 1) - 0.5) * 5.0;
    misty += 0.25 * textureLod(rain, place + corner * frame.size.zw, 0.0);
  }
  vec4 blurred = mix(along, misty, 0.3);
  imageStore(colour, at, vec4(imageLoad(colour, at).rgb * (1.0 - blurred.a) + blurred.rgb / frame.lens.w, 1.0));
}
