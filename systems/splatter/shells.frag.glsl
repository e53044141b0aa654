#version 450 core
// A shell's rings, blended onto the shells below it.
#include "systems/splatter/rings.glsl"
layout(location = 0) in vec3 shell_place;
layout(location = 1) in vec3 shell_normal;
layout(location = 2) in float shell_struck;
uniform float height_m, thickness_m;
layout(location = 0) out vec4 out_colour;

float struck_here() { return shell_struck; }

void main() {
  if (shell_struck <= 0.0) discard;
  vec3 normal = normalize(shell_normal);
  float ring_px = 2.0 * float(SPLATTER_REACH) * catcher.crown.y * frame.lens.z / length(shell_place);
  float near = smoothstep(fade_px.x, fade_px.y, ring_px) * catcher.shells.w;
  float depth = rings(local_place(shell_place), local_way(normal), vec3(0.0), height_m, 1, thickness_m, thickness_m);
  float opacity = 1.0 - exp(-depth * near);
  if (opacity <= 0.0) discard;
  vec3 light = drop_ambient(normalize(shell_place)) + droplet_lamps(shell_place);
  out_colour = vec4(min(light, vec3(60000.0)) * opacity, opacity);
}
