#include "systems/wetness/optics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "systems/brdf.h"

namespace petrichor {
namespace {

using namespace wetness;

// Fresnel's equations for unpolarised light from index n1 to n2.
double fresnel(double n1, double n2, double cosine) {
  const double sine = n1 / n2 * std::sqrt(1.0 - cosine * cosine);
  if (sine >= 1.0) return 1.0;
  const double t = std::sqrt(1.0 - sine * sine);
  const double s = (n1 * cosine - n2 * t) / (n1 * cosine + n2 * t), p = (n1 * t - n2 * cosine) / (n1 * t + n2 * cosine);
  return 0.5 * (s * s + p * p);
}

// Share of diffuse light from above that comes out of a smooth film over a diffuse base again, by photons; the light
// that the film's upper face mirrors is not counted.
double traced_film(double albedo, int photons, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double out = 0.0;
  for (int i = 0; i < photons; ++i) {
    double weight = 1.0 - fresnel(1.0, 1.333, std::sqrt(unit(random)));  // diffuse: cosine is the root of even numbers
    for (int bounce = 0; bounce < 200; ++bounce) {
      weight *= albedo;
      const double back = fresnel(1.333, 1.0, std::sqrt(unit(random)));
      out += weight * (1.0 - back);
      weight *= back;
      if (weight < 1e-7) break;
    }
  }
  return out / photons;
}

TEST(FilmOptics, IsWhatPhotonsFind) {
  for (const float a : {0.05f, 0.1f, 0.3f, 0.5f, 0.8f, 1.0f})
    EXPECT_NEAR(film_albedo(glm::vec3(a)).x, traced_film(a, 400000, 11), 1e-3) << a;
}

TEST(FilmOptics, DarkAsphaltHalves) {
  // Shared physics, section 9.
  const float dry[] = {0.05f, 0.1f, 0.2f, 0.3f, 0.5f, 0.8f}, wet[] = {0.025f, 0.052f, 0.108f, 0.172f, 0.322f, 0.633f};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(film_albedo(glm::vec3(dry[i])).x, wet[i], 6e-4f);
}

TEST(FilmOptics, WhatTheGBufferHoldsComesToTheFilmsAlbedoOnceShaded) {
  // Shading takes the reflected share away by the angle of view; over all angles water's is Re.
  for (const float a : {0.05f, 0.3f, 0.8f}) {
    double sum = 0.0;
    constexpr int n = 20000;
    for (int i = 0; i < n; ++i) sum += 1.0 - fresnel(1.0, 1.333, std::sqrt((i + 0.5) / n));
    EXPECT_NEAR(film_base_colour(glm::vec3(a)).x * sum / n, film_albedo(glm::vec3(a)).x, 1e-3);
  }
}

TEST(FilmOptics, SoakedStoneKeepsWhatMeasuredStoneKeeps) {
  // Soils, concrete, brick: 0.4 to 0.6; Lagarde's 0.2 is the published way alone.
  EXPECT_NEAR(wet_albedo(glm::vec3(0.3f), 1.0f, 1.0f, 1.0f).x / 0.3f, 0.42f, 0.02f);
  EXPECT_GT(wet_albedo(glm::vec3(0.05f), 1.0f, 1.0f, 1.0f).x / 0.05f, 0.3f);
  // Without pores the film model alone.
  EXPECT_NEAR(wet_albedo(glm::vec3(0.3f), 0.0f, 1.0f, 1.0f).x, film_albedo(glm::vec3(0.3f)).x, 1e-6f);
  // Nothing wet: nothing changes (the similarity is its own inverse).
  for (const float a : {0.02f, 0.3f, 0.9f, 1.0f}) EXPECT_NEAR(wet_albedo(glm::vec3(a), 1.0f, 0.0f, 0.0f).x, a, 0.004f);
}

TEST(FilmOptics, DrownedShareIsThatOfGaussianHeights) {
  for (double z = -2.0; z <= 3.0; z += 0.25) {
    const double phi = std::exp(-0.5 * z * z) / std::sqrt(2.0 * M_PI), share = 0.5 * std::erfc(-z / std::sqrt(2.0));
    EXPECT_NEAR(drowned_share(static_cast<float>((z * share + phi) * 1e-3), 1e-3f), share, 0.03) << z;
  }
}

TEST(FilmOptics, LagardesFactorsAreAsPrinted) {
  EXPECT_FLOAT_EQ(porosity_of_roughness(0.9f), 1.0f);
  EXPECT_FLOAT_EQ(porosity_of_roughness(0.7f), 0.5f);
  EXPECT_FLOAT_EQ(published_factor(1.0f, 0.0f), 0.2f);
  EXPECT_FLOAT_EQ(published_factor(1.0f, 1.0f), 1.0f);
  // gloss = lerp(1, gloss, lerp(1, factor, 0.5 wet)).
  EXPECT_NEAR(published_gloss(0.2f, 0.2f, 1.0f), 1.0f + (0.2f - 1.0f) * 0.6f, 1e-6f);
}

}  // namespace
}  // namespace petrichor
