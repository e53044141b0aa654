#version 450 core
// Goes through the drops of the listed cells and lists those whose splash is alive.
layout(local_size_x = 64) in;
#define LISTS
#include "systems/splash/splash.glsl"

layout(std430, binding = SPLASH_CELLS_BINDING) readonly buffer SplashCells { SplashCellGpu cells[]; };
uniform uint cell_capacity;

void consider(SplashCellGpu cell, RainLayerGpu layer, uint m) {
  uint bits;
  vec4 in_cell = drop_of_cell(cell.key.xyz, m, bits);
  vec3 closed = cell.corner_edge.xyz + cell.corner_edge.w * in_cell.xyz;
  vec3 velocity = layer.velocity_diameter.xyz;
  float diameter = layer.velocity_diameter.w, oldest = cell.slab.w;
  if (closed.y > cell.slab.x || closed.y < cell.slab.y + velocity.y * oldest) return;
  // About where it landed, to thin out before the map is asked.
  float guess = clamp((closed.y - cell.slab.y) / velocity.y, 0.0, oldest);
  float away = length(closed - velocity * guess);
  float own = layer.expected.z;
  if (away > mix(0.85, 1.0, in_cell.w) * own) return;
  uint chance = random_bits(uvec4(bits, m, cell.key.x, cell.key.y));
  float importance = importance_of(diameter, -velocity.y, away, cell.slab.z);
  float odds = odds_of(importance);
  if (unit_float(chance) >= odds * reach.z) return;
  Impact i;
  if (!find_impact(closed, velocity, oldest, i)) return;
  // While the rung with droplets comes or goes, that share of the splashes has them.
  bool droplets = splash_random(chance, 3u) * reach.z < reach.w;
  SplashGpu s;
  if (!begin_splash(i, velocity, diameter, chance, droplets, 1.0 / odds, s)) return;
  vec3 at = above(i);
  float distance_to_eye = length(at);
  vec3 sum = vec3(0.0);
  int lights_here = int(cell.key.w >> 12u & 15u);
  for (int k = 0; k < RAIN_CELL_LIGHTS; ++k) {
    if (k >= lights_here) break;
    uint pair = cell.lights[k >> 1];
    sum += lamp_light(lights[(k & 1) == 0 ? pair & 0xffffu : pair >> 16u], at, distance_to_eye);
  }
  light_splash(s, sum);
  s.drop.w = importance / odds;
  int bin = bin_of(s.drop.w);
  atomicAdd(command.expected[bin >> 2][bin & 3], 256u);
  list_splash(s);
}

void main() {
  uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  uint index = group * uint(SPLASH_GROUP / SPLASH_CELL_LANES) + gl_LocalInvocationIndex / uint(SPLASH_CELL_LANES);
  if (index >= min(command.cell_groups.w, cell_capacity)) return;
  SplashCellGpu cell = cells[index];
  RainLayerGpu layer = layers[cell.key.w & 0xfffu];
  uint count = cell.key.w >> 16u;
  for (uint m = gl_LocalInvocationIndex % uint(SPLASH_CELL_LANES); m < count; m += uint(SPLASH_CELL_LANES))
    consider(cell, layer, m);
}
