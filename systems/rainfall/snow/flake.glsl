// One flake of the field: how it sways and tumbles, as a closed form of time.
#ifndef SYSTEMS_RAINFALL_SNOW_FLAKE_GLSL
#define SYSTEMS_RAINFALL_SNOW_FLAKE_GLSL
#include "systems/frame.glsl"
#include "systems/rainfall/snow/snow_shared.h"

uniform float sway;     // multiplies the radius of all helices
uniform float clock_s;  // modulo 64 s, when the shutter closes

struct Flake {
  float turns_per_s;  // a multiple of 1/64, so that the clock wraps without a jump
  float phase;        // in turns
  vec3 along, across;  // half axes of the helix, m
  float tumble_phase;
  float size;  // area over that of its class: 0.75 to 1.25, mean 1
};

uint scrambled(uint h) {
  h = (h ^ (h >> 16u)) * 0x7feb352du;
  h = (h ^ (h >> 15u)) * 0x846ca68bu;
  return h ^ (h >> 16u);
}
float unit8(uint bits, int shift) { return (float(bits >> uint(shift) & 255u) + 0.5) / 256.0; }

// Helices of 0.5 to 3 Hz and radii of 1 to 10 largest dimensions (shared physics, section 12). The fast ones are
// narrow: a flake does not fly sideways faster than it falls.
Flake flake_of(uint bits, float diameter) {
  uint a = scrambled(bits), b = scrambled(bits ^ 0x9e3779b9u);
  Flake f;
  float quickness = unit8(a, 0), spread = unit8(a, 8);
  f.turns_per_s = round(32.0 * pow(6.0, quickness)) / 64.0;
  f.phase = float(a >> 16u) / 65536.0;
  float radius = sway * diameter * pow(10.0, 1.0 - (0.7 * quickness + 0.3 * spread));
  float turn = 6.2831853 * unit8(b, 0), flatness = 2.0 * unit8(b, 8) - 1.0;  // either way round; 0 swings in a plane
  f.along = radius * vec3(cos(turn), 0.0, sin(turn));
  f.across = radius * flatness * vec3(-sin(turn), 0.0, cos(turn));
  f.tumble_phase = unit8(b, 16);
  f.size = 0.75 + 0.5 * unit8(b, 24);
  return f;
}

// Where it is relative to its place in the class's frame, so many seconds before the shutter closes, m. Never farther
// than the radius, and zero on average: swaying takes no water from anywhere and gives none.
vec3 flake_sway(Flake f, float before_s) {
  float turn = 6.2831853 * fract(f.turns_per_s * (clock_s - before_s) + f.phase);
  return cos(turn) * f.along + sin(turn) * f.across;
}

// It tumbles twice as it goes round once, and shows more and less of itself: area over its mean.
float flake_tumble(Flake f, float before_s) {
  return 1.0 + 0.3 * cos(6.2831853 * fract(2.0 * f.turns_per_s * (clock_s - before_s) + f.tumble_phase));
}

// Straight pieces that its path in an exposure takes: an eighth of a turn each.
int flake_pieces(Flake f, float exposure_s) {
  return clamp(int(ceil(8.0 * f.turns_per_s * exposure_s)), 1, SNOW_PIECES);
}

#endif
