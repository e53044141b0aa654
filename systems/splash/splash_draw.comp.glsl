#version 450 core
// Draws the listed splashes into the sums: the crown from its baked pictures, by the mean of those that the exposure
// sees, and near ones' droplets as short streaks. Several invocations a splash.
layout(local_size_x = 64) in;
#include "systems/drops/raster.glsl"
#include "engine/core/random.glsl"
#include "systems/splash/splash_shared.h"
#include "systems/splash/impact.h"

layout(std430, binding = SPLASH_COMMAND_BINDING) readonly buffer SplashCommand { SplashCommandGpu command; };
layout(std430, binding = SPLASH_LIST_BINDING) readonly buffer SplashList { SplashGpu splashes[]; };
layout(binding = 1) uniform sampler2DArray crown;  // sums from the start: opacity, times Fresnel, times normal's x and y
uniform uint capacity;
uniform vec2 edges;  // e_s, e_b
uniform float clear_share;  // of the opacity that the lightning's bias leaves
uniform float distance_fade;  // as printed: 1 over the distance at which nothing is left; else 0

bool long_window = false;  // the shutter is open for a good part of the crown's life
// What the pictures from the start to a phase sum to.
vec4 crown_until(vec2 uv, float first_layer, float phase, float lod) {
  if (phase <= 0.0) return vec4(0.0);
  float at = min(phase, 1.0) * float(CROWN_PHASES) - 1.0;  // layer 0 holds the first sixteenth
#ifdef SOFTWARE
  // A sample is dear there; of short windows (an instant of the truth) the phase must stay exact.
  if (long_window) {
    at = floor(at + 0.5);
    return at < 0.0 ? vec4(0.0) : textureLod(crown, vec3(uv, first_layer + at), lod);
  }
#endif
  float below = floor(at), part = at - below;
  vec4 low = below < 0.0 ? vec4(0.0) : textureLod(crown, vec3(uv, first_layer + below), lod);
  if (part <= 0.0) return low;
  return mix(low, textureLod(crown, vec3(uv, first_layer + below + 1.0), lod), part);
}

// Elevations that are baked: 5, 25, 50 and 80 degrees (crown.cpp); between two, one by chance.
float view_of(float sine, float chance) {
  float degrees_up = degrees(asin(clamp(sine, 0.0, 1.0)));
  float v = degrees_up < 25.0 ? (degrees_up - 5.0) / 20.0
            : degrees_up < 50.0 ? 1.0 + (degrees_up - 25.0) / 25.0 : 2.0 + (degrees_up - 50.0) / 30.0;
  return clamp(floor(v + chance), 0.0, float(CROWN_VIEWS - 1));
}

// A splash that stands for several covers as much as they would, up to half a pixel, and beyond is so much brighter.
// Sets drop_light; returns the optical depth of this opacity. Light that it bends from lamps is added whole; of what it
// hides only a part is another thing than the ground about it, which is what water so near the ground mostly shows.
const float hides = 0.35;
float weighed_depth(SplashGpu s, float opacity) {
  float covers = min(opacity * s.light_weight.w, max(opacity, 0.5));
  covers = min(covers, 0.98);
  float depth = depth_of(hides * covers);
  drop_light = min(s.light_weight.rgb * (opacity * s.light_weight.w / max(depth, 1e-9)), vec3(RAIN_RADIANCE_MOST));
  return depth;
}

void draw_crown(SplashGpu s, float exposure) {
  vec3 place = s.place_radius.xyz;
  float radius = s.place_radius.w;
  vec4 clip = frame.view_projection * vec4(place, 1.0);
  if (clip.w < 2.0 * frame.camera_world_m.w) return;
  vec2 centre = (clip.xy / clip.w * 0.5 + 0.5) * frame.size.xy;
  float away = length(place);
  vec4 tip = frame.view_projection * vec4(place + 0.1 * away * s.axis_age.xyz, 1.0);
  vec2 up = (tip.xy / max(tip.w, 1e-3) * 0.5 + 0.5) * frame.size.xy - centre;
  up = dot(up, up) > 1e-6 ? normalize(up) : vec2(0.0, 1.0);
  // No two alike: each leans a little, and is of its own height.
  vec4 own = random_float4(uvec4(s.bits.x, 0x1eafu, 3u, 9u));
  float lean = 0.22 * (own.x + own.y - 1.0), tall = mix(0.65, 1.3, own.z);
  vec2 unleant = up;
  up = cos(lean) * up + sin(lean) * vec2(-unleant.y, unleant.x);
  float half_side = CROWN_REACH * radius * frame.lens.z * away / (clip.w * clip.w);
  if (!(half_side < 4096.0)) return;  // nor where it is no number: that would be the whole picture
  float life = s.drop.z, age = s.axis_age.w;
  float shown = max(exposure, life / 32.0);  // of no exposure: an instant
  float last = min(age / life, 1.0), first = max((age - shown) / life, 0.0);
  if (last <= first) return;
  float per_window = life / shown;
  long_window = shown > 0.4 * life;
  float view = view_of(-dot(place, s.axis_age.xyz) / away, unit_float(s.bits.x * 0x9e3779b9u));
  float kind = float(CROWN_TAKES) * ((s.bits.y & SPLASH_FILM) != 0u ? 0.0 : 1.0) + floor(own.w * float(CROWN_TAKES));
  float first_layer = (kind * float(CROWN_VIEWS) + view) * float(CROWN_PHASES);
  float mirrored = (s.bits.x & 1u) != 0u ? -1.0 : 1.0;
  float lod = max(log2(float(CROWN_SIDE) / max(2.0 * half_side, 1e-3)), 0.0) + 0.5;  // soft, as water is
  // Before the ground that it stands on.
  float depth = frame.camera_world_m.w / max(clip.w - 1.6 * radius - 0.002 * clip.w, frame.camera_world_m.w);
  float kept = clear_share * (distance_fade > 0.0 ? clamp(away * distance_fade, 0.0, 1.0) : 1.0);
  drop_bits = s.bits.x;
  if (half_side < 0.75) {
    if (lane > 0) return;
    vec4 sum = crown_until(vec2(0.5), first_layer, last, 8.0) - crown_until(vec2(0.5), first_layer, first, 8.0);
    float area = (edges.x * sum.g + edges.y * sum.r) * per_window * 4.0 * half_side * half_side;
    dither_state = drop_bits;
    vec2 within = vec2(dither(), dither());
    add(ivec2(floor(centre + (within - 0.5) * 2.0 * half_side)), vec2(weighed_depth(s, area * kept), 0.0), depth);
    return;
  }
  // The picture is turned by `up`: pixels of its bounding box.
  float bound = half_side * (abs(up.x) + abs(up.y));  // taller ones lose the highest drops of their jets
  ivec2 low = ivec2(max(floor(centre - bound), 0.0)), high = ivec2(min(ceil(centre + bound), frame.size.xy - 1.0));
  for (int y = low.y + lane; y <= high.y; y += lanes) {
    seed_dither(y);
    for (int x = low.x; x <= high.x; ++x) {
      vec2 d = (vec2(x, y) + 0.5 - centre) / half_side;
      // Seen from above only the ring is left of it, which is round whatever its height.
      vec2 uv = vec2(dot(d, vec2(up.y, -up.x)) * mirrored, dot(d, up));
      uv.y /= uv.y > 0.0 ? mix(tall, 1.0, view / float(CROWN_VIEWS - 1)) : 1.0;
      if (any(greaterThan(abs(uv), vec2(1.0)))) continue;
      uv = uv * 0.5 + 0.5;
      vec4 sum = crown_until(uv, first_layer, last, lod);
      if (first > 0.0) sum -= crown_until(uv, first_layer, first, lod);
      // Section 3.2: opacity by the Fresnel term, scaled and biased.
      float opacity = clamp((edges.x * sum.g + edges.y * sum.r) * per_window * kept, 0.0, 0.98);
      if (opacity < 1e-4) continue;
      add(ivec2(x, y), vec2(weighed_depth(s, opacity), 0.0), depth);
    }
  }
}

void draw_droplet(SplashGpu s, uint m, uint count, float exposure) {
  uvec4 key = uvec4(s.bits.x, m, 0xd70bu, 9u);
  vec4 r = random_float4(key), r2 = random_float4(key + uvec4(0u, 0u, 1u, 0u));
  float diameter = s.drop.x, speed = s.drop.y;
  float droplet = secondary_diameter(diameter, (float(m) + r.x) / float(count));
  float first_speed = secondary_speed(speed, diameter, droplet);
  float elevation = mix(0.5235988, 1.2217305, r.y), turn = 6.2831853 * r.z;
  // The rim sheds them while the crown rises, the fast small ones first.
  float left = s.drop.z * 0.35 * clamp(0.2 * r.w + 0.8 * (droplet / diameter - 0.05) * 5.0, 0.0, 1.0);
  float b = s.axis_age.w - left, a = max(b - exposure, 0.0);
  if (b <= 0.0) return;
  vec3 axis = s.axis_age.xyz;
  vec3 side = normalize(abs(axis.x) < 0.8 ? cross(axis, vec3(1.0, 0.0, 0.0)) : cross(axis, vec3(0.0, 0.0, 1.0)));
  vec3 out_way = cos(turn) * side + sin(turn) * cross(axis, side);
  vec3 first_way = cos(elevation) * out_way + sin(elevation) * axis;
  float rim = s.place_radius.w * sqrt(min(left / max(0.35 * s.drop.z, 1e-6), 1.0)) * (0.3 + 0.7 * r2.x);
  vec3 start = s.place_radius.xyz + rim * (out_way + 0.4 * axis);
  vec2 way_a = secondary_way(first_speed, droplet, a), way_b = secondary_way(first_speed, droplet, b);
  vec3 at_a = start + first_way * way_a.x - vec3(0.0, way_a.y, 0.0);
  vec3 at_b = start + first_way * way_b.x - vec3(0.0, way_b.y, 0.0);
  float high_a = dot(at_a - s.place_radius.xyz, axis), high_b = dot(at_b - s.place_radius.xyz, axis);
  if (high_a <= 0.0) return;
  float in_air = high_b < 0.0 ? high_a / (high_a - high_b) : 1.0;
  at_b = mix(at_a, at_b, in_air);
  float share = exposure > 0.0 ? clamp((b - a) / exposure, 0.0, 1.0) * in_air : high_b < 0.0 ? 0.0 : 1.0;
  vec4 c0 = frame.view_projection * vec4(at_a, 1.0), c1 = frame.view_projection * vec4(at_b, 1.0);
  if (min(c0.w, c1.w) < 0.1) return;
  vec2 from = (c0.xy / c0.w * 0.5 + 0.5) * frame.size.xy, to = (c1.xy / c1.w * 0.5 + 0.5) * frame.size.xy;
  float across = droplet * frame.lens.z / c0.w;
  drop_light = min(s.light_weight.rgb * s.light_weight.w, vec3(RAIN_RADIANCE_MOST));
  float area = 0.7853982 * across * across * share;
  vec2 depths = vec2(frame.camera_world_m.w) / vec2(c0.w, c1.w);
  drop_bits = random_bits(key);
  vec2 span = abs(to - from);
  float reach = max(span.x, span.y), radius = 0.5 * across;
  int own_lane = lane, own_lanes = lanes;
  lane = 0;  // a droplet is one invocation's
  lanes = 1;
  if (radius >= 0.5) draw_capsule(from, to, depths, radius, min(area, 3.14159265 * radius * radius));
  else if (reach < 1.0) draw_point(from, to, depths, min(area, 0.98));
  else draw_line(from, to, depths, area, taps_of(area, reach));
  lane = own_lane;
  lanes = own_lanes;
}

void main() {
  uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  uint index = group * uint(SPLASH_GROUP / SPLASH_DRAW_LANES) + gl_LocalInvocationIndex / uint(SPLASH_DRAW_LANES);
  if (index >= min(command.draw_groups.w, capacity)) return;
  lanes = SPLASH_DRAW_LANES;
  lane = int(gl_LocalInvocationIndex % uint(SPLASH_DRAW_LANES));
  SplashGpu s = splashes[index];
  // Thinned to what is wanted: importance that is less than even odds ask for makes it so much rarer, and brighter.
  float odds = min(1.0, s.drop.w / max(command.threshold.y, 1e-30));
  if (unit_float(s.bits.x * 0x85ebca6bu ^ 0x3c6ef372u) >= odds) return;
  s.light_weight.w /= odds;
  float exposure = frame.camera_velocity_mps.w;
  if ((s.bits.y & SPLASH_CROWN) != 0u) draw_crown(s, exposure);
  uint droplets = s.bits.y >> 8u;
  for (uint m = uint(lane); m < droplets; m += uint(lanes)) draw_droplet(s, m, droplets, exposure);
}
