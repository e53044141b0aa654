#version 450 core
// Wang and Wade 2004: four textures of streaks on a double cone about the camera, blended in one shader. Instead of
// rasterising the cone, each pixel's ray is met with it in closed form, which gives the same picture: a ray that leaves
// the eye at an angle psi from the axis meets a cone of base radius r and half height r / slope at t = r / (sin psi +
// slope |cos psi|), so at height r g along the axis, g = cos psi / (sin psi + slope |cos psi|), the same for all layers.
// The cost is that of the pixels: heavy rain costs what light rain costs. A vec4 holds the four layers, nearest first.
// Rows go by eights, for light and shelter that are looked up at their ends alone.
layout(local_size_x = 32, local_size_y = 1) in;
#include "systems/frame.glsl"
#include "systems/drops/ambient.glsl"
#ifdef SCENE
#include "systems/occlusion/occlusion.glsl"
layout(binding = 0) uniform sampler2D scene_depth;
uniform bool use_occlusion;
uniform vec3 fall;
#endif
#ifdef LAMPS
#include "systems/rainfall/light_volume.glsl"
uniform vec4 nearer_slice, farther_slice;  // of the light volume, of each half of the layers' shells
#endif
#ifdef SNOW
// Wang and Wade: "light snow should jitter as it falls". Flakes sway sideways, in waves that go through the textures.
uniform vec4 jitter;        // tiles across
uniform vec4 jitter_waves;  // a tile
uniform vec2 jitter_turns;  // of two waves, now
#endif
#define ROWS 8

layout(rgba16f, binding = 0) uniform image2D colour;
layout(binding = 1) uniform sampler2DArray first_streaks;
uniform vec4 first_weights[4];  // of a texel's channels, of each layer: opacity over its mean
#ifdef TWO_SETS
layout(binding = 2) uniform sampler2DArray second_streaks;
uniform vec4 second_weights[4];
#endif
uniform vec4 detail;             // level of it
uniform vec4 tiles, shear;       // tiles across: a radian of azimuth, a unit of g
uniform vec4 along, phase;       // tiles along the axis: a unit of g, and now
uniform vec4 shell_from, shell_middle, shell_to;  // m from the eye
uniform float extinction;                         // 1/m
uniform vec3 cone;                                // slope, share of even extinction everywhere, published
uniform vec3 ray_corner, ray_x, ray_y;     // ray of a place in the picture, one metre deep: corner + x ray_x + y ray_y
uniform vec3 cone_corner, cone_x, cone_y;  // the same in the cone's frame, z along the axis

// atan(y, x) to 2e-4, a fifth of a texel, in half the time.
float azimuth_of(vec2 at) {
  vec2 size = abs(at);
  float ratio = min(size.x, size.y) / max(max(size.x, size.y), 1e-12), r2 = ratio * ratio;
  float angle = ratio + ratio * r2 * (-0.327622764 + r2 * (0.15931422 - 0.0464964749 * r2));
  angle = size.y > size.x ? 1.57079633 - angle : angle;
  angle = at.x < 0.0 ? 3.14159265 - angle : angle;
  return at.y < 0.0 ? -angle : angle;
}

#ifdef LAMPS
vec3 lamp_at(vec2 at, float slice) { return textureLod(rain_light_volume, vec3(at, slice), 0.0).rgb; }
#endif

#ifdef SCENE
// Which layers are open to the sky along a ray. Where in a shell a streak is is not known: lanes of azimuth spread over
// it.
vec4 open_at(uint map, vec3 ray, float azimuth, float far) {
  vec4 lane = fract(0.618034 * floor(48.0 * tiles * azimuth));
  vec4 at = mix(shell_from, clamp(vec4(far), shell_from, shell_to), lane);
  return vec4(occlusion_sheltered(map, ray * at.x) ? 0.0 : 1.0, occlusion_sheltered(map, ray * at.y) ? 0.0 : 1.0,
              occlusion_sheltered(map, ray * at.z) ? 0.0 : 1.0, occlusion_sheltered(map, ray * at.w) ? 0.0 : 1.0);
}

float scene_distance(ivec2 pixel, float slant) {
  return slant * frame.camera_world_m.w / max(texelFetch(scene_depth, pixel, 0).r, 1e-9);
}
#endif

void main() {
  ivec2 size = ivec2(frame.size.xy);
  ivec2 pixel = ivec2(gl_GlobalInvocationID.x, ROWS * int(gl_GlobalInvocationID.y));
  if (any(greaterThanEqual(pixel, size))) return;
  vec2 centre = vec2(pixel) + 0.5;
  vec3 ray = ray_corner + centre.x * ray_x + centre.y * ray_y, ray_last = ray + float(ROWS) * ray_y;
  vec3 in_cone = cone_corner + centre.x * cone_x + centre.y * cone_y;
  bool published = cone.z > 0.0;
  vec3 around = drop_ambient(normalize(ray));
  vec3 around_step = (drop_ambient(normalize(ray_last)) - around) / float(ROWS);
#ifdef LAMPS
  // Mean radiance of drops in each half of each shell, at both ends of the rows.
  vec2 low = centre * frame.size.zw, high = low + vec2(0.0, float(ROWS) * frame.size.w);
  vec3 a0 = lamp_at(low, nearer_slice.x), b0 = lamp_at(low, farther_slice.x);
  vec3 a1 = lamp_at(low, nearer_slice.y), b1 = lamp_at(low, farther_slice.y);
  vec3 a2 = lamp_at(low, nearer_slice.z), b2 = lamp_at(low, farther_slice.z);
  vec3 a3 = lamp_at(low, nearer_slice.w), b3 = lamp_at(low, farther_slice.w);
  const float one = 1.0 / float(ROWS);
  vec3 a0_step = one * (lamp_at(high, nearer_slice.x) - a0), b0_step = one * (lamp_at(high, farther_slice.x) - b0);
  vec3 a1_step = one * (lamp_at(high, nearer_slice.y) - a1), b1_step = one * (lamp_at(high, farther_slice.y) - b1);
  vec3 a2_step = one * (lamp_at(high, nearer_slice.z) - a2), b2_step = one * (lamp_at(high, farther_slice.z) - b2);
  vec3 a3_step = one * (lamp_at(high, nearer_slice.w) - a3), b3_step = one * (lamp_at(high, farther_slice.w) - b3);
#endif
#ifdef SCENE
  vec4 open = vec4(1.0), open_step = vec4(0.0);
  if (use_occlusion && !published) {
    uint map = occlusion_map_of(fall);
    ivec2 last = ivec2(pixel.x, min(pixel.y + ROWS, size.y) - 1);
    float side = azimuth_of(in_cone.xy);
    open = open_at(map, normalize(ray), side, scene_distance(pixel, length(ray)));
    open_step = (open_at(map, normalize(ray_last), side, scene_distance(last, length(ray_last))) - open) / float(ROWS);
  }
#endif
  for (int row = 0; row < ROWS && pixel.y < size.y; ++row) {
    float across2 = dot(in_cone.xy, in_cone.xy), slant2 = across2 + in_cone.z * in_cone.z;
    float across = sqrt(across2), sine = across * inversesqrt(slant2);
    float g = in_cone.z / max(across + cone.x * abs(in_cone.z), 1e-4);
    float azimuth = azimuth_of(in_cone.xy);
    // Opacity of each layer over its mean. No two columns of tiles are level, or eyes would find the pattern.
    vec4 u = tiles * azimuth + shear * g;
    vec4 v = along * g - phase + 0.618034 * floor(u);
#ifdef SNOW
    u += jitter * (0.6 * sin(6.2831853 * (jitter_turns.x + jitter_waves * (u + v))) +
                   0.4 * sin(6.2831853 * (jitter_turns.y + jitter_waves * (2.0 * v - u))));
#endif
    vec4 pattern = vec4(dot(textureLod(first_streaks, vec3(u.x, v.x, 0.0), detail.x), first_weights[0]),
                        dot(textureLod(first_streaks, vec3(u.y, v.y, 1.0), detail.y), first_weights[1]),
                        dot(textureLod(first_streaks, vec3(u.z, v.z, 2.0), detail.z), first_weights[2]),
                        dot(textureLod(first_streaks, vec3(u.w, v.w, 3.0), detail.w), first_weights[3]));
#ifdef TWO_SETS
    pattern += vec4(dot(textureLod(second_streaks, vec3(u.x, v.x, 0.0), detail.x), second_weights[0]),
                    dot(textureLod(second_streaks, vec3(u.y, v.y, 1.0), detail.y), second_weights[1]),
                    dot(textureLod(second_streaks, vec3(u.z, v.z, 2.0), detail.z), second_weights[2]),
                    dot(textureLod(second_streaks, vec3(u.w, v.w, 3.0), detail.w), second_weights[3]));
#endif
    // Near the ends the textures pinch. Published: they turn transparent towards the tips. Mended: even extinction.
    float even = max(cone.y, 1.0 - smoothstep(0.34, 0.56, sine));
    pattern = published ? pattern * (1.0 - cone.x * abs(g)) : mix(pattern, vec4(1.0), even);
    // Optical depths of what stands before the scene, of the nearer and the farther half of each shell.
#ifdef SCENE
    float away = published ? 1e9 : scene_distance(pixel, sqrt(slant2));
    vec4 nearer = extinction * clamp(away - shell_from, vec4(0.0), shell_middle - shell_from);
    vec4 farther = extinction * clamp(away - shell_middle, vec4(0.0), shell_to - shell_middle);
    float before = extinction * min(away, shell_from.x) * open.x;
    pattern *= open;
    open += open_step;
#else
    vec4 nearer = extinction * (shell_middle - shell_from), farther = extinction * (shell_to - shell_middle);
    float before = extinction * shell_from.x;
#endif
    vec4 depth = nearer + farther;
    // (1 - exp(-depth)) / depth, so that the mean of all pixels is that of fog.
    vec4 per_depth = pattern * (1.0 - depth * (0.5 - depth * (0.1666667 - 0.0416667 * depth)));
    vec4 clear = max(1.0 - per_depth * depth, vec4(0.0));
    float nearest = 1.0 - before * (1.0 - 0.5 * before);
    vec4 reach = nearest * vec4(1.0, clear.x, clear.x * clear.y, clear.x * clear.y * clear.z);
    float through = reach.w * clear.w;
    vec3 light = around * (1.0 - through);
#ifdef LAMPS
    vec4 a = reach * per_depth * nearer, b = reach * per_depth * farther;
    light += (a.x * a0 + b.x * b0 + a.y * a1 + b.y * b1 + a.z * a2 + b.z * b2 + a.w * a3 + b.w * b3) / frame.lens.w;
    a0 += a0_step;
    b0 += b0_step;
    a1 += a1_step;
    b1 += b1_step;
    a2 += a2_step;
    b2 += b2_step;
    a3 += a3_step;
    b3 += b3_step;
#endif
    imageStore(colour, pixel, vec4(imageLoad(colour, pixel).rgb * through + light, 1.0));
    pixel.y += 1;
    in_cone += cone_y;
    around += around_step;
  }
}
