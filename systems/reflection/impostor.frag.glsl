#version 450 core
// The impostor's own picture: "the original shape of the reflector is distinguishable only by the blurred dominant
// colors". Premultiplied.
layout(location = 0) in vec2 inside;
layout(location = 1) flat in vec4 shine;
layout(location = 2) flat in float rounded;
layout(location = 0) out vec4 light;

void main() {
  float soft = 1.0 - smoothstep(0.7, 1.0, abs(inside.x));
  soft *= 1.0 - smoothstep(0.6, 1.0, abs(inside.y)) * mix(0.5, 1.0, rounded);
  light = vec4(min(shine.rgb, vec3(6e4)) * soft, shine.a * soft);
}
