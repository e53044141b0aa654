#version 450 core
// Linear light to an 8-bit picture: exposure, a shoulder, a square root for the display's curve.
#include "systems/frame.glsl"
layout(binding = 0) uniform sampler2D colour;
out vec4 picture;

void main() {
  vec3 light = texelFetch(colour, ivec2(gl_FragCoord.xy), 0).rgb * frame.lens.w;
  picture = vec4(sqrt(light / (1.0 + light)), 1.0);
}
