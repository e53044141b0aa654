#version 450 core
// Lamps glowing in mist and in rain too far to be drawn drop by drop, at a quarter of the resolution. Alpha is the
// distance to the surface that ends the view, for the depth-aware enlargement in atmosphere.comp.glsl.
#include "systems/atmosphere/airlight.h"
#include "systems/geometry/position.glsl"
#include "systems/brdf.h"
#include "systems/lighting/shadow.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0) uniform sampler2D depth_map;
layout(binding = 1) uniform usampler2D lists;
layout(binding = 0, rgba16f) uniform writeonly image2D airlight_image;
uniform ivec2 size;
uniform float scale;    // output pixels per airlight pixel
uniform float forward;  // mean cosine of the scattering angle
uniform float reach_m;  // of rays that meet no surface

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, size))) return;
  vec2 pixel = min((vec2(texel) + 0.5) * scale, frame.size.xy - 0.5);
  float depth = texelFetch(depth_map, ivec2(pixel), 0).r;
  vec3 ray = view_ray(pixel);
  float end = depth > 0.0 ? min(length(relative_position(floor(pixel) + 0.5, depth)), reach_m) : reach_m;

  float near_extinction = frame.mist.x + frame.rain.z;
  vec2 fields, others;
  undrawn_rain_groups(fields, others);
  vec3 sum = vec3(0.0);
  uvec4 mask = texelFetch(lists, texel / 8, 0);
  while ((mask.x | mask.y | mask.z | mask.w) != 0u) {
    int word = mask.x != 0u ? 0 : mask.y != 0u ? 1 : mask.z != 0u ? 2 : 3;
    uint bits = mask[word];
    mask[word] = bits & (bits - 1u);
    LightGpu light = chosen.lights[word * 32 + findLSB(bits)];
    vec3 lamp = light.position_range.xyz;
    float c = dot(lamp, ray);
    float h = max(length(cross(lamp, ray)), max(light.intensity_radius.w, 0.02));
    vec2 stretch = vec2(0.0, end);
    if (light.cone_shadow.x > 0.0) {
      float outer = clamp(-light.cone_shadow.y / light.cone_shadow.x, 0.001, 0.999);
      stretch = ray_in_cone(lamp, light.direction_kind.xyz, outer, ray, end);
    }
    if (stretch.y <= stretch.x) continue;
    vec2 angles = airlight_angles(c, h, stretch.x, stretch.y);
    float glow = 0.0;
    for (int i = 0; i < AIRLIGHT_POINTS; ++i) {
      vec2 point = gauss_point(i);
      float eta = angles.x + angles.y * 0.5 * (1.0 + point.x);
      float sine = sin(eta), cosine_eta = max(cos(eta), 1e-4);
      float x = c + h * sine / cosine_eta;
      vec3 from_lamp = ray * x - lamp;
      float cosine = dot(from_lamp, light.direction_kind.xyz) * cosine_eta / h;  // |from_lamp| = h / cos(eta)
      float strength = spot_attenuation(cosine, light.cone_shadow.x, light.cone_shadow.y);
      // Around the onset of a field drops that draw themselves give way to extinction, class by class, over a long
      // way; other techniques end at one distance. Ramps stand for both: a step would show as discs about the lamps
      // where a node of the quadrature crosses it.
      float undrawn = fields.x * smoothstep(0.4 * fields.y, 1.6 * fields.y + 0.001, x) +
                      others.x * smoothstep(0.8 * others.y, 1.2 * others.y + 0.001, x);
      float thickness = fields.x * max(x - fields.y, 0.0) + others.x * max(x - others.y, 0.0);
      glow += point.y * phase_hg(-sine, forward) * (near_extinction + undrawn) * strength *
              exp(-near_extinction * airlight_path(sine, cosine_eta, c, h) - thickness);
    }
#ifdef SHADOWS
    // The lamp's shadow where the ray passes nearest to it: no halo through a house.
    if (light.cone_shadow.z >= 0.0)
      glow *= plain_shadow(light.cone_shadow.z, ray * clamp(c, stretch.x, stretch.y) - lamp, light.cone_shadow.w);
#endif
    sum += light.intensity_radius.rgb * (glow * 0.5 * angles.y / h);
  }
  imageStore(airlight_image, texel, vec4(min(sum * frame.mist.yzw, vec3(6e4)), end));
}
