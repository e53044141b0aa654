// The reflection model against exact optics and against the books of energy.
#include "systems/brdf.h"

#include <gtest/gtest.h>

#include <cmath>

namespace {

using namespace petrichor::shading;

// Unpolarised reflectance of a smooth boundary (Fresnel's equations).
double exact_fresnel(double c, double n) {
  const double s = std::sqrt(1.0 - (1.0 - c * c) / (n * n));
  const double rs = (c - n * s) / (c + n * s), rp = (n * c - s) / (n * c + s);
  return 0.5 * (rs * rs + rp * rp);
}

TEST(Brdf, FresnelOfWaterIsExactToOnePercentOfLight) {
  const float f0 = static_cast<float>(std::pow(0.333 / 2.333, 2));
  double worst = 0.0, worst_schlick = 0.0;
  for (int i = 0; i <= 2000; ++i) {
    const double c = i / 2000.0;
    const double truth = exact_fresnel(c, 1.333);
    worst = std::max(worst, std::abs(fresnel(vec3(f0), static_cast<float>(c), 1.0f).x - truth));
    worst_schlick = std::max(worst_schlick, std::abs(f0 + (1 - f0) * std::pow(1 - c, 5) - truth));
  }
  EXPECT_LT(worst, 0.012);                // physics 3: 0.010 with the published power
  EXPECT_GT(worst_schlick, 3.0 * worst);  // or the correction would not be worth its cost
}

// Directional albedo of the specular lobe with every facet a mirror, by quadrature over half vectors: with
// h ~ D (n.h), the estimate is 4 V (n.l) (v.h) / (n.h).
double furnace(double roughness, double n_dot_v) {
  const double alpha = roughness * roughness, a2 = alpha * alpha;
  const vec3 v(static_cast<float>(std::sqrt(1.0 - n_dot_v * n_dot_v)), static_cast<float>(n_dot_v), 0.0f);
  const int rings = 256, turns = 256;
  double sum = 0.0;
  for (int i = 0; i < rings; ++i) {
    const double u = (i + 0.5) / rings;
    const double cosine = std::sqrt((1.0 - u) / (1.0 + (a2 - 1.0) * u)), sine = std::sqrt(1.0 - cosine * cosine);
    for (int j = 0; j < turns; ++j) {
      const double phi = 2.0 * M_PI * (j + 0.5) / turns;
      const vec3 h(static_cast<float>(sine * std::cos(phi)), static_cast<float>(cosine),
                   static_cast<float>(sine * std::sin(phi)));
      const float v_dot_h = dot(v, h);
      const vec3 l = 2.0f * v_dot_h * h - v;
      if (l.y <= 0.0f || v_dot_h <= 0.0f) continue;
      sum += 4.0 * smith_visibility(l.y, static_cast<float>(n_dot_v), static_cast<float>(a2)) * l.y * v_dot_h / h.y;
    }
  }
  return sum / (rings * turns);
}

TEST(Brdf, WhiteFurnaceMakesNoLight) {
  for (const double roughness : {0.1, 0.3, 0.5, 0.8, 1.0})
    for (const double n_dot_v : {0.1, 0.4, 0.7, 1.0}) {
      const double albedo = furnace(roughness, n_dot_v);
      EXPECT_LE(albedo, 1.002) << roughness << " " << n_dot_v;
      // Single scattering loses what would bounce twice: nothing on a smooth surface, up to 70 % on the roughest
      // (Heitz et al. 2016, "Multiple-Scattering Microfacet BSDFs with the Smith Model", figure 1).
      EXPECT_GE(albedo, roughness <= 0.1 ? 0.97 : 0.3) << roughness << " " << n_dot_v;
    }
}

TEST(Brdf, DistributionIsNormalised) {
  for (const float roughness : {0.2f, 0.5f, 1.0f}) {
    const float alpha = roughness * roughness;
    double sum = 0.0;  // integral of D (n.h) over the hemisphere
    const int n = 200000;
    for (int i = 0; i < n; ++i) {
      const double c = (i + 0.5) / n;
      sum += 2.0 * M_PI * ggx_distribution(static_cast<float>(c), alpha * alpha) * c / n;
    }
    EXPECT_NEAR(sum, 1.0, 1e-3) << roughness;
  }
}

TEST(Brdf, AlbedoFitFollowsTheFurnace) {
  for (const double roughness : {0.2, 0.5, 0.8})
    for (const double n_dot_v : {0.2, 0.5, 0.9}) {
      const vec2 fit = ggx_albedo(static_cast<float>(roughness), static_cast<float>(n_dot_v));
      // With every facet a mirror the two terms sum.
      EXPECT_NEAR(fit.x + fit.y, furnace(roughness, n_dot_v), 0.09) << roughness << " " << n_dot_v;
      EXPECT_LE(DIELECTRIC_F0 * fit.x + fit.y, 1.0f);
    }
}

TEST(Brdf, SphereLightKeepsItsEnergy) {
  // The widened lobe's peak falls as alpha^2 / wide^2: the integral over directions stays.
  for (const float alpha : {0.01f, 0.1f, 0.4f}) {
    const vec2 lobe = sphere_light_lobe(alpha, 0.15f, 1.0f / 6.0f);
    EXPECT_GE(lobe.x, alpha);
    EXPECT_NEAR(ggx_distribution(1.0f, lobe.x * lobe.x) / ggx_distribution(1.0f, alpha * alpha), lobe.y,
                1e-3f * lobe.y);
  }
  const vec3 mirror = normalize(vec3(0.0f, 1.0f, -1.0f));
  const vec3 centre = mirror * 5.0f + vec3(0.05f, 0.0f, 0.0f);
  EXPECT_NEAR(dot(normalize(sphere_light_point(centre, mirror, 0.2f)), mirror), 1.0f, 1e-6f);  // the mirror ray hits it
  const vec3 off = mirror * 5.0f + vec3(1.0f, 0.0f, 0.0f);
  EXPECT_NEAR(length(sphere_light_point(off, mirror, 0.2f) - off), 0.2f, 1e-4f);  // else its nearest rim
}

TEST(Brdf, AttenuationsFollowKhronos) {
  EXPECT_NEAR(distance_attenuation(4.0f, 1e4f), 0.25f, 1e-6f);
  EXPECT_EQ(distance_attenuation(100.0f, 10.0f), 0.0f);
  const float inner = std::cos(0.3f), outer = std::cos(0.7f);
  const float scale = 1.0f / (inner - outer), offset = -outer * scale;
  EXPECT_NEAR(spot_attenuation(inner, scale, offset), 1.0f, 1e-5f);
  EXPECT_NEAR(spot_attenuation(outer, scale, offset), 0.0f, 1e-5f);
  EXPECT_NEAR(spot_attenuation(0.5f * (inner + outer), scale, offset), 0.25f, 1e-5f);
}

}  // namespace
