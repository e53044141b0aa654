#include "systems/drops/drop_sizes.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "systems/drops/drop_physics.hpp"

namespace petrichor {
namespace {

// Sums of a quantity over a fine grid of diameters, independent of moment(): plain midpoints.
template <class F>
double sum_over(const DropSizeDistribution& d, double from, double to, F f) {
  constexpr int steps = 20000;
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double x = from + (to - from) * (i + 0.5) / steps;
    sum += density(d, x) * f(x);
  }
  return sum * (to - from) / steps;
}

double flux(const DropSizeDistribution& d, double from, double to) {
  return M_PI / 6.0 * 3.6e-3 * sum_over(d, from, to, [](double x) { return x * x * x * terminal_speed_mps(x); });
}

TEST(DropSizes, GiveBackTheRateThatWasAsked) {
  for (double rate : {0.01, 0.5, 1.0, 2.5, 10.0, 50.0, 100.0, 200.0, 300.0}) {
    EXPECT_NEAR(flux(solve_distribution(DropSizes::marshall_palmer, 0.0, 6.0, rate), 0.1, 6.0), rate, 1e-3 * rate);
    for (double shape : {-0.9, 0.0, 2.0, 6.0}) {
      EXPECT_NEAR(flux(solve_distribution(DropSizes::gamma, shape, 6.0, rate), 0.1, 6.0), rate, 2e-3 * rate);
    }
  }
}

TEST(DropSizes, SlopeIsTheCorrectedMarshallPalmer) {
  for (double rate : {0.5, 1.0, 5.0, 20.0, 50.0, 100.0}) {
    const auto d = solve_distribution(DropSizes::marshall_palmer, 0.0, 8.0, rate);
    EXPECT_NEAR(d.slope_per_mm, 4.25 * std::pow(rate, -0.215), 0.015 * d.slope_per_mm) << rate;
    EXPECT_NEAR(d.n0, 8000.0, 1.0);
  }
}

TEST(DropSizes, CountsAreThoseOfTheLiterature) {
  // Drops > 0.5 mm per m3, impacts per m2 s, and those > 1 mm, at 2.5, 10 and 50 mm/h (physics, section 1).
  const double expected[][4] = {{2.5, 400, 1258, 336}, {10, 845, 2919, 1167}, {50, 1743, 6797, 3746}};
  for (const auto& [rate, drops, impacts, large] : expected) {
    const auto d = solve_distribution(DropSizes::marshall_palmer, 0.0, 6.0, rate);
    EXPECT_NEAR(sum_over(d, 0.5, 6.0, [](double) { return 1.0; }), drops, 0.03 * drops) << rate;
    EXPECT_NEAR(sum_over(d, 0.5, 6.0, terminal_speed_mps), impacts, 0.03 * impacts) << rate;
    EXPECT_NEAR(sum_over(d, 1.0, 6.0, terminal_speed_mps), large, 0.03 * large) << rate;
  }
}

TEST(DropSizes, SmallestDropsCarryAlmostNoWater) {
  const auto d = solve_distribution(DropSizes::marshall_palmer, 0.0, 6.0, 0.5);
  EXPECT_LT(d.n0 * std::pow(0.1, 4) * M_PI / 6.0 * 3.6e-3 * 0.27, 0.001 * 0.5);  // an upper bound
}

TEST(DropSizes, GammaKeepsTheMedianAndNarrows) {
  const auto broad = solve_distribution(DropSizes::gamma, 0.0, 6.0, 10.0);
  const auto narrow = solve_distribution(DropSizes::gamma, 4.0, 6.0, 10.0);
  const auto variance = [](const DropSizeDistribution& d) {
    const double n = sum_over(d, 0.1, 6, [](double) { return 1.0; });
    const double m = sum_over(d, 0.1, 6, [](double x) { return x; }) / n;
    return sum_over(d, 0.1, 6, [m](double x) { return (x - m) * (x - m); }) / n / (m * m);
  };
  EXPECT_LT(variance(narrow), 0.5 * variance(broad));
  const auto volume_below = [](const DropSizeDistribution& d, double to) {
    const auto cube = [](double x) { return x * x * x; };
    return sum_over(d, 0.1, to, cube) / sum_over(d, 0.1, 6, cube);
  };
  const double median = 3.67 / solve_distribution(DropSizes::marshall_palmer, 0, 6, 10).slope_per_mm;
  EXPECT_NEAR(volume_below(broad, median), 0.5, 0.03);
  EXPECT_NEAR(volume_below(narrow, median), 0.5, 0.03);
}

TEST(DropClasses, KeepNumberWaterAndCrossSection) {
  for (double rate : {0.5, 2.5, 10.0, 50.0, 100.0, 200.0}) {
    for (float minimum : {0.1f, 0.5f, 1.0f}) {
      Emitter emitter;
      emitter.rain_mm_per_hour = static_cast<float>(rate);
      emitter.minimum_diameter_mm = minimum;
      const auto d = solve_distribution(emitter.drop_sizes, 0, 6.0, rate);
      double water = 0, number = 0, area = 0, impacts = 0;
      for (const DropClass& c : make_drop_classes(emitter)) {
        water += rain_mm_per_hour(c);
        if (!c.drawn) continue;
        number += c.drops_per_m3;
        area += extinction_per_m(c);
        impacts += c.drops_per_m3 * c.fall_speed_mps;
        EXPECT_GE(c.diameter_mm, c.from_mm);
        EXPECT_LE(c.diameter_mm, c.to_mm);
      }
      EXPECT_NEAR(water, rate, 0.002 * rate);
      const double from = minimum;
      const double true_number = sum_over(d, from, 6, [](double) { return 1.0; });
      const double true_area = M_PI / 4 * 1e-6 * sum_over(d, from, 6, [](double x) { return x * x; });
      EXPECT_NEAR(number, true_number, 0.002 * true_number);
      // Second order in the width of a class: 16 classes from 0.1 mm are wider than from 0.5 mm.
      EXPECT_NEAR(area, true_area, (minimum < 0.5f ? 0.015 : 0.01) * true_area);
      const double true_impacts = sum_over(d, from, 6, terminal_speed_mps);
      EXPECT_NEAR(impacts, true_impacts, 0.02 * true_impacts);
    }
  }
}

// How many classes are drawn is a choice of speed against truth (chart `classes`), never of how much rain falls.
TEST(DropClasses, AnyNumberOfThemCarriesTheSameWaterAndConverges) {
  Emitter emitter;
  emitter.rain_mm_per_hour = 10.0f;
  struct Sums {
    double water = 0, number = 0, extinction = 0, energy = 0, impacts = 0;
  };
  const auto sums = [&](int drawn) {
    Sums s;
    const auto classes = make_drop_classes(emitter, drawn);
    int count = 0;
    for (const DropClass& c : classes) {
      s.water += rain_mm_per_hour(c);
      if (!c.drawn) continue;
      ++count;
      s.number += c.drops_per_m3;
      s.extinction += extinction_per_m(c);
      s.energy += rain_mm_per_hour(c) * c.fall_speed_mps * c.fall_speed_mps;
      s.impacts += c.drops_per_m3 * c.fall_speed_mps;
    }
    EXPECT_EQ(count, drawn);
    return s;
  };
  const Sums truth = sums(256);
  double before = 1e9;
  for (const int drawn : {1, 2, 4, 8, 16, 32, 64}) {
    const Sums s = sums(drawn);
    EXPECT_NEAR(s.water, 10.0, 0.02) << drawn;
    EXPECT_NEAR(s.number, truth.number, 0.002 * truth.number) << drawn;
    const double error = std::abs(s.extinction / truth.extinction - 1) + std::abs(s.energy / truth.energy - 1) +
                         std::abs(s.impacts / truth.impacts - 1);
    // Second order in the width of a class once it is narrow: at least a third from one power of two to the next.
    if (drawn >= 8) {
      EXPECT_LT(error, 0.67 * before) << drawn;
    }
    before = error;
  }
  EXPECT_NEAR(sums(16).extinction, truth.extinction, 0.005 * truth.extinction);
  EXPECT_NEAR(sums(16).energy, truth.energy, 0.005 * truth.energy);
  EXPECT_NEAR(sums(16).impacts, truth.impacts, 0.005 * truth.impacts);
}

TEST(DropClasses, ExtinctionIsThatOfTheLiterature) {
  // Geometric, drops > 0.5 mm: 0.22, 0.62 and 1.90 per km at 2.5, 10 and 50 mm/h (physics, section 2).
  for (const auto& [rate, beta] : {std::pair{2.5, 0.22e-3}, {10.0, 0.62e-3}, {50.0, 1.90e-3}}) {
    Emitter emitter;
    emitter.rain_mm_per_hour = static_cast<float>(rate);
    double sum = 0;
    for (const DropClass& c : make_drop_classes(emitter)) sum += c.drawn ? extinction_per_m(c) : 0.0;
    EXPECT_NEAR(sum, beta, 0.03 * beta) << rate;
  }
}

TEST(DropClasses, SpeedsAndFirstLayersDoNotDependOnTheRate) {
  Emitter drizzle, downpour;
  drizzle.rain_mm_per_hour = 0.5f;
  downpour.rain_mm_per_hour = 100.0f;
  const auto a = make_drop_classes(drizzle), b = make_drop_classes(downpour);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].fall_speed_mps, b[k].fall_speed_mps);
    EXPECT_EQ(a[k].base_drops_per_m3, b[k].base_drops_per_m3);
    EXPECT_LE(a[k].drops_per_m3, b[k].drops_per_m3 * 1.0001);
  }
}

TEST(DropClasses, AreFiniteAtAnyInput) {
  for (float rate : {0.0f, 1e-3f, 300.0f}) {
    for (float low : {0.1f, 0.5f, 6.0f}) {
      for (float high : {0.2f, 2.0f, 8.0f}) {
        for (DropSizes sizes : {DropSizes::marshall_palmer, DropSizes::gamma}) {
          Emitter e;
          e.rain_mm_per_hour = rate;
          e.minimum_diameter_mm = low;
          e.maximum_diameter_mm = high;
          e.drop_sizes = sizes;
          e.gamma_shape = -1.0f;
          for (const DropClass& c : make_drop_classes(e)) {
            EXPECT_TRUE(std::isfinite(c.drops_per_m3) && c.drops_per_m3 >= 0.0);
            EXPECT_TRUE(std::isfinite(c.diameter_mm) && c.diameter_mm > 0.0);
            EXPECT_GT(c.fall_speed_mps, 0.0);
            EXPECT_TRUE(rate > 0.0f || c.drops_per_m3 == 0.0);
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace petrichor
