// From an impact to a splash in the list: what it is, what lights it, how likely it is kept.
#ifndef SYSTEMS_SPLASH_SPLASH_GLSL
#define SYSTEMS_SPLASH_SPLASH_GLSL
#define SCENE
#define LAMPS
#include "systems/rainfall/streak.glsl"
#include "systems/geometry/position.glsl"
#include "systems/splash/splash_shared.h"
#include "systems/splash/impact.h"

layout(std430, binding = SPLASH_COMMAND_BINDING) buffer SplashCommand { SplashCommandGpu command; };
layout(binding = 1) uniform sampler2D surface_normal;  // of the G-buffer: octahedral normal, roughness
layout(binding = 2) uniform sampler2D surface_water;   // mm standing, mm of film
layout(binding = 3) uniform sampler2D overhead_light;  // irradiance by what is no light, lux

uniform bool has_normal, has_water, has_overhead;
uniform vec4 overhead_place;  // xz of its middle, relative, m; its side, m; irradiance that the environment knows of
uniform float overhead_reach;  // m about the camera, where it is drawn
uniform vec4 reach;           // m: of splashes, of their droplets; share of field and secondary; share of secondary
uniform vec4 look;            // size, its variation, opacity, its variation
uniform vec3 lights_look;     // backlight; lightning bias l_b; ambient, output units
uniform vec3 flash;      // of lightning, from all of the sky: cd/m2
uniform bool published;
uniform vec3 tiling;  // of tiles of ground: the first corner, relative, m; their side, m

struct Impact {
  vec3 place, normal;
  float age;        // s, when the shutter closes
  float roughness;
  float film;       // m
};

vec3 unit_of_octahedral(vec2 p) {
  vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  float t = max(-n.z, 0.0);
  n.x += n.x >= 0.0 ? -t : t;
  n.y += n.y >= 0.0 ? -t : t;
  return normalize(n);
}

// The surface at an impact as the G-buffer has it, where it is seen; else level asphalt. Moves the impact onto it, along
// the drop's way: maps of shelter know heights to some centimetres only. False: not in the picture.
bool meet_surface(vec3 velocity, inout Impact i) {
  i.normal = vec3(0.0, 1.0, 0.0);
  i.roughness = TOP_ROUGHNESS;
  i.film = 0.0;
  vec4 clip = frame.view_projection * vec4(i.place, 1.0);
  if (clip.w < frame.camera_world_m.w) return false;
  vec2 pixel = (clip.xy / clip.w * 0.5 + 0.5) * frame.size.xy;
  vec2 margin = vec2(0.03 * frame.lens.z / clip.w);
  if (any(lessThan(pixel, -margin)) || any(greaterThan(pixel, frame.size.xy + margin))) return false;
  ivec2 texel = ivec2(clamp(pixel, vec2(0.0), frame.size.xy - 1.0));
  float depth = texelFetch(scene_depth, texel, 0).r;
  if (depth <= 0.0) return true;
  vec3 surface = relative_position(vec2(texel) + 0.5, depth);
  vec3 normal = vec3(0.0, 1.0, 0.0);
  float roughness = TOP_ROUGHNESS;
  if (has_normal) {
    vec4 texel_of_normal = texelFetch(surface_normal, texel, 0);
    normal = unit_of_octahedral(texel_of_normal.xy * 2.0 - 1.0);
    roughness = texel_of_normal.z;
  }
  float off = dot(i.place - surface, normal), towards = dot(velocity, normal), fall = length(velocity);
  // Something else stands before it, or behind; a surface seen from below hides what lands on it.
  if (abs(off) > 0.12 + 0.01 * clip.w)
    return i.place.y < 0.0 && depth < frame.camera_world_m.w / clip.w * 1.05 + 1e-6;
  // The side that is seen is not the one that was struck: through thin cloth nothing shows.
  if (towards > 0.05 * fall || (i.place.y > 0.0 && dot(normal, surface) > 0.0)) return false;
  if (towards > -0.05 * fall) return i.place.y < 0.0;
  float later = -off / towards;
  i.place += velocity * later;
  i.age -= later;
  i.normal = normal;
  i.roughness = roughness;
  if (has_water) {
    vec2 water = texelFetch(surface_water, texel, 0).rg;
    i.film = 1e-3 * (water.r + water.g);
  }
  return true;
}

// Where and when a drop of the field landed that stands in its class's frame at `closed`, under the ground.
bool find_impact(vec3 closed, vec3 velocity, float most_age, out Impact i) {
  uint map = occlusion_map_of(velocity);
  float along = dot(velocity, occlusion.fall_texel[map].xyz);
  i.age = -occlusion_first_hit_m(map, closed) / max(along, 1e-3);
  if (!(i.age > -0.02 && i.age < most_age + 0.02)) return false;
  i.place = closed - velocity * i.age;
  // The map was asked below the surface; where that slants, or the drop falls otherwise than the map's, again upon it.
  float left = occlusion_first_hit_m(map, i.place);
  if (abs(left) > 0.4) return false;  // past an edge
  i.age -= left / along;
  i.place = closed - velocity * i.age;
  if (!meet_surface(velocity, i)) return false;
  return i.age >= 0.0 && i.age < most_age;
}

// The largest share of the picture that a splash can change, about: pixels, times how bright it is.
float importance_of(float diameter, float speed, float distance_to_eye, float brightness) {
  float radius = crown_radius(diameter, speed, 0.2 * diameter, 1.0) * frame.lens.z / max(distance_to_eye, 0.2);
  return radius * radius * max(brightness, 1e-4);
}
// What droplets that have outlived their crown weigh beside it: their area against the crown's.
const float DROPLETS_WEIGH = 0.04;
// Of two that weigh the same one may be kept and the other not: by a number of its own, so that which ones does not
// depend on who comes first.
float odds_of(float importance) { return min(1.0, importance / max(command.threshold.x, 1e-30)); }
int bin_of(float importance) {
  return clamp(int(2.0 * (log2(max(importance, 1e-20)) - float(SPLASH_LEAST_LOG))), 0, SPLASH_BINS - 1);
}

float splash_random(uint bits, uint which) { return random_float(uvec4(bits, which, 0x5b1a5u, 7u)); }

// Irradiance from above that the environment, captured about the camera, does not have, over 4 pi: what water that
// scatters to all sides shows of it, cd/m2.
vec3 overhead_at(vec3 place) {
  if (!has_overhead || any(greaterThan(abs(place.xz), vec2(overhead_reach + 0.2)))) return vec3(0.0);
  vec2 uv = (place.xz - overhead_place.xy) / overhead_place.z + 0.5;
  if (any(greaterThan(abs(uv - 0.5), vec2(0.5)))) return vec3(0.0);
  vec3 lux = textureLod(overhead_light, uv, 0.0).rgb;
  float most = max(max(lux.r, lux.g), max(lux.b, 1e-9));
  return lux * (max(most - overhead_place.w, 0.0) / most * 0.0795775);
}

// How bright a splash at a place may be, for its importance. Square root: the picture's eye is not linear, and no lamp
// should take all splashes to itself.
float brightness_at(vec3 place, uvec4 indices, int count) {
  float away = max(length(place), 0.1);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < count; ++i) {
    uint pair = indices[i >> 1];
    sum += lamp_light(lights[(i & 1) == 0 ? pair & 0xffffu : pair >> 16u], place, away);
  }
  return sqrt(max(max(sum.r, sum.g), sum.b) * frame.lens.w + lights_look.z);
}

// A drop of a listed cell that may have a splash.
struct SplashChance {
  vec3 closed;
  uint bits;
  float importance, odds, chance;  // of its crown
};
bool may_splash_here(SplashCellGpu cell, RainLayerGpu layer, uint m, out SplashChance c) {
  uint own;
  vec4 in_cell = drop_of_cell(cell.key.xyz, m, own);
  c.closed = cell.corner_edge.xyz + cell.corner_edge.w * in_cell.xyz;
  vec3 velocity = layer.velocity_diameter.xyz;
  float oldest = cell.slab.w;
  if (c.closed.y > cell.slab.x || c.closed.y < cell.slab.y + velocity.y * oldest) return false;
  // About where it landed, to thin out before the map is asked.
  float guess = clamp((c.closed.y - cell.slab.y) / velocity.y, 0.0, oldest);
  vec3 landed = c.closed - velocity * guess;
  float away = length(landed);
  if (away > mix(0.85, 1.0, in_cell.w) * layer.expected.z) return false;
  // Well out of the picture, however high the ground is within the cell's slab.
  vec4 clip = frame.view_projection * vec4(landed, 1.0);
  float slack = 0.1 * abs(clip.w) + 2.0 * (0.2 + cell.slab.x - cell.slab.y);
  if (clip.w < -slack || abs(clip.x) > clip.w + slack * 2.0) return false;
  c.bits = random_bits(uvec4(own, m, cell.key.x, cell.key.y));
  c.importance = cell.slab.z / max(away * away, 0.04);
  c.odds = odds_of(c.importance);
  c.chance = unit_float(c.bits);
  return c.chance < c.odds * reach.z;
}

#ifdef LISTS
layout(std430, binding = SPLASH_LIST_BINDING) writeonly buffer SplashList { SplashGpu splashes[]; };
uniform uint capacity;

void list_splash(SplashGpu s) {
  uint slot = atomicAdd(command.draw_groups.w, 1u);
  if (slot >= capacity) return;
  const uint per_row = uint(SPLASH_ROW * (SPLASH_GROUP / SPLASH_DRAW_LANES));
  if (slot % per_row == 0u) atomicMax(command.draw_groups.y, slot / per_row + 1u);
  splashes[slot] = s;
}

// Fills all but the light. False: the drop spreads, or nothing of it is left.
bool begin_splash(Impact i, vec3 velocity, float diameter, uint bits, bool droplets_wanted, float weight, out SplashGpu s) {
  float speed = -dot(velocity, i.normal);
  if (speed <= 0.05 || splash_number(diameter, speed, i.film, i.roughness) <= 1.0) return false;
  float life = splash_life(diameter);
  bool film = i.film >= 0.1 * diameter;
  float exposure = frame.camera_velocity_mps.w;
  bool crown = i.age - exposure < life;
  float distance_to_eye = length(i.place);
  uint droplets = 0u;
  // Only drops above 1 mm near the eye, and only where a droplet is seen: the fewer, the heavier.
  if (droplets_wanted && diameter > 1e-3 && distance_to_eye < reach.y && i.age - exposure < SECONDARY_LIFE)
    droplets = secondary_count(diameter, speed);
  if (!crown && droplets == 0u) return false;
  float size = look.x * (1.0 + look.y * (2.0 * splash_random(bits, 1u) - 1.0));
  float opacity = look.z * (1.0 + look.w * (2.0 * splash_random(bits, 2u) - 1.0));
  float radius = film ? crown_radius(diameter, speed, i.film, 1.0) : corona_radius(diameter, speed);
  s.place_radius = vec4(i.place, radius * size);
  s.light_weight = vec4(0.0, 0.0, 0.0, weight * opacity);
  s.axis_age = vec4(i.normal, i.age);
  s.drop = vec4(diameter, speed, life, 1e30);  // not to be thinned, unless the caller says so
  s.bits = uvec4(bits, (crown ? SPLASH_CROWN : 0u) | (film ? SPLASH_FILM : 0u) | droplets << 8u, 0u, 0u);
  return true;
}

// sum: of lamp_light; towards the eye through mist and rain, in output units.
void light_splash(inout SplashGpu s, vec3 sum) {
  float distance_to_eye = length(s.place_radius.xyz);
  vec3 light = sum * lights_look.x * lights_look.y + overhead_at(s.place_radius.xyz) + flash;
  s.light_weight.rgb = seen_light(light, distance_to_eye);
}

vec3 above(Impact i) { return i.place + 0.005 * i.normal; }
#endif

#endif
