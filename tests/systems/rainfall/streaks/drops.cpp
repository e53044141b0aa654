// Oscillating drops: their shapes, frequencies and light (shared physics, sections 1 and 3).
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "engine/core/random.hpp"
#include "systems/drops/drop_optics.hpp"
#include "systems/drops/drop_physics.hpp"
#include "systems/rainfall/streaks/drop_tracer.hpp"

namespace petrichor {
namespace {

constexpr double pi = std::numbers::pi;

glm::dvec3 random_direction(unsigned i) {
  const glm::vec4 r = random_float4(glm::uvec4(i, 11u, 12u, 13u));
  const double y = 2.0 * r.x - 1.0, turn = 2.0 * pi * r.y, across = std::sqrt(1.0 - y * y);
  return {across * std::cos(turn), y, across * std::sin(turn)};
}

TEST(OscillatingDrop, FrequenciesAreRayleighs) {
  const double known[][3] = {{1.0, 344, 666}, {1.6, 170, 329}, {2.0, 122, 235}, {3.0, 66, 128}, {4.0, 43, 83}};
  for (const auto& k : known) {  // physics 1: given to a hertz
    EXPECT_NEAR(oscillation_frequency_hz(2, k[0]), k[1], 0.51);
    EXPECT_NEAR(oscillation_frequency_hz(3, k[0]), k[2], 0.51);
    EXPECT_NEAR(oscillation_frequency_hz(3, k[0]) / oscillation_frequency_hz(2, k[0]), std::sqrt(30.0 / 8.0), 1e-12);
  }
}

TEST(OscillatingDrop, BandsRepeatWithTheFall) {
  const double known[][2] = {{1.6, 0.033}, {2.0, 0.053}, {3.0, 0.122}};  // mm, metres
  for (const auto& k : known)
    EXPECT_NEAR(terminal_speed_mps(k[0]) / oscillation_frequency_hz(2, k[0]), k[1], 0.04 * k[1]);
}

TEST(OscillatingDrop, RestingShapeHasThePublishedAxisRatio) {
  for (double mm = 1.0; mm <= 6.0; mm += 0.5) {
    const DropShape shape = drop_shape(mm, {0.0, 0.0, 0.0}, 0.0, 0.0);
    const double height = radius(shape, {0, 1, 0}) + radius(shape, {0, -1, 0});
    double widest = 0.0;
    for (int i = 0; i < 2000; ++i) {
      const double angle = pi * i / 2000;
      const glm::dvec3 u(std::sin(angle), std::cos(angle), 0.0);
      widest = std::max(widest, 2.0 * radius(shape, u) * u.x);
    }
    EXPECT_NEAR(height / widest, axis_ratio(mm), 0.006) << mm << " mm";
    if (mm >= 2.0) EXPECT_LT(radius(shape, {0, -1, 0}), radius(shape, {0, 1, 0})) << "the bottom is the flat side";
  }
  EXPECT_NEAR(radius(drop_shape(0.1, {0.0, 0.0, 0.0}, 0.0, 0.0), {0, 1, 0}), 1.0, 2e-4);
}

TEST(OscillatingDrop, VolumeStaysWhateverThePhase) {
  for (const double mm : {1.0, 2.0, 4.0, 6.0})
    for (int phase = 0; phase < 4; ++phase) {
      const DropShape shape = drop_shape(mm, {0.2, 0.2, 0.8}, 1.57 * phase, 0.7 + 1.57 * phase);
      EXPECT_NEAR(volume(shape), 4.0 / 3.0 * pi, 1e-6);
      // By chance, which knows nothing of the polynomial: the mean cube of the radius.
      double sum = 0.0;
      constexpr unsigned count = 40000;
      for (unsigned i = 0; i < count; ++i) sum += std::pow(radius(shape, random_direction(i)), 3);
      EXPECT_NEAR(sum / count, 1.0, 0.01) << mm << " mm, phase " << phase;
    }
}

TEST(OscillatingDrop, GradientIsThatOfTheSurface) {
  const DropShape shape = drop_shape(3.0, {0.15, 0.1, 0.6}, 1.1, 2.3);
  for (unsigned i = 0; i < 50; ++i) {
    const glm::dvec3 p = random_direction(i) * 1.1;
    glm::dvec3 gradient, ignored;
    surface(shape, p, gradient);
    for (int axis = 0; axis < 3; ++axis) {
      glm::dvec3 step(0.0);
      step[axis] = 1e-5;
      EXPECT_NEAR((surface(shape, p + step, ignored) - surface(shape, p - step, ignored)) / 2e-5, gradient[axis], 1e-6);
    }
  }
}

struct Light {
  double area = 0.0;                                         // of the picture over the disc's
  double share = 0.0;                                        // of what the eye sees, that comes from anywhere
  std::vector<double> phase = std::vector<double>(32, 0.0);  // by sin(turn / 2)
};

Light light_of(const DropShape& shape, const glm::dvec3& to_eye, int rays) {
  const glm::dvec3 side = glm::normalize(glm::cross(to_eye, glm::dvec3(0, 1, 0))), up = glm::cross(side, to_eye);
  Light light;
  int hits = 0;
  constexpr double reach = 1.45;
  for (int i = 0; i < rays; ++i) {
    const double u = 0.5 + 0.7548776662466927 * i, v = 0.5 + 0.5698402909980532 * i;
    const double r = reach * std::sqrt(u - std::floor(u)), turn = 2.0 * pi * (v - std::floor(v));
    const DropPaths paths =
        trace_drop(shape, r * std::cos(turn) * side + r * std::sin(turn) * up + 4.0 * to_eye, -to_eye);
    hits += paths.count > 0;
    for (int p = 0; p < paths.count; ++p) {
      light.share += paths.paths[p].share;
      const double cosine = -glm::dot(paths.paths[p].direction, to_eye);
      const double sine = std::sqrt(std::max(0.5 - 0.5 * cosine, 0.0));
      light.phase[std::min(31, static_cast<int>(32 * sine))] += paths.paths[p].share * reach * reach / rays;
    }
  }
  light.area = reach * reach * hits / rays;
  light.share /= std::max(hits, 1);
  return light;
}

TEST(DropLight, OfASphereIsThePhaseFunction) {
  const std::vector<float> phase = make_drop_phase();
  const Light light = light_of(sphere_shape(), glm::normalize(glm::dvec3(1.0, 0.4, 0.3)), 200000);
  EXPECT_NEAR(light.area, 1.0, 2e-3);
  for (int bin = 0; bin < 32; ++bin) {
    double power = 0.0;  // of the disc, into the bin's directions
    for (int k = 8 * bin; k < 8 * bin + 8; ++k)
      power += phase[k] * 4.0 * pi * (double(k + 1) * (k + 1) - double(k) * k) / (256.0 * 256.0);
    EXPECT_NEAR(light.phase[bin], power, 0.03 * power + 2e-5) << "bin " << bin;
  }
}

TEST(DropLight, OfAWhiteWorldIsWhite) {
  EXPECT_NEAR(light_of(sphere_shape(), {1, 0, 0}, 20000).share, 1.0, 0.004);
  for (const double mm : {1.0, 2.0, 4.0})
    for (const double elevation : {-1.0, 0.0, 0.5, 1.3})
      for (const double phase : {0.4, 2.0, 4.9}) {
        const Light light = light_of(drop_shape(mm, {0.1, 0.05, 0.8}, phase, 2.0 * phase + 1.0),
                                     {std::cos(elevation), std::sin(elevation), 0.0}, 8000);
        EXPECT_LT(light.share, 1.0 + 1e-9);
        EXPECT_GT(light.share, 0.996) << mm << " mm from " << elevation << ", phase " << phase;
      }
}

TEST(DropLight, OneRayThroughASphereFollowsSnell) {
  // At normalised radius b the ray turns by 2 (asin b - asin(b / n)), and the outer reflection by pi - 2 asin b.
  for (const double b : {0.0, 0.3, 0.7, 0.95}) {
    const DropPaths paths = trace_drop(sphere_shape(), {b, 0.0, 4.0}, {0, 0, -1});
    const auto known = trace_sphere(b);
    ASSERT_GE(paths.count, 3) << b;
    for (int order = 0; order < 3; ++order) {
      EXPECT_NEAR(std::acos(std::clamp(-paths.paths[order].direction.z, -1.0, 1.0)), known[order].turn_rad, 1e-6);
      EXPECT_NEAR(paths.paths[order].share, known[order].share, 1e-7) << "order " << order << " at " << b;
    }
  }
  EXPECT_EQ(trace_drop(sphere_shape(), {1.01, 0.0, 4.0}, {0, 0, -1}).count, 0);
}

}  // namespace
}  // namespace petrichor
