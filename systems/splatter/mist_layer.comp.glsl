#version 450 core
// Mist as a thin layer over the upper surface of a marked object: optical depth of exp(-height / H) along each pixel's
// ray, piecewise in closed form over the object's own map of heights.
layout(local_size_x = 8, local_size_y = 8) in;
#include "systems/geometry/position.glsl"
#include "systems/splatter/catcher.glsl"
#include "systems/occlusion/occlusion.glsl"
uniform bool use_occlusion;

layout(binding = 0) uniform sampler2D scene_depth;
layout(binding = 4) uniform sampler2D heights;  // y in object space, cover by mist
layout(rgba16f, binding = 0) uniform image2D colour;
uniform ivec2 first_pixel, last_pixel;
uniform int steps;

void main() {
  ivec2 texel = first_pixel + ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThan(texel, last_pixel))) return;
  vec3 ray = view_ray(vec2(texel) + 0.5);
  float stored = texelFetch(scene_depth, texel, 0).r;
  float end = stored > 0.0 ? length(relative_position(vec2(texel) + 0.5, stored)) : 1e6;
  vec3 eye = local_place(vec3(0.0)), way = local_way(ray);
  float height_m = catcher.mist.y;
  vec3 high = catcher.high.xyz + vec3(0.0, 8.0 * height_m, 0.0);
  vec3 inverse = 1.0 / mix(way, vec3(1e-9), lessThan(abs(way), vec3(1e-9)));
  vec3 t0 = (catcher.low.xyz - eye) * inverse, t1 = (high - eye) * inverse;
  vec3 first = min(t0, t1), last = max(t0, t1);
  float enter = max(max(first.x, first.y), max(first.z, 0.0));
  float leave = min(min(last.x, last.y), min(last.z, end));
  if (leave <= enter) return;
  float ds = (leave - enter) / float(steps);
  vec2 size = catcher.high.xz - catcher.low.xz;
  float sum = 0.0, where = 0.0, last_height = 0.0, last_cover = 0.0;
  for (int i = 0; i <= steps; ++i) {
    float s = enter + ds * float(i);
    vec3 p = eye + way * s;
    vec2 surface = textureLod(heights, (p.xz - catcher.low.xz) / size, 0.0).rg;
    float height = (p.y - surface.x * catcher.low.w) / height_m;
    if (i > 0) {
      float h0 = max(last_height, 0.0), h1 = max(height, 0.0), dh = h1 - h0;
      float e0 = exp(-h0), e1 = exp(-h1);
      float mean = abs(dh) > 1e-3 ? (e0 - e1) / dh : 0.5 * (e0 + e1);
      // Heights of a cell are not the surface's to the millimetre: what is a little below it is taken as on it.
      float below0 = max(-last_height, 0.0), below1 = max(-height, 0.0);
      mean *= (1.0 - min(below0, 1.0) + 1.0 - min(below1, 1.0)) * 0.5;
      float part = mean * 0.5 * (last_cover + surface.y) * ds;
      sum += part;
      where += part * (s - 0.5 * ds);
    }
    last_height = height;
    last_cover = surface.y;
  }
  sum *= catcher.mist.x;
  if (sum < 1e-6) return;
  vec3 place = ray * (where * catcher.mist.x / sum);
  if (use_occlusion) sum *= 1.0 - shelter(place + vec3(0.0, 0.05, 0.0));
  if (sum < 1e-6) return;
  float opacity = 1.0 - exp(-sum);
  vec3 light = drop_ambient(ray) + droplet_lamps(place);
  vec3 behind = imageLoad(colour, texel).rgb;
  imageStore(colour, texel, vec4(min(mix(behind, light, opacity), vec3(60000.0)), 1.0));
}
