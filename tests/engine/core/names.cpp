#include "engine/core/names.hpp"

#include <gtest/gtest.h>

#include <array>

namespace petrichor {
namespace {

constexpr std::array<std::string_view, 4> known{"rain_mm_per_hour", "gamma_shape", "seed", "drop_sizes"};

TEST(Names, NearestName) {
  EXPECT_EQ(nearest_name("sede", known), "seed") << "two letters swapped";
  EXPECT_EQ(nearest_name("SEED", known), "seed");
  EXPECT_EQ(nearest_name("rain-mm-per-hour", known), "rain_mm_per_hour");
  EXPECT_EQ(nearest_name("rain_mm_per_h", known), "rain_mm_per_hour");
  EXPECT_EQ(nearest_name("rain", known), "rain_mm_per_hour") << "a part";
  EXPECT_EQ(nearest_name("gama_shape", known), "gamma_shape");
  EXPECT_EQ(nearest_name("thunder", known), "");
  EXPECT_EQ(nearest_name("", known), "");
  EXPECT_EQ(nearest_name("x", {}), "");
  EXPECT_EQ(nearest_name(std::string(1000000, 'r'), known), "") << "hostile lengths are not compared";
}

TEST(Names, Hint) {
  EXPECT_EQ(name_hint("sede", known),
            "; did you mean \"seed\"? Known: rain_mm_per_hour, gamma_shape, seed, drop_sizes");
  EXPECT_EQ(name_hint("thunder", known), ". Known: rain_mm_per_hour, gamma_shape, seed, drop_sizes");
}

}  // namespace
}  // namespace petrichor
