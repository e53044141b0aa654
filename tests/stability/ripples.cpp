// Where methods for ripples fail (shared physics, section 5d), and that those in use do not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "systems/ripple/lattice.hpp"
#include "systems/ripple/seeds.hpp"
#include "systems/ripple/stage.hpp"
#include "systems/ripple/truth.hpp"
#include "systems/ripple_frame.hpp"
#include "tests/systems/geometry/stage.hpp"

namespace petrichor::test {
namespace {

// One lattice alone, with its programs: what the pass does to it and nothing else.
struct Basin {
  ShaderLibrary shaders;
  RipplePrograms programs{};
  RippleLattice lattice;
  Buffer seeds;
  double cell_m = 1.0 / 256.0, step_s = 1.0 / 120.0, decay = 0.0;

  explicit Basin(int cells, bool near = false) {
    const std::string folder = "systems/ripple/";
    programs.stamp = *shaders.load({{folder + "ripple_stamp.comp.glsl"}, {}});
    programs.step = *shaders.load({{folder + "ripple_step.comp.glsl"}, {}});
    programs.step_near = *shaders.load({{folder + "ripple_step.comp.glsl"}, {"NEAR"}});
    lattice.rest(cells, near);
  }
  void step(const RippleScheme& scheme, double courant, const std::vector<RippleSeedGpu>& some = {},
            glm::ivec2 shift = {}) {
    if (!some.empty()) upload(seeds, std::span<const RippleSeedGpu>(some));
    lattice.step(programs, scheme, courant * cell_m / step_s, cell_m, decay, step_s, shift, seeds, 0,
                 static_cast<int>(some.size()));
  }
  std::vector<float> heights() const { return plane(0); }
  std::vector<float> plane(int which) const {
    const auto size = static_cast<std::size_t>(lattice.cells) * lattice.cells;
    std::vector<float> z(size);
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    read_buffer(lattice.state, z.data(), size * 4, size * 4 * static_cast<std::size_t>(which));
    return z;
  }
  double highest() const {
    double most = 0.0;
    for (const float z : heights()) most = std::isfinite(z) ? std::max(most, std::abs(double(z))) : INFINITY;
    return most;
  }
  double mean() const {
    double sum = 0.0;
    for (const float z : heights()) sum += z;
    return sum / (double(lattice.cells) * lattice.cells);
  }
};

RippleSeedGpu ring(double x, double y, double amplitude_m, double deviation_cells) {
  return {glm::vec4(x, y, amplitude_m, deviation_cells * seed_reach), glm::vec4(0, 0, float(RIPPLE_SEED_RING), 0)};
}

RippleScheme scheme(float nine, bool euler = false, bool quantised = false) {
  return {nine, euler, quantised, 1};
}

class RipplesFail : public testing::Test {
 protected:
  void SetUp() override {
    if (!stage_context()) GTEST_SKIP() << "no OpenGL";
  }
};

using Ripples = RipplesFail;

// Highest water after so many undamped steps from a seed of 1 mm that holds every wave.
double after(int steps, const RippleScheme& s, double courant) {
  Basin basin(32);
  basin.step(s, courant, {ring(10.3, 14.8, 1e-3, 0.5)});
  for (int i = 0; i < steps; ++i) basin.step(s, courant);
  return basin.highest();
}

TEST_F(Ripples, CourantOf070HoldsForEverAnd072Dies) {
  EXPECT_LT(after(20000, scheme(0), 0.70), 3e-3);
  EXPECT_GT(after(2000, scheme(0), 0.72), 1e3);
}

TEST_F(Ripples, NinePointsHoldTo0866) {
  EXPECT_LT(after(20000, scheme(1), 0.86), 3e-3);
  EXPECT_GT(after(2000, scheme(1), 0.875), 1e3);
  // Between the two stencils, as while one rung gives way to the other, the smaller limit holds.
  EXPECT_LT(after(4000, scheme(0.5f), 0.70), 3e-3);
}

TEST_F(Ripples, ForwardEulerBlowsUpAtAnyStep) {
  for (const double courant : {0.1, 0.3, 0.5}) {
    // The scheme itself, without the clamp that keeps the picture from infinities: |lambda|^2 = 1 + 8 C^2 at worst.
    std::vector<double> z(256, 0.0), w(256, 0.0);
    z[100] = 1.0;
    int steps = 0;
    for (; steps < 4000; ++steps) {
      auto next = z, rate = w;
      double most = 0.0;
      for (int i = 0; i < 256; ++i) {
        const int x = i % 16, y = i / 16;
        const auto at = [&](int a, int b) { return z[static_cast<std::size_t>((b & 15) * 16 + (a & 15))]; };
        next[i] = z[i] + w[i];
        rate[i] = w[i] + courant * courant * (at(x + 1, y) + at(x - 1, y) + at(x, y + 1) + at(x, y - 1) - 4 * z[i]);
        most = std::max(most, std::abs(next[i]));
      }
      z = next, w = rate;
      if (most > 1e6) break;
    }
    // Growth by sqrt(1 + 8 C^2) a step; a grid's fastest wave has a 256th of the seed.
    const double expected = std::log(1e6 * 256.0) / (0.5 * std::log(1.0 + 8.0 * courant * courant));
    EXPECT_NEAR(steps / expected, 1.0, 0.3) << "C " << courant;
    // On the GPU it runs into its clamp, damped as rain's waves are, and stays finite.
    Basin basin(32);
    basin.decay = 1.8;
    basin.step(scheme(0, true), courant, {ring(10.3, 14.8, 1e-3, 1.5)});
    for (int i = 0; i < 3000; ++i) basin.step(scheme(0, true), courant);
    EXPECT_TRUE(std::isfinite(basin.highest()));
    EXPECT_GE(basin.highest(), courant < 0.15 ? 0.005 : 0.0099) << "C " << courant;
  }
}

TEST_F(Ripples, EightfoldFrameTimesChangeNothing) {
  // A span eight times as long is cut into steps, never stretched: at every span the Courant number is legal.
  for (int longer = 1; longer <= 8; ++longer) {
    const double span = longer / 120.0;
    const int n = substeps(0.225, span, 1.0 / 256.0, courant_5);
    EXPECT_LE(0.225 * span / n * 256.0, courant_5 + 1e-9);
    EXPECT_TRUE(n == 1 || 0.225 * span / (n - 1) * 256.0 > courant_5) << "no step too many";
  }
  // Frames of one to eight ticks, each tick a step: as the pass does it.
  const auto highest = [](bool ticks) {
    Basin basin(64);
    basin.cell_m = 1.0 / 64.0;
    double most = 0.0;
    for (int i = 0; i < 4000; ++i) {
      const int longer = i * 7 % 5 == 0 ? 8 : 1;
      const std::vector<RippleSeedGpu> drop{ring(i * 37 % 64, i * 23 % 64, 1e-3, 3.0)};
      if (i % 4 == 0) upload(basin.seeds, std::span<const RippleSeedGpu>(drop));
      for (int k = 0; k < (ticks ? longer : 1); ++k)
        basin.lattice.step(basin.programs, {1.0f, false, false, 0}, 0.225, 1.0 / 64.0, 1.8,
                           (ticks ? 1.0 : longer) / 120.0, {}, basin.seeds, 0, k == 0 && i % 4 == 0 ? 1 : 0);
      if (i % 500 == 499) most = std::max(most, basin.highest());
    }
    return most;
  };
  EXPECT_LT(highest(true), 5e-3);
  // Each frame cut into legal steps of its own length: steps that are legal but not alike pump the waves up.
  EXPECT_GT(highest(false), 1.0);
  // What rescaling C with the frame time would do: 8 x 0.48.
  EXPECT_GT(after(60, scheme(0), 8 * 0.48), 1e3);
  // And the picture of a tick is the same whether frames came one a tick or one in eight.
  RippleStage smooth, jerky;
  ASSERT_TRUE(smooth.load(64));
  ASSERT_TRUE(jerky.load(64));
  for (int i = 0; i < 241; ++i) {
    smooth.tick();
    jerky.tick();
    ASSERT_TRUE(smooth.draw(smooth.frame()));
    if (i % 8 == 0) ASSERT_TRUE(jerky.draw(jerky.frame()));
  }
  const auto a = smooth.layer(0), b = jerky.layer(0);
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_EQ(a[i], b[i]);
}

TEST_F(Ripples, TenMinutesOfSeedingDoNotMoveTheLevel) {
  Basin basin(64);
  basin.cell_m = 1.0 / 64.0;
  basin.decay = 1.8;
  RippleImpact drop{};
  double amplitude = 0.0;
  // Ten minutes of ticks at 1/60 s; a heavy rain's drops.
  for (int i = 0; i < 36000; ++i) {
    std::vector<RippleSeedGpu> some;
    if (i % 3 == 0)
      some.push_back(ring((i * 0.7371) - 64 * std::floor(i * 0.7371 / 64),
                          (i * 0.4129) - 64 * std::floor(i * 0.4129 / 64), 1e-3, 2.0 + i % 4));
    basin.step(scheme(1), 0.5, some);
    if (i % 6000 == 5999) amplitude = std::max(amplitude, basin.highest());
  }
  EXPECT_GT(amplitude, 1e-4);
  EXPECT_LT(std::abs(basin.mean()), 1e-3 * amplitude) << "mean " << basin.mean() << " of " << amplitude;
}

TEST_F(Ripples, PublishedSeedsRaiseTheLevel) {
  // Drops as a dampened sine, by mass: their volume stays, and nothing drains it.
  Basin basin(64);
  basin.decay = 1.8;
  for (int i = 0; i < 1200; ++i) {
    std::vector<RippleSeedGpu> some;
    if (i % 3 == 0)
      some.push_back(
          {glm::vec4(i * 37 % 64, i * 23 % 64, 1e-3, 4.0), glm::vec4(0, 0, float(RIPPLE_SEED_PUBLISHED), 0)});
    basin.step(scheme(0, false, true), 0.5, some);
  }
  EXPECT_GT(std::abs(basin.mean()), 1e-3 * basin.highest());
}

// Undamped waves of mixed lengths, for a while, held by z and the z before in so many bits; fp16 by z and w.
struct Stored {
  double energy = 0.0, drift = 0.0, residue = 0.0;
};

template <class Round>
Stored stored(Round round, bool pairs_of_increments, double damping, int steps) {
  constexpr int n = 32;
  constexpr double c2 = 0.25;
  std::vector<double> z(n * n), before(n * n);
  const auto wave = [](int i) {
    const double x = i % n, y = i / n, t = 2.0 * std::numbers::pi / n;
    return 0.3 * (std::cos(t * (2 * x + y)) + std::cos(t * (3 * y - x) + 1.0) + std::cos(t * 4 * x + 2.0)) + 0.0;
  };
  for (int i = 0; i < n * n; ++i) z[i] = before[i] = round(wave(i));
  std::vector<double> w(n * n, 0.0);
  const auto energy = [&](const std::vector<double>& now, const std::vector<double>& then) {
    double sum = 0.0, level = 0.0;
    for (int i = 0; i < n * n; ++i) level += now[i] / (n * n);
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const int i = y * n + x, r = y * n + (x + 1) % n, d = (y + 1) % n * n + x;
        sum += std::pow(now[i] - then[i], 2) +
               c2 * ((now[r] - now[i]) * (then[r] - then[i]) + (now[d] - now[i]) * (then[d] - then[i]));
      }
    return std::pair(sum, level);
  };
  const auto start = energy(z, before);
  for (int s = 0; s < steps; ++s) {
    std::vector<double> next(n * n);
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const int i = y * n + x;
        const double lap = z[y * n + (x + 1) % n] + z[y * n + (x + n - 1) % n] + z[(y + 1) % n * n + x] +
                           z[(y + n - 1) % n * n + x] - 4.0 * z[i];
        if (pairs_of_increments) {
          w[i] = round((1.0 - damping) * w[i] + c2 * lap);
          next[i] = round(z[i] + w[i]);
        } else {
          next[i] = round(z[i] + (1.0 - damping) * (z[i] - before[i]) + c2 * lap);
        }
      }
    before = z;
    z = next;
  }
  const auto end = energy(z, before);
  double residue = 0.0;
  for (int i = 0; i < n * n; ++i) residue = std::max(residue, std::abs(z[i] - end.second));
  return {end.first / start.first, end.second - start.second, residue};
}

double fixed_point(double v, double range, int bits) {
  const double one = (std::exp2(bits - 1) - 1.0) / range;
  return std::floor(std::clamp(v, -range, range) * one) / one;  // as a render target of that kind truncates
}
double binary(double v, int mantissa) {
  if (v == 0.0) return 0.0;
  const double unit = std::exp2(std::floor(std::log2(std::abs(v))) - mantissa);
  return std::nearbyint(v / unit) * unit;
}

TEST(RipplesStored, FixedPointDriftsAndGainsWhereFloatsDoNot) {
  const auto sixteen = stored([](double v) { return fixed_point(v, 8.0, 16); }, false, 0.0, 6000);
  const auto eight = stored([](double v) { return fixed_point(v, 8.0, 8); }, false, 0.0, 600);
  const auto half = stored([](double v) { return binary(v, 10); }, true, 0.0, 6000);
  const auto single = stored([](double v) { return double(static_cast<float>(v)); }, true, 0.0, 6000);
  std::printf("16 bits: level %.3g; 8 bits: level %.3g, energy x%.3g; half: level %.2g, energy x%.4f; single: %.2g\n",
              sixteen.drift, eight.drift, eight.energy, half.drift, half.energy, single.drift);
  EXPECT_GT(std::abs(sixteen.drift), 1.0) << "more than the waves are high";
  EXPECT_TRUE(std::abs(eight.drift) > 1.0 || eight.energy > 10.0);
  EXPECT_LT(std::abs(single.drift), 3e-3);
  EXPECT_NEAR(single.energy, 1.0, 1e-3);
  EXPECT_NEAR(half.energy, 1.0, 0.1);
}

TEST(RipplesStored, DampedFixedPointFreezesAsARippledSheet) {
  const auto rounded = [](double v) {
    const double one = 127.0 / 2.0;
    return std::nearbyint(v * one) / one;
  };
  const auto frozen = stored(rounded, false, 0.01, 6000);
  const auto whole = stored([](double v) { return double(static_cast<float>(v)); }, true, 0.01, 6000);
  std::printf("left after 6000 damped steps: %.3g in 8 bits, %.3g in floats\n", frozen.residue, whole.residue);
  EXPECT_GT(frozen.residue, 0.01);
  EXPECT_LT(whole.residue, 1e-6);
}

// Shared physics 5b: the transform over the plane and that over the radius are one solution.
TEST(RipplesTruth, TheSpectralSolutionIsTheHankelIntegral) {
  constexpr double deviation = 0.004;
  const auto gaussian = [](double k) { return gaussian_transform(k, deviation); };
  for (const auto& law : {real_water(), membrane(0.225)}) {
    SpectralWater water(256, 0.5, law, 0.0);
    water.add(glm::dvec2(0.25), 1.0, gaussian);
    water.advance(0.3);
    const auto z = water.heights();
    double worst = 0.0, most = 0.0;
    for (int x = 128; x < 236; x += 3) {
      const double r = (x - 128) * 0.5 / 256.0;
      const double exact = ring_height(gaussian, law, r, 0.3, 8.0 / deviation);
      worst = std::max(worst, std::abs(z[128 * 256 + static_cast<std::size_t>(x)] - exact));
      most = std::max(most, std::abs(exact));
    }
    EXPECT_LT(worst, 1e-3 * most);  // neighbours beyond the edge: waves of 0.47 m/s reach r = 0.21 from there
  }
  // Many small steps are one large one, to rounding.
  SpectralWater one(64, 0.5, real_water(), 1.8), many(64, 0.5, real_water(), 1.8);
  for (auto* w : {&one, &many}) w->add(glm::dvec2(0.1, 0.2), 1.0, [](double k) { return seed_transform(k, 0.024); });
  one.advance(2.0);
  for (int i = 0; i < 240; ++i) many.advance(1.0 / 120.0);
  const auto a = one.heights(), b = many.heights();
  for (std::size_t i = 0; i < a.size(); ++i) ASSERT_NEAR(a[i], b[i], 1e-12);
}

// Verlet is the membrane as its grid gets finer; on narrow seeds it breaks up. The best single speed misses what waves
// of different lengths do.
TEST_F(Ripples, NarrowSeedsBreakUpOnALattice) {
  std::vector<double> errors;
  for (const double cells_of_deviation : {1.3, 2.6, 5.1}) {
    Basin basin(256);
    const double deviation = cells_of_deviation * basin.cell_m, reach = deviation * seed_reach;
    basin.step(scheme(1), 0.5, {ring(127.5, 127.5, 1e-3, cells_of_deviation)});
    for (int i = 0; i < 140; ++i) basin.step(scheme(1), 0.5);
    SpectralWater water(256, 1.0, membrane(0.5 * basin.cell_m / basin.step_s), 0.0);
    water.add(glm::dvec2(127.5 / 256.0), 1e-3, [&](double k) { return seed_transform(k, reach); });
    water.advance(140 * basin.step_s);
    const auto got = basin.heights();
    const auto exact = water.heights();
    double difference = 0.0, of_truth = 0.0;
    for (std::size_t i = 0; i < got.size(); ++i) {
      difference += std::pow(got[i] - exact[i], 2);
      of_truth += exact[i] * exact[i];
    }
    errors.push_back(std::sqrt(difference / of_truth));
  }
  std::printf("error by cells of deviation, 1.3: %.2f, 2.6: %.2f, 5.1: %.3f\n", errors[0], errors[1], errors[2]);
  // Phases run late by (1 - C^2) (k dx)^2 / 24 of the way; over 70 cells that is a wave where it is one of 5 cells.
  EXPECT_GT(errors[0], 1.0);
  EXPECT_GT(errors[1], errors[2]);
  EXPECT_LT(errors[2], 0.2);
}

TEST_F(Ripples, TheTileFollowsTheEyeWithoutAJoltAndSurvivesJumpsOf10Km) {
  // A lattice that is shifted by whole cells shows the same water.
  Basin still(64, true), moved(64, true);
  still.step(scheme(1), 0.4, {ring(32, 32, 1e-3, 3.0)});
  moved.step(scheme(1), 0.4, {ring(32, 32, 1e-3, 3.0)});
  for (int i = 0; i < 8; ++i) {
    still.step(scheme(1), 0.4);
    moved.step(scheme(1), 0.4, {}, i == 3 ? glm::ivec2(3, -2) : glm::ivec2(0));
  }
  const auto a = still.heights(), b = moved.heights();
  for (int y = 20; y < 44; ++y)
    for (int x = 20; x < 44; ++x)
      ASSERT_EQ(a[static_cast<std::size_t>(y * 64 + x)], b[static_cast<std::size_t>((y + 2) * 64 + x - 3)]);

  RippleStage stage;
  ASSERT_TRUE(stage.load(64));
  for (const double away : {0.0, 1e4, -1e4, 3e4}) {
    stage.look({away, 1.6, 2.0 - away}, glm::normalize(glm::vec3(0, -0.5f, -1)));
    stage.run(0.25);
    ASSERT_TRUE(stage.draw(stage.frame()));
    double most = 0.0, sum = 0.0;
    for (const glm::vec4& s : stage.layer(1)) {
      ASSERT_TRUE(std::isfinite(s.x) && std::isfinite(s.y) && std::isfinite(s.z));
      most = std::max<double>(most, glm::length(glm::vec2(s)));
      sum += double(s.x) * s.x + double(s.y) * s.y;
    }
    EXPECT_LT(most, 0.5);
    EXPECT_GT(std::sqrt(sum / 4096.0), 0.002) << "rings are there at once, at " << away;
  }
}

TEST_F(Ripples, ACloudburstOf200MmAnHourStaysInBounds) {
  for (const RippleRung rung : {RippleRung::rings, RippleRung::verlet5, RippleRung::near_tile, RippleRung::euler}) {
    RippleStage stage;
    ASSERT_TRUE(stage.load(64));
    stage.emitter().rain_mm_per_hour = 200.0f;
    stage.techniques.set(Effect::ripples, rung);
    stage.run(3.0);
    ASSERT_TRUE(stage.draw(stage.frame()));
    double sum = 0.0;
    for (const glm::vec4& s : stage.layer(0)) {
      ASSERT_TRUE(std::isfinite(s.x) && std::isfinite(s.y));
      sum += double(s.x) * s.x + double(s.y) * s.y;
    }
    // Rough, and no sea: the steepest capillary waves break at a slope of 1.
    if (rung != RippleRung::euler) {
      EXPECT_LT(std::sqrt(sum / 4096.0), 0.5);
    }
    EXPECT_GT(std::sqrt(sum / 4096.0), 0.01);
  }
}

}  // namespace
}  // namespace petrichor::test
