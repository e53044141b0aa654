#version 450 core
// Tariq 2007, code listing 3, for the benchmark: a point becomes a quad of two triangles. It covers what the drop
// field's streak covers (raster.glsl): at least a pixel wide, as opaque as the drop covers it of the exposure. How much
// light each lamp gives the drop is found once a drop, where he does so for every fragment.
#define LAMPS
#include "systems/rainfall/streak.glsl"
#define TARIQ_LAMPS 3
layout(points) in;
layout(triangle_strip, max_vertices = 4) out;
in vec4 drop_place_diameter[];
in vec4 drop_velocity_random[];
out vec2 streak_place;  // across and along the texture
out vec3 to_eye;
out vec3 to_lamp[TARIQ_LAMPS];
flat out vec4 light_opacity[TARIQ_LAMPS];

void main() {
  vec3 velocity = drop_velocity_random[0].xyz;
  Streak s;
  if (!project(drop_place_diameter[0].xyz, 0.0, 1.0, velocity, drop_place_diameter[0].w, s)) return;
  float distance_to_eye = length(s.middle);
  vec2 span = s.to - s.from;
  float len = length(span), half_width = max(s.radius, 0.5);
  vec2 along = len > 1e-3 ? span / len : vec2(0.0, 1.0);
  float beyond = s.radius >= 0.5 ? s.radius : max(0.0, 0.5 - 0.5 * len);  // at either end
  float opacity = min(s.area / ((len + 2.0 * beyond) * 2.0 * half_width), 0.98);
  vec2 across = vec2(along.y, -along.x) * half_width;
  vec3 lamp[TARIQ_LAMPS];
  for (int l = 0; l < TARIQ_LAMPS; ++l)
    lamp[l] = uint(l) < frame.counts.x ? lamp_light(lights[l], s.middle, distance_to_eye) : vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    bool end = i >= 2;
    vec2 pixel = (end ? s.to + along * beyond : s.from - along * beyond) + ((i & 1) == 0 ? -across : across);
    vec3 at = s.middle + (end ? 0.5 : -0.5) * velocity * frame.camera_velocity_mps.w;
    gl_Position = vec4(pixel * frame.size.zw * 2.0 - 1.0, end ? s.depths.y : s.depths.x, 1.0);
    streak_place = vec2(float(i & 1), end ? 1.0 : 0.0);
    to_eye = -at;
    for (int l = 0; l < TARIQ_LAMPS; ++l) {
      to_lamp[l] = uint(l) < frame.counts.x ? lights[l].position_range.xyz - at : vec3(0.0, 1.0, 0.0);
      light_opacity[l] = vec4(seen_light(lamp[l], distance_to_eye) / frame.lens.w, opacity);
    }
    EmitVertex();
  }
  EndPrimitive();
}
