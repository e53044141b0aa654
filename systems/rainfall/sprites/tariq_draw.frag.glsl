#version 450 core
// Tariq 2007, "Rendering the sprites", for the benchmark: one texture of the array a fragment, where he reads four a lamp.
layout(binding = 0) uniform sampler2DArray streak_textures;  // half is the mean
in vec3 streak_place;
flat in vec4 light_opacity;
layout(location = 0) out vec4 colour;

void main() {
  float shine = 2.0 * texture(streak_textures, streak_place).r;
  colour = vec4(light_opacity.rgb * (shine * light_opacity.a), light_opacity.a);
}
