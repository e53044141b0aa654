#version 450 core
// Tariq 2007, "Rendering the sprites", for the benchmark: for each lamp the angles theta_light (mirrored) and phi_light
// of this fragment, and the four textures of the array nearest to them, mixed. SIMPLE is his simple shader, of constant
// brightness.
#define TARIQ_LAMPS 3
layout(binding = 0) uniform sampler2DArray streak_textures;  // half is the mean
in vec2 streak_place;
in vec3 to_eye;
in vec3 to_lamp[TARIQ_LAMPS];
flat in vec4 light_opacity[TARIQ_LAMPS];
layout(location = 0) out vec4 colour;
const vec2 nodes = vec2(10.0, 37.0);  // of theta_light and phi_light: 370 textures

float streak_texture(vec2 node) {
  return texture(streak_textures, vec3(streak_place, node.x * nodes.y + node.y)).r;
}

void main() {
  vec3 sum = vec3(0.0);
  vec3 eye = normalize(to_eye);
  for (int l = 0; l < TARIQ_LAMPS; ++l) {
#ifdef SIMPLE
    sum += light_opacity[l].rgb;
#else
    vec3 lamp = normalize(to_lamp[l]);
    float theta = asin(clamp(abs(lamp.y), 0.0, 1.0)) * 0.6366198;
    float across = max(length(lamp.xz) * length(eye.xz), 1e-6);
    float phi = acos(clamp(dot(lamp.xz, eye.xz) / across, -1.0, 1.0)) * 0.3183099;
    vec2 at = vec2(theta, phi) * (nodes - 1.0);
    vec2 low = min(floor(at), nodes - 2.0), share = at - low;
    float shine = mix(mix(streak_texture(low), streak_texture(low + vec2(0.0, 1.0)), share.y),
                      mix(streak_texture(low + vec2(1.0, 0.0)), streak_texture(low + vec2(1.0, 1.0)), share.y), share.x);
    sum += light_opacity[l].rgb * (2.0 * shine);
#endif
  }
  float opacity = light_opacity[0].a;
  colour = vec4(sum * opacity, opacity);
}
