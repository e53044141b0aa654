// The closed form of a streak against numerical integration, and what is found in meshes.
#include "systems/reflection/streak.h"

#include <gtest/gtest.h>

#include <cmath>

#include "systems/reflection/reflectors.hpp"
#include "systems/reflection/stage.hpp"

namespace petrichor {
namespace {

using namespace shading;

// Share of GGX's slopes (in units of alpha), and their mean, within a quadrilateral, by points of its bilinear map.
struct Quadrature {
  double share = 0.0;
  glm::dvec2 mean{0.0};
};
Quadrature integrated(vec2 a, vec2 b, vec2 c, vec2 d) {
  Quadrature q;
  const int n = 400;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double u = (i + 0.5) / n, v = (j + 0.5) / n;
      const glm::dvec2 A(a), B(b), C(c), D(d);
      const glm::dvec2 m = (A * (1 - u) + B * u) * (1 - v) + (D * (1 - u) + C * u) * v;
      const glm::dvec2 mu = (B - A) * (1 - v) + (C - D) * v, mv = (D - A) * (1 - u) + (C - B) * u;
      const double area = std::abs(mu.x * mv.y - mu.y * mv.x) / (double(n) * n), r = 1.0 + glm::dot(m, m);
      q.share += area / (M_PI * r * r);
      q.mean += m * (area / (M_PI * r * r));
    }
  q.mean /= q.share;
  return q;
}

TEST(LobePart, IsTheIntegralOverTheQuadrilateral) {
  const vec2 quads[][4] = {{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}},
                           {{0.2f, 0.1f}, {0.9f, 0.3f}, {1.1f, 2.0f}, {0.1f, 1.5f}},
                           {{3, -8}, {3.5f, -8}, {3.6f, 9}, {3.1f, 9}},
                           {{5, 5}, {6, 5}, {6, 6}, {5, 6}},
                           {{-0.01f, 0.3f}, {0.01f, 0.3f}, {0.01f, 0.33f}, {-0.01f, 0.33f}}};
  for (const auto& q : quads) {
    const vec3 part = lobe_part(q[0], q[1], q[2], q[3]);
    const Quadrature truth = integrated(q[0], q[1], q[2], q[3]);
    EXPECT_NEAR(part.z / truth.share, 1.0, 0.01) << q[0].x << " " << q[0].y;
    EXPECT_NEAR(part.x, truth.mean.x, 0.02 * (1.0 + std::abs(truth.mean.x)));
    EXPECT_NEAR(part.y, truth.mean.y, 0.02 * (1.0 + std::abs(truth.mean.y)));
  }
}

TEST(LobePart, AllSlopesAreOne) {
  EXPECT_NEAR(lobe_part({-1e3f, -1e3f}, {1e3f, -1e3f}, {1e3f, 1e3f}, {-1e3f, 1e3f}).z, 1.0, 1e-3);
}

TEST(LobePart, HalvesAddUp) {
  const float whole = lobe_part({-0.5f, 0}, {0.8f, 0}, {0.8f, 3}, {-0.5f, 3}).z;
  const float left = lobe_part({-0.5f, 0}, {0.1f, 0}, {0.1f, 3}, {-0.5f, 3}).z;
  const float right = lobe_part({0.1f, 0}, {0.8f, 0}, {0.8f, 3}, {0.1f, 3}).z;
  EXPECT_NEAR(left + right, whole, 1e-5f);
}

TEST(MirrorShare, IsAllOfSmoothAndNoneOfRough) {
  EXPECT_EQ(mirror_share(0.3f), 1.0f);
  EXPECT_EQ(mirror_share(0.6f), 0.0f);
}

TEST(WidenedAlpha, NeverNarrows) {
  for (const float length : {0.5f, 0.9f, 0.999f, 1.0f, 1.1f}) EXPECT_GE(widened_alpha2(0.01f, length), 0.01f);
  EXPECT_EQ(widened_alpha2(0.01f, 1.0f), 0.01f);
}

TEST(Reflectors, AThinLightBoxShinesToTwoSides) {
  Model model;
  add_lit_box(model, {-0.6f, 0.5f, -0.05f}, {0.6f, 2.3f, 0.05f}, {glm::vec3(0.0f), 1.0f, glm::vec3(50.0f)});
  const auto found = find_reflectors(model, model.meshes[0]);
  ASSERT_EQ(found.size(), 2u);
  for (const Reflector& r : found) {
    EXPECT_EQ(r.kind, ReflectorKind::panel);
    EXPECT_NEAR(4.0f * glm::length(r.half_across) * glm::length(r.half_up), 1.2f * 1.8f, 0.01f);
    EXPECT_NEAR(r.radiance.x, 50.0f, 0.5f);
    EXPECT_NEAR(std::abs(r.centre_m.z), 0.05f, 1e-3f);
    EXPECT_GT(glm::cross(r.half_across, r.half_up).z * r.centre_m.z, 0.0f);  // outwards
  }
  EXPECT_LT(found[0].centre_m.z * found[1].centre_m.z, 0.0f);
}

TEST(Reflectors, ACubeShinesToAllSides) {
  Model model;
  add_lit_box(model, {-0.2f, 2.0f, -0.2f}, {0.2f, 2.4f, 0.2f}, {glm::vec3(0.0f), 1.0f, glm::vec3(50.0f)});
  const auto found = find_reflectors(model, model.meshes[0]);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].kind, ReflectorKind::lantern);
}

}  // namespace
}  // namespace petrichor
