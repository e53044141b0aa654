#version 450 core
// Lists the splashes of those candidates that landed and are alive.
layout(local_size_x = 64) in;
#define LISTS
#include "systems/splash/splash.glsl"

layout(std430, binding = SPLASH_CELLS_BINDING) readonly buffer SplashCells { SplashCellGpu cells[]; };
layout(std430, binding = SPLASH_CANDIDATES_BINDING) readonly buffer SplashCandidates { uvec2 candidates[]; };
uniform uint candidate_capacity;

void main() {
  uint index = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * uint(SPLASH_GROUP) + gl_LocalInvocationIndex;
  if (index >= min(command.candidate_groups.w, candidate_capacity)) return;
  uvec2 candidate = candidates[index];
  SplashCellGpu cell = cells[candidate.x];
  RainLayerGpu layer = layers[cell.key.w & 0xfffu];
  SplashChance c;
  if (!may_splash_here(cell, layer, candidate.y, c)) return;
  vec3 velocity = layer.velocity_diameter.xyz;
  float diameter = layer.velocity_diameter.w;
  Impact i;
  if (!find_impact(c.closed, velocity, cell.slab.w, i)) return;
  // While the rung with droplets comes or goes, that share of the splashes has them.
  bool droplets = splash_random(c.bits, 3u) * reach.z < reach.w;
  // One that has nothing but droplets left weighs less, and is thinned as such.
  float odds = c.odds;
  bool crown = i.age - frame.camera_velocity_mps.w < splash_life(diameter);
  if (!crown) {
    odds = odds_of(DROPLETS_WEIGH * c.importance);
    if (c.chance >= odds * reach.z) return;
  }
  SplashGpu s;
  if (!begin_splash(i, velocity, diameter, c.bits, droplets, 1.0 / odds, s)) return;
  vec3 at = above(i);
  float distance_to_eye = length(at);
  vec3 sum = vec3(0.0);
  int lights_here = int(cell.key.w >> 12u & 15u);
  for (int k = 0; k < lights_here; ++k) {
    uint pair = cell.lights[k >> 1];
    sum += lamp_light(lights[(k & 1) == 0 ? pair & 0xffffu : pair >> 16u], at, distance_to_eye);
  }
  light_splash(s, sum);
  s.drop.w = (crown ? 1.0 : DROPLETS_WEIGH) * c.importance / odds;
  int bin = bin_of(s.drop.w);
  atomicAdd(command.expected[bin >> 2][bin & 3], 256u);
  list_splash(s);
}
