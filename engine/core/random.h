// Counter-based random numbers, one text for C++ and GLSL: a number is a pure function of a key of four
// unsigned integers, so any drop, frame or cell can be asked alone and both sides get the same bits.
//
// The hash is pcg4d of Jarzynski and Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020,
// listing in appendix A. GLSL includes engine/core/random.glsl, C++ engine/core/random.hpp; each defines
//   RANDOM_FN     the prefix of a function
//   uint, uvec4, vec4   (C++: from glm)
// Keys should differ in their low 24 bits: a difference in the top bits alone (a class packed above a
// cell, say) is mixed poorly. Small negative coordinates differ in all bits and are fine.
// Only integer arithmetic modulo 2^32, exact conversions and products by powers of two stand here, so
// the results agree bit for bit. The exception is poisson_count: GLSL leaves the last bits of exp and of
// a division open, so about one count in a million may differ between two machines.

RANDOM_FN uvec4 random_bits4(uvec4 key) {
  uvec4 v = key * 1664525u + uvec4(1013904223u);
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  v = v ^ (v >> 16u);
  v.x += v.y * v.w;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v.w += v.y * v.z;
  return v;
}

RANDOM_FN uint random_bits(uvec4 key) { return random_bits4(key).x; }

// The top 24 bits as a float in [0, 1): every value is a multiple of 2^-24, and 1 is never reached.
RANDOM_FN float unit_float(uint bits) { return float(bits >> 8u) * 5.9604644775390625e-8f; }

RANDOM_FN float random_float(uvec4 key) { return unit_float(random_bits(key)); }

RANDOM_FN vec4 random_float4(uvec4 key) {
  uvec4 bits = random_bits4(key);
  return vec4(unit_float(bits.x), unit_float(bits.y), unit_float(bits.z), unit_float(bits.w));
}

// A signed cell coordinate as a key: two's complement, so that -1 follows 0xffffffff as one expects.
RANDOM_FN uint key_of(int coordinate) { return uint(coordinate); }

// A Poisson count by inversion of one uniform number u in [0, 1): walks the distribution from 0, so it
// is for small means (the cost is the mean; above about 80 exp(-mean) is no longer a normal float).
// zero_probability is exp(-mean). Never above `most`, which bounds the walk.
RANDOM_FN uint poisson_count(float u, float mean, float zero_probability, uint most) {
  float probability = zero_probability;
  float below = probability;
  uint count = 0u;
  while (u >= below && count < most) {
    count += 1u;
    probability *= mean / float(count);
    // Past the mean the terms vanish against 1: u lies in the rounding of the sum, and the walk ends.
    if (float(count) > mean && probability < 1.0e-9f) break;
    below += probability;
  }
  return count;
}
