#version 450 core
// Splashes at random places on whatever the sky sees, as published: no drop of the field falls there. Places are fixed to
// the world, in a square that repeats; each has one splash after another, of drops drawn by how many land.
layout(local_size_x = 64) in;
#define LISTS
#include "systems/splash/splash.glsl"

uniform uint places;
uniform vec3 square;   // its side, m; where the camera is in it, m
uniform vec3 moment;   // whole turns of `period`, as bits; what is over; period, s
uniform uint turn;
uniform vec2 chances;  // share of them that is drawn; 1 over how many of the true number there are

void main() {
  uint index = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * 64u + gl_LocalInvocationIndex;
  if (index >= places) return;
  vec4 own = random_float4(uvec4(index, seed, 11u, 3u));
  float phase = moment.y + own.z;
  uint now = turn + (phase >= 1.0 ? 1u : 0u);
  float age = fract(phase) * moment.z;
  uvec4 key = uvec4(index, now, seed, 5u);
  vec4 one = random_float4(key);
  vec2 at = fract(one.xy - square.yz / square.x + 0.5) - 0.5;  // about the camera
  at *= square.x;
  if (one.w >= chances.x || length(at) > mix(0.85, 1.0, own.w) * reach.x) return;
  // Not ahead of the camera at any height at which the ground may be.
  vec4 clip_low = frame.view_projection * vec4(at.x, -reach.x, at.y, 1.0);
  vec4 clip_high = frame.view_projection * vec4(at.x, reach.x, at.y, 1.0);
  if (max(clip_low.w, clip_high.w) < 0.0 || (clip_low.x > 1.1 * clip_low.w && clip_high.x > 1.1 * clip_high.w) ||
      (clip_low.x < -1.1 * clip_low.w && clip_high.x < -1.1 * clip_high.w)) return;
  uint k = 0u;
  while (k + 1u < layer_count && layers[k].expected.x <= one.z) k += 1u;
  RainLayerGpu layer = layers[k];
  vec3 velocity = layer.velocity_diameter.xyz;
  float diameter = layer.velocity_diameter.w;
  if (age - frame.camera_velocity_mps.w >= splash_life(diameter)) return;
  vec3 place = vec3(at.x, 0.0, at.y);
  uint map = occlusion_map_of(velocity);
  float hit = occlusion_first_hit_m(map, place);
  if (abs(hit) > 1e5) return;
  Impact i;
  i.place = place + occlusion.fall_texel[map].xyz * hit;
  i.age = age;
  vec4 clip = frame.view_projection * vec4(i.place, 1.0);
  if (clip.w < frame.camera_world_m.w || any(greaterThan(abs(clip.xy), vec2(1.1 * clip.w)))) return;
  if (!meet_surface(velocity, i)) return;
  i.age = age;
  uint bits = random_bits(key);
  SplashGpu s;
  if (published) i.film = max(i.film, 0.2 * diameter);  // the same filmed sequence for all
  if (!begin_splash(i, velocity, diameter, bits, false, chances.y, s)) return;
  vec3 from = above(i);
  float distance_to_eye = length(from);
  vec3 sum = vec3(0.0);
  for (uint n = 0u; n < frame.counts.x; ++n) {
    if (lights[n].cone_shadow.w == 0.0) continue;
    vec3 light = lamp_light(lights[n], from, distance_to_eye);
    if (published) {
      // Brightened where the light is behind the splash; otherwise it only mirrors some. Over all directions that is
      // as much light as falls on it: 1 / (4 pi).
      bool directional = lights[n].direction_kind.w == float(LIGHT_DIRECTIONAL);
      vec3 direction = directional ? lights[n].direction_kind.xyz : normalize(from - lights[n].position_range.xyz);
      float cosine = -dot(direction, from) / distance_to_eye;
      light /= max(drop_phase(cosine), 1e-6);
      light *= cosine > 0.0 ? 0.3 * cosine : 0.01;
    }
    sum += light;
  }
  light_splash(s, sum);
  if (published) s.bits.y |= SPLASH_SPRITE;
  list_splash(s);
}
