#include "engine/core/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace petrichor {
namespace {

// Upper point of the chi-square distribution by Wilson and Hilferty (1931); z = 4 is passed by chance
// once in 30,000 trials, and the numbers are fixed, so a test that passes once passes always.
double chi_square_limit(double degrees, double z = 4.0) {
  const double a = 2.0 / (9.0 * degrees);
  return degrees * std::pow(1.0 - a + z * std::sqrt(a), 3.0);
}

TEST(Random, BitsMatchThePublishedHash) {
  // From an independent implementation of the listing, in Python.
  EXPECT_EQ(random_bits4(glm::uvec4(0u)), glm::uvec4(0x0f02f829u, 0x2d568769u, 0x32b0c43bu, 0xd32548eau));
  EXPECT_EQ(random_bits4(glm::uvec4(1, 2, 3, 4)), glm::uvec4(0x3622cd16u, 0xf11471d8u, 0xe1109b3fu, 0x02b94c2fu));
  EXPECT_EQ(random_bits4(glm::uvec4(0xffffffffu, 7, 0x80000000u, 42)),
            glm::uvec4(0x21f80760u, 0x66773eb8u, 0x6c7a504cu, 0xb9ab93d8u));
}

TEST(Random, FloatsStayBelowOne) {
  EXPECT_EQ(unit_float(0u), 0.0f);
  EXPECT_LT(unit_float(0xffffffffu), 1.0f);
  EXPECT_EQ(unit_float(0xffffffffu), 1.0f - std::ldexp(1.0f, -24));
  EXPECT_EQ(unit_float(0x80000000u), 0.5f);
}

// Each coordinate of the key in turn counts up, as the cells and drops of the field do.
TEST(Random, UniformAlongEveryKeyAndInEveryComponent) {
  constexpr int bins = 64, draws = 64000;
  for (int along = 0; along < 4; ++along) {
    std::array<std::array<int, bins>, 4> hits{};
    for (int i = 0; i < draws; ++i) {
      glm::uvec4 key(11, 22, 33, 44);
      key[along] = static_cast<std::uint32_t>(i);
      const glm::vec4 u = random_float4(key);
      for (int c = 0; c < 4; ++c) {
        ASSERT_GE(u[c], 0.0f);
        ASSERT_LT(u[c], 1.0f);
        ++hits[static_cast<std::size_t>(c)][static_cast<std::size_t>(u[c] * bins)];
      }
    }
    for (int c = 0; c < 4; ++c) {
      double chi = 0.0;
      for (const int h : hits[static_cast<std::size_t>(c)]) {
        chi += std::pow(h - double(draws) / bins, 2) / (double(draws) / bins);
      }
      EXPECT_LT(chi, chi_square_limit(bins - 1)) << "key " << along << ", component " << c;
    }
  }
}

TEST(Random, NeighboursAreIndependent) {
  // Pairs of neighbouring keys, and pairs of components, fill the square evenly.
  constexpr int side = 16, draws = 64000;
  std::array<int, side * side> neighbours{}, components{};
  const auto cell = [](float u, float v) {
    return static_cast<std::size_t>(u * side) * side + static_cast<std::size_t>(v * side);
  };
  for (std::uint32_t i = 0; i < draws; ++i) {
    const glm::vec4 a = random_float4(glm::uvec4(1, i, 5, 0)), b = random_float4(glm::uvec4(1, i + 1, 5, 0));
    ++neighbours[cell(a.x, b.x)];
    ++components[cell(a.x, a.w)];
  }
  for (const auto& grid : {neighbours, components}) {
    double chi = 0.0;
    const double expected = double(draws) / (side * side);
    for (const int h : grid) chi += std::pow(h - expected, 2) / expected;
    EXPECT_LT(chi, chi_square_limit(side * side - 1));
  }
}

// The low 24 bits of each key, as random.h asks, and the bits that unit_float uses.
TEST(Random, EveryInputBitReachesEveryOutputBit) {
  // Avalanche: a flipped key bit flips each output bit about half the time.
  constexpr int trials = 2000;
  for (int bit = 0; bit < 128; ++bit) {
    if (bit % 32 >= 24) continue;
    std::array<int, 32> flips{};
    for (std::uint32_t t = 0; t < trials; ++t) {
      glm::uvec4 key(t, t * 3 + 1, t * 7 + 2, t * 13 + 5);
      const std::uint32_t before = random_bits(key);
      key[bit / 32] ^= 1u << (bit % 32);
      const std::uint32_t changed = before ^ random_bits(key);
      for (int o = 0; o < 32; ++o) flips[static_cast<std::size_t>(o)] += (changed >> o) & 1u;
    }
    for (std::size_t o = 8; o < 32; ++o) {
      EXPECT_NEAR(double(flips[o]) / trials, 0.5, 0.1) << "key bit " << bit << ", output bit " << o;
    }
  }
}

TEST(Random, PoissonMeanVarianceAndShape) {
  for (const float mean : {0.01f, 0.5f, 1.0f, 4.0f, 20.0f, 75.0f}) {
    constexpr int draws = 200000;
    RandomStream random(7, static_cast<std::uint32_t>(mean * 100.0f));
    double sum = 0.0, squares = 0.0;
    std::vector<int> hits(400, 0);
    for (int i = 0; i < draws; ++i) {
      const std::uint32_t n = poisson_count(random.uniform(), mean);
      sum += n;
      squares += double(n) * n;
      ++hits.at(n);
    }
    const double average = sum / draws, variance = squares / draws - average * average;
    // Standard errors of a Poisson sample: sqrt(m/N) and sqrt((m + 2m^2)/N).
    EXPECT_NEAR(average, mean, 4.5 * std::sqrt(mean / draws)) << mean;
    EXPECT_NEAR(variance, mean, 4.5 * std::sqrt((mean + 2.0 * mean * mean) / draws)) << mean;
    double chi = 0.0, degrees = -1.0, term = std::exp(-double(mean));
    for (std::size_t n = 0; n < hits.size(); ++n) {
      const double expected = term * draws;
      if (expected > 10.0) {
        chi += std::pow(hits[n] - expected, 2) / expected;
        degrees += 1.0;
      }
      term *= mean / double(n + 1);
    }
    if (degrees >= 1.0) {
      EXPECT_LT(chi, chi_square_limit(degrees)) << mean;
    }
  }
}

TEST(Random, PoissonEdges) {
  EXPECT_EQ(poisson_count(0.0f, 0.0f), 0u);
  EXPECT_EQ(poisson_count(0.99999994f, 0.0f), 0u);
  EXPECT_EQ(poisson_count(0.0f, 5.0f), 0u);
  EXPECT_LT(poisson_count(0.99999994f, 5.0f), 40u) << "the largest u must end the walk";
  EXPECT_LT(poisson_count(0.99999994f, 80.0f), 250u);
  EXPECT_EQ(poisson_count(0.99999994f, 80.0f, std::exp(-80.0f), 12u), 12u);
}

TEST(Random, StreamsAreReproducibleAndApart) {
  RandomStream a(1, 2), same(1, 2), other(1, 3);
  int equal = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::uint32_t x = a.bits();
    EXPECT_EQ(x, same.bits());
    equal += x == other.bits();
  }
  EXPECT_LT(equal, 3);
  std::array<int, 7> hits{};
  for (int i = 0; i < 70000; ++i) ++hits.at(a.below(7));
  for (const int h : hits) EXPECT_NEAR(h, 10000, 500);
}

std::string text_of(const std::string& path) {
  std::ifstream file(std::string(PETRICHOR_SOURCE_DIR) + "/" + path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(Random, BothLanguagesIncludeTheOneText) {
  const std::string include = "#include \"engine/core/random.h\"";
  EXPECT_NE(text_of("engine/core/random.hpp").find(include), std::string::npos);
  EXPECT_NE(text_of("engine/core/random.glsl").find(include), std::string::npos);
  // And neither defines a hash of its own.
  EXPECT_EQ(text_of("engine/core/random.glsl").find("uvec4"), std::string::npos);
  // Nothing in it branches on the language.
  EXPECT_EQ(text_of("engine/core/random.h").find("#if"), std::string::npos);
}

}  // namespace
}  // namespace petrichor
