#version 450 core
// The rainfall of Tatarchuk and Isidoro 2006, section 3.1, as printed: in the screen's own coordinates, before whatever
// is there, one fetch of placement and one projective fetch of the drop. What the paper leaves open is said at its
// place. Into a buffer of its own, which layered_blur.comp.glsl smears and lays over the picture.
layout(local_size_x = 8, local_size_y = 8) in;
#define PUBLISHED
#include "systems/frame.glsl"
#include "systems/rainfall/layered/layered_shared.h"
#ifdef NORMALS
#include "systems/lighting/environment.glsl"
#endif
#include "systems/rainfall/layered/drop_shading.glsl"
#include "systems/drops/lamp_light.glsl"
layout(binding = 0) uniform sampler2D scene_depth;
uniform bool use_depth;
layout(binding = 1) uniform usampler2D placement;
layout(binding = 2) uniform sampler2DArray drop_light;  // only its mean of the surroundings is used here
layout(rgba16f, binding = 0) writeonly uniform image2D rain;  // light (output units) and opacity

uniform vec3 ray_corner, ray_x, ray_y;
uniform vec2 direction;    // v_r in clip space, unit
uniform float speed;       // |v_r|, clip units a second
uniform float elapsed_s;   // "delta t": since the start, so that the layer moves at all
uniform float parallax;    // p_r
uniform float cells;       // of the placement texture over the picture's height, at w = 1
uniform float opacity;     // of a drop, so that the picture's mean is the rain's
uniform float present;     // share of the placement's drops that fall
uniform float elongation;  // length of a drop's image over its width

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(at, ivec2(frame.size.xy)))) return;
  vec2 place = (vec2(at) + 0.5) * frame.size.zw;
  vec3 ray = normalize(ray_corner + (vec2(at) + 0.5).x * ray_x + (vec2(at) + 0.5).y * ray_y);
  vec2 clip = (place * 2.0 - 1.0) * vec2(frame.lens.y, 1.0);
  // (x_i, y_i) = v_r * |v_r| * delta t, from the pixel's own clip-space position.
  vec2 moved = clip - direction * speed * elapsed_s;
  // Along and across the rain's direction, so that drops can be long.
  vec2 tentative = vec2(moved.x * direction.y - moved.y * direction.x, dot(moved, direction) / elongation) * cells * 0.5;
  // r_i: a random value for an individual raindrop; w_i = p_r r_i.
  uint first = texelFetch(placement, ivec2(floor(tentative)) & 255, 0).x;
  float r = 0.25 + 0.75 * float(first >> 24u) / 255.0;
  float w = parallax * r;
  // The projective fetch from the rainfall movement texture.
  vec2 projected = tentative / w;
  ivec2 cell = ivec2(floor(projected));
  uint drop = texelFetch(placement, cell & 255, 0).x;
  vec2 within = (fract(projected) - 0.5) * 2.0;
  float mark = clamp(present * 256.0 - float(drop & 255u), 0.0, 1.0);
  vec3 texel = vec3(0.0);
  float scene_m = 200.0;
  if (use_depth) {
    float depth = texelFetch(scene_depth, at, 0).r;
    if (depth > 0.0) scene_m = min(frame.camera_world_m.w / depth, scene_m);
  }
  // The distortion from velocity, place, distribution, parallax and the scene's depth, as a bias of the level of detail.
  float bias = 0.5 * log2(1.0 + speed * w) + float((drop >> 8u) & 255u) / 255.0 + 0.1 * log2(1.0 + scene_m);
  texel = textureLod(drop_normals, vec3(within * 0.5 + 0.5, float((drop >> 16u) % uint(LAYERED_SHAPES))), bias).xyz;
  float covered = clamp(texel.z, 0.0, 1.0) * mark;

  vec3 light = textureLod(drop_light, vec3(place, 3.0), 0.0).rgb;
  vec3 right = normalize(ray_x), up = normalize(ray_y);
  vec2 xy = texel.xy / max(texel.z, 0.05);
  vec3 normal = normalize(right * xy.x + up * xy.y - ray * sqrt(max(1.0 - dot(xy, xy), 0.0025)));
  float fresnel = drop_fresnel(clamp(-dot(ray, normal), 0.0, 1.0));
#ifdef NORMALS
  // Air to water, once, and the reflection.
  light = frame.lens.w * (fresnel * environment_radiance(reflect(ray, normal), 0.2) +
                          (1.0 - fresnel) * environment_radiance(refract(ray, normal, 1.0 / 1.333), 0.2));
#endif
  // Point lights, specular (Blinn and Phong), attenuated towards the drop's edge by the Fresnel term.
  vec3 place_m = ray * (2.0 + 10.0 * r);
  for (uint i = 0u; i < frame.counts.x; ++i) {
    vec3 to_light = lights[i].position_range.xyz - place_m;
    if (lights[i].direction_kind.w == float(LIGHT_DIRECTIONAL)) to_light = -lights[i].direction_kind.xyz;
    float d2 = max(dot(to_light, to_light), 0.01);
    vec3 halfway = normalize(normalize(to_light) - ray);
    float shine = pow(max(dot(normal, halfway), 0.0), 16.0);
    float falls = lights[i].direction_kind.w == float(LIGHT_DIRECTIONAL) ? 1.0 : 1.0 / d2;
    light += lights[i].intensity_radius.rgb * (lights[i].cone_shadow.w * shine * fresnel * falls * frame.lens.w);
  }
  float alpha = artist_opacity(covered * opacity);
  imageStore(rain, at, vec4(min(artist_light(light * alpha, alpha), vec3(6e4)), alpha));
}
