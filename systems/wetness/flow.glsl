// Films that run: rivulets down walls, waves down slopes. Patterns in the world, moved by how far the film has flown
// (CPU, closed form), so that they neither swim with the camera nor jump when the speed changes.
#ifndef SYSTEMS_WETNESS_FLOW_GLSL
#define SYSTEMS_WETNESS_FLOW_GLSL
#include "systems/wetness/wetness_shared.h"

uint flow_hash(uvec2 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * 1664525u;
  v.y += v.x * 1664525u;
  v ^= v >> 16u;
  v.x += v.y * 1664525u;
  return v.x ^ (v.x >> 16u);
}
float flow_random(ivec2 cell) { return float(flow_hash(uvec2(cell)) >> 8u) * (1.0 / 16777216.0); }

// Value noise 0 to 1 and its gradient (Perlin's fade); repeats only where the integers do.
vec3 flow_noise(vec2 p) {
  ivec2 cell = ivec2(floor(p));
  vec2 f = p - vec2(cell);
  vec2 u = f * f * f * (f * (f * 6.0 - 15.0) + 10.0), du = 30.0 * f * f * (f * (f - 2.0) + 1.0);
  float a = flow_random(cell), b = flow_random(cell + ivec2(1, 0)), c = flow_random(cell + ivec2(0, 1)),
        d = flow_random(cell + ivec2(1, 1));
  float k = a - b - c + d;
  return vec3(a + (b - a) * u.x + (c - a) * u.y + k * u.x * u.y,
              du * (vec2(b - a, c - a) + k * u.yx));
}

struct Flow {
  float thickness;  // multiplies the film
  vec2 slope;       // of its surface: walls: across and down; slopes: across and along the fall
};

// A wall. across: m along it, level; height: m; footprint: m that a pixel covers of it.
// Films on walls break up into rivulets: lanes about 9 cm apart, a third of which carry one at a time, that waver, widen
// and thin out, 12 mm wide, beads of water running down them.
Flow wall_flow(float across, float height, float flown_m, float footprint_m) {
  Flow flow = Flow(1.0, vec2(0.0));
  const float lane_m = 0.09;
  float fades = clamp(0.03 / max(footprint_m, 1e-4) - 0.3, 0.0, 1.0);  // finer than pixels: their mean
  vec3 bend = flow_noise(vec2(across * 4.0, height * 1.7));
  float x = across + 0.05 * (bend.x - 0.5) + 0.012 * (flow_noise(vec2(across * 9.0, height * 9.0)).x - 0.5);
  float lane = floor(x / lane_m);
  float own = flow_random(ivec2(int(lane), 77));
  float centre = (lane + 0.3 + 0.4 * own) * lane_m;
  float down = height + flown_m * (0.5 + own);
  // Which stretches carry water, and the beads in it.
  float runs = smoothstep(0.55, 0.75, flow_noise(vec2(lane * 1.37, down * 0.35)).x);
  float bead = flow_noise(vec2(lane * 3.1, down * 9.0)).x;
  float width = 0.004 + 0.006 * bead;
  float t = clamp((x - centre) / width, -1.0, 1.0);
  float bulge = (1.0 - t * t) * (1.0 - t * t);
  float strength = runs * fades;
  flow.thickness = mix(1.0, 0.75 + 3.0 * bulge, strength);
  // 0.4 mm high at most.
  flow.slope = vec2(-4.0 * t * (1.0 - t * t) * 0.4e-3 / width, 0.0) * strength;
  return flow;
}

// A slope: waves of 4 to 15 cm that run down it. way: unit, level, downhill. Two patterns a third of a metre apart fade
// into one another, so that neighbours that run slightly different ways never come apart.
Flow slope_flow(vec2 place, vec2 way, float flown_m, float footprint_m) {
  const float turn_m = 0.7;
  Flow flow = Flow(0.0, vec2(0.0));
  float fades = clamp(0.05 / max(footprint_m, 1e-4) - 0.3, 0.0, 1.0);
  for (int i = 0; i < 2; ++i) {
    float turns = flown_m / turn_m + 0.5 * float(i);
    float phase = fract(turns), weight = 1.0 - abs(2.0 * phase - 1.0);
    vec2 at = place - way * ((phase - 0.5) * turn_m) + vec2(17.3, 9.1) * mod(floor(turns), 61.0);
    vec2 q = vec2(dot(at, vec2(-way.y, way.x)) * 7.0, dot(at, way) * 18.0);
    vec3 n = flow_noise(q);
    flow.thickness += weight * (0.7 + 0.6 * n.x);
    flow.slope += weight * n.yz * vec2(7.0, 18.0) * 0.25e-3;
  }
  flow.thickness = mix(1.0, flow.thickness, fades);
  flow.slope *= fades;
  return flow;
}

#endif
