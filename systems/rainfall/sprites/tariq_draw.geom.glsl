#version 450 core
// Tariq 2007, code listing 3, for the benchmark: a point becomes a quad of two triangles. It covers what the drop
// field's streak covers (raster.glsl): at least a pixel wide, as opaque as the drop covers it of the exposure, and lit by
// the same lamps, once a drop; his shader does so for every fragment and reads four textures a lamp.
#define LAMPS
#include "systems/rainfall/streak.glsl"
layout(points) in;
layout(triangle_strip, max_vertices = 4) out;
in vec4 drop_place_diameter[];
in vec4 drop_velocity_random[];
out vec3 streak_place;  // across and along the texture, its layer
flat out vec4 light_opacity;
uniform float texture_layers;

void main() {
  vec3 place = drop_place_diameter[0].xyz, velocity = drop_velocity_random[0].xyz;
  Streak s;
  if (!project(place, 0.0, 1.0, velocity, drop_place_diameter[0].w, s)) return;
  float distance_to_eye = length(s.middle);
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < frame.counts.x; ++i) sum += lamp_light(lights[i], s.middle, distance_to_eye);
  vec2 span = s.to - s.from;
  float len = length(span), half_width = max(s.radius, 0.5);
  vec2 along = len > 1e-3 ? span / len : vec2(0.0, 1.0);
  float beyond = s.radius >= 0.5 ? s.radius : max(0.0, 0.5 - 0.5 * len);  // at either end
  float opacity = min(s.area / ((len + 2.0 * beyond) * 2.0 * half_width), 0.98);
  vec2 across = vec2(along.y, -along.x) * half_width;
  float layer = floor(drop_velocity_random[0].w * texture_layers);
  for (int i = 0; i < 4; ++i) {
    bool end = i >= 2;
    vec2 pixel = (end ? s.to + along * beyond : s.from - along * beyond) + ((i & 1) == 0 ? -across : across);
    gl_Position = vec4(pixel * frame.size.zw * 2.0 - 1.0, end ? s.depths.y : s.depths.x, 1.0);
    streak_place = vec3(float(i & 1), end ? 1.0 : 0.0, layer);
    light_opacity = vec4(seen_light(sum, distance_to_eye) / frame.lens.w, opacity);
    EmitVertex();
  }
  EndPrimitive();
}
