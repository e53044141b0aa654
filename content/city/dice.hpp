#pragma once
// Counter-based random numbers for content: a pure function of the seed and how many were drawn, so that a
// building looks the same whatever is generated before it. The mixer is Wellons' lowbias32.

#include <cstdint>

namespace petrichor::city {

constexpr std::uint32_t mix(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  return x ^ (x >> 16);
}

constexpr std::uint32_t mix(std::uint32_t a, std::uint32_t b) {
  return mix(a ^ mix(b + 0x9e3779b9u));
}
constexpr std::uint32_t mix(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  return mix(mix(a, b), c);
}

// [0, 1), 24 bits, exact in float.
constexpr float unit(std::uint32_t bits) {
  return static_cast<float>(bits >> 8) * (1.0f / 16777216.0f);
}

struct Dice {
  std::uint32_t seed = 1;
  std::uint32_t count = 0;

  float next() { return unit(mix(seed, count++)); }
  float between(float low, float high) { return low + (high - low) * next(); }
  int below(int n) { return static_cast<int>(next() * static_cast<float>(n)); }
  bool chance(float probability) { return next() < probability; }
};

}  // namespace petrichor::city
