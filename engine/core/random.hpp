#pragma once
// Counter-based random numbers: see random.h, which this shares word for word with the shaders.

#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace petrichor {
namespace random_text {

using uint = std::uint32_t;
using glm::uvec4;
using glm::vec4;

#define RANDOM_FN inline
#include "engine/core/random.h"
#undef RANDOM_FN

}  // namespace random_text

using random_text::key_of;
using random_text::poisson_count;
using random_text::random_bits;
using random_text::random_bits4;
using random_text::random_float;
using random_text::random_float4;
using random_text::unit_float;

// A Poisson count of the given mean (0 to 80) from one uniform number in [0, 1).
inline std::uint32_t poisson_count(float u, float mean) {
  return poisson_count(u, mean, std::exp(-mean), 0xffffffffu);
}

// Numbers one after another, for set-up code that needs many: still a pure function of (seed, stream,
// how many were drawn).
class RandomStream {
 public:
  explicit RandomStream(std::uint32_t seed, std::uint32_t stream = 0) : seed_(seed), stream_(stream) {}
  std::uint32_t bits() {
    const std::uint64_t n = drawn_++;
    return random_bits(glm::uvec4(seed_, stream_, static_cast<std::uint32_t>(n), static_cast<std::uint32_t>(n >> 32)));
  }
  float uniform() { return unit_float(bits()); }  // [0, 1)
  float uniform(float low, float high) { return low + (high - low) * uniform(); }
  // 0 .. count-1, count > 0; by multiplication (Lemire 2019), whose bias is below count / 2^32.
  std::uint32_t below(std::uint32_t count) {
    return static_cast<std::uint32_t>((static_cast<std::uint64_t>(bits()) * count) >> 32);
  }

 private:
  std::uint32_t seed_, stream_;
  std::uint64_t drawn_ = 0;
};

}  // namespace petrichor
