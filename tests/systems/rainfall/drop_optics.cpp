#include "systems/drops/drop_optics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/random.hpp"

namespace petrichor {
namespace {

TEST(DropOptics, EnergyOfTheOrders) {
  double sums[drop_ray_orders] = {};
  constexpr int rings = 20000;
  for (int i = 0; i < rings; ++i) {
    const auto rays = trace_sphere(std::sqrt((i + 0.5) / rings));
    for (int k = 0; k < drop_ray_orders; ++k) sums[k] += rays[k].share / rings;
  }
  // Physics, section 3: outer reflection, straight through, one, two and three internal reflections.
  const double expected[] = {0.0664, 0.8837, 0.0406, 0.0061, 0.0017};
  for (int k = 0; k < drop_ray_orders; ++k) EXPECT_NEAR(sums[k], expected[k], 1e-4) << k;
}

TEST(DropOptics, WidestRefraction) {
  EXPECT_NEAR(trace_sphere(1.0)[1].turn_rad * 180.0 / M_PI, 82.79, 0.01);
}

TEST(DropOptics, PhaseHoldsTheEnergy) {
  const auto phase = make_drop_phase();
  double sum = 0.0;
  for (int i = 0; i < drop_phase_bins; ++i) {
    sum += phase[i] * 4.0 * M_PI * (2.0 * i + 1.0) / (drop_phase_bins * double(drop_phase_bins));
  }
  EXPECT_NEAR(sum, 0.0664 + 0.8837 + 0.0406 + 0.0061 + 0.0017, 2e-4);
}

// A ray through a sphere in vectors: no formula is shared with trace_sphere but Snell's and Fresnel's.
glm::dvec3 refract_vector(const glm::dvec3& d, const glm::dvec3& n, double ratio) {
  const double c = -glm::dot(d, n);
  return ratio * d + (ratio * c - std::sqrt(1.0 - ratio * ratio * (1.0 - c * c))) * n;
}

TEST(DropOptics, PhaseAgreesWithMonteCarlo) {
  const auto phase = make_drop_phase();
  constexpr int coarse = 16, photons = 400000;
  double found[coarse] = {};
  RandomStream random(7);
  for (int i = 0; i < photons; ++i) {
    double x, y;
    do {
      x = random.uniform(-1, 1);
      y = random.uniform(-1, 1);
    } while (x * x + y * y >= 1.0);
    glm::dvec3 at(x, y, -std::sqrt(1.0 - x * x - y * y)), direction(0, 0, 1);
    const auto record = [&](const glm::dvec3& out) {
      const double half = std::sqrt(std::max(0.0, 0.5 * (1.0 - out.z)));
      found[std::min(coarse - 1, static_cast<int>(half * coarse))] += 1.0 / photons;
    };
    const bool across = random.uniform() < 0.5f;
    const auto reflectance = [across](double cosine) {
      return across ? fresnel(cosine).across : fresnel(cosine).within;
    };
    if (random.uniform() < reflectance(-glm::dot(direction, at))) {
      record(glm::reflect(direction, at));
      continue;
    }
    direction = refract_vector(direction, at, 1.0 / water_refractive_index);
    for (int bounce = 0; bounce < 4; ++bounce) {
      at += direction * (-2.0 * glm::dot(at, direction));
      const glm::dvec3 out = refract_vector(direction, -at, water_refractive_index);
      if (random.uniform() >= reflectance(glm::dot(out, at))) {
        record(out);
        break;
      }
      direction = glm::reflect(direction, at);
    }
  }
  for (int j = 0; j < coarse; ++j) {
    double power = 0.0;
    for (int i = j * drop_phase_bins / coarse; i < (j + 1) * drop_phase_bins / coarse; ++i) {
      power += phase[i] * 4.0 * M_PI * (2.0 * i + 1.0) / (drop_phase_bins * double(drop_phase_bins));
    }
    // Five standard deviations of the count.
    EXPECT_NEAR(found[j], power, 5.0 * std::sqrt(power / photons) + 1e-5) << j;
  }
}

TEST(DropOptics, ForwardLobeIsClosedForm) {
  // Near the axis offset = turn n / (2 (n - 1)), so per solid angle (n / (2 (n - 1)))^2 / pi; beside it the
  // grazing outer reflection, F / (4 pi). Bin 4 is a turn of 2 degrees.
  const double n = water_refractive_index, t = 1.0 - fresnel(1.0).across;
  const Fresnel grazing = fresnel(4.5 / 256.0);
  EXPECT_NEAR(
      make_drop_phase()[4],
      t * t * std::pow(n / (2.0 * (n - 1.0)), 2) / M_PI + 0.5 * (grazing.across + grazing.within) / (4.0 * M_PI), 0.01);
}

TEST(DropOptics, WhiteFurnace) {
  const auto white = [](const glm::dvec3&) { return glm::dvec3(1.0); };
  for (const glm::dvec3& d : {glm::dvec3(0, 0, -1), glm::dvec3(0, 1, 0), glm::normalize(glm::dvec3(1, -2, 0.5))}) {
    const double seen = drop_radiance(d, white).x;
    EXPECT_LE(seen, 1.0);
    EXPECT_GE(seen, 0.996);  // what is left after three internal reflections
  }
}

TEST(DropOptics, SkyOverDarkGround) {
  const auto sky = [](const glm::dvec3& d) { return glm::dvec3(d.y > 0.0 ? 1.0 : 0.0); };
  // Level view: half of what enters, by the symmetry of the sphere (0.474 in the truth's own conventions,
  // which trace no internal reflection: 0.5 (0.0664 + 0.8837)).
  EXPECT_NEAR(drop_radiance(glm::dvec3(0, 0, -1), sky).x, 0.5, 0.03);
  EXPECT_GT(drop_radiance(glm::dvec3(0, 1, 0), sky).x, 0.85);
  EXPECT_LT(drop_radiance(glm::dvec3(0, -1, 0), sky).x, 0.12);
}

}  // namespace
}  // namespace petrichor
