// What the two passes draw and when they run.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "systems/drops/sums.hpp"
#include "systems/splatter/shape.hpp"
#include "systems/splatter/stage.hpp"
#include "tests/engine/platform/gl_test.hpp"

namespace petrichor {
namespace {

using Splatter = test::GlTest;

std::unique_ptr<SplatterStage> backlit_body(float rate) {
  auto made = SplatterStage::make(is_software_gl());
  if (!made) throw std::runtime_error(made.error().message);
  SplatterStage& s = **made;
  s.frame.width = 160;
  s.frame.height = 90;
  s.frame.rain = still_rain(rate);
  FrameLight lamp{};
  lamp.position_m = {-1.5f, 3.0f, -5.0f};
  lamp.intensity = glm::vec3(400.0f);
  lamp.kind = LIGHT_POINT;
  lamp.lights_rain = true;
  s.frame.lights = {lamp};
  s.frame.time_s = 20.0;
  s.add(body_model(), glm::mat4(1.0f));
  look(s.frame.camera, {0.6f, 1.6f, 4.5f}, {0.0f, 1.1f, 0.0f}, 45.0f);
  return std::move(*made);
}

double light_of(SplatterStage& s) {
  auto drawn = s.draw();
  EXPECT_TRUE(drawn) << drawn.error().message;
  double sum = 0.0;
  const std::vector<float> light = s.read_light();
  for (std::size_t i = 0; i < light.size(); i += 4) {
    EXPECT_TRUE(std::isfinite(light[i]));
    sum += light[i];
  }
  return sum;
}

bool ran(const SplatterStage& s, const std::string& pass) {
  for (const PassReport& r : s.report())
    if (r.name == pass) return !r.culled;
  return false;
}

TEST_F(Splatter, NeitherPassRunsWithoutRainMarksOrRungs) {
  auto s = backlit_body(50.0f);
  light_of(*s);
  EXPECT_TRUE(ran(*s, "splatter") && ran(*s, "halos"));
  s->frame.techniques.set(Effect::halos, HaloRung::none);
  s->frame.techniques.set(Effect::splatter, SplatterRung::none);
  EXPECT_EQ(light_of(*s), 0.0);
  EXPECT_FALSE(ran(*s, "splatter") || ran(*s, "halos"));
  auto dry = backlit_body(0.0f);
  EXPECT_EQ(light_of(*dry), 0.0);
  EXPECT_FALSE(ran(*dry, "splatter") || ran(*dry, "halos"));
  auto bare = backlit_body(50.0f);
  bare->marks.clear();
  EXPECT_EQ(light_of(*bare), 0.0);
  EXPECT_FALSE(ran(*bare, "splatter") || ran(*bare, "halos"));
}

TEST_F(Splatter, NeitherPassRunsWhereNoMarkIsInView) {
  auto s = backlit_body(50.0f);
  const glm::quat there = s->frame.camera.orientation;
  s->frame.camera.orientation = glm::angleAxis(1.5707963f, glm::vec3(1.0f, 0.0f, 0.0f));  // straight up
  EXPECT_EQ(light_of(*s), 0.0);
  EXPECT_FALSE(ran(*s, "splatter") || ran(*s, "halos"));
  s->frame.camera.orientation = there;
  EXPECT_GT(light_of(*s), 0.0);
  EXPECT_TRUE(ran(*s, "splatter") && ran(*s, "halos"));
}

// While one rung gives way to another their light adds up as the shares say: thin mist is linear.
TEST_F(Splatter, SharesOfRungsKeepTheLight) {
  auto s = backlit_body(50.0f);
  s->frame.techniques.set(Effect::splatter, SplatterRung::none);
  s->frame.techniques.set(Effect::halos, HaloRung::layer);
  const double layer = light_of(*s);
  s->frame.techniques.set(Effect::halos, HaloRung::fins);
  const double fins = light_of(*s);
  ASSERT_GT(layer, 0.0);
  ASSERT_GT(fins, 0.0);
  s->frame.techniques[Effect::halos] = {static_cast<std::uint8_t>(HaloRung::fins),
                                        static_cast<std::uint8_t>(HaloRung::layer), 0.3f};
  EXPECT_NEAR(light_of(*s), 0.3 * fins + 0.7 * layer, 0.06 * layer);
  s->frame.techniques.set(Effect::halos, HaloRung::none);
  double whole = 0.0, third = 0.0;
  for (int i = 0; i < 6; ++i) {
    s->frame.time_s = 20.0 + 0.1 * i;
    s->frame.techniques.set(Effect::splatter, SplatterRung::shells);
    whole += light_of(*s);
    s->frame.techniques[Effect::splatter] = {1, 0, 0.3f};
    third += light_of(*s);
  }
  EXPECT_NEAR(third, 0.3 * whole, 0.06 * whole);
}

TEST_F(Splatter, MoreRainMoreMistAndMoreRings) {
  double halo = 0.0, rings = 0.0;
  for (const float rate : {5.0f, 20.0f, 80.0f}) {
    auto s = backlit_body(rate);
    s->frame.techniques.set(Effect::splatter, SplatterRung::none);
    const double h = light_of(*s);
    EXPECT_GT(h, 1.5 * halo) << rate;
    halo = h;
    s->frame.techniques.set(Effect::splatter, SplatterRung::shells);
    s->frame.techniques.set(Effect::halos, HaloRung::none);
    look(s->frame.camera, {0.3f, 2.0f, 1.6f}, {0.0f, 1.2f, 0.4f}, 45.0f);
    double r = 0.0;
    for (int i = 0; i < 8; ++i) {
      s->frame.time_s = 20.0 + 0.13 * i;
      r += light_of(*s);
    }
    EXPECT_GT(r, rings) << rate;
    rings = r;
  }
}

// Rings, as printed by extruded geometry and along the ray, are the same rings.
TEST_F(Splatter, ShellsAsPrintedHaveTheSameMeanLight) {
  auto s = backlit_body(80.0f);
  s->frame.techniques.set(Effect::halos, HaloRung::none);
  look(s->frame.camera, {0.3f, 2.4f, 1.4f}, {0.0f, 1.2f, 0.4f}, 40.0f);
  double along_rays = 0.0, printed = 0.0;
  for (int i = 0; i < 8; ++i) {
    s->frame.time_s = 20.0 + 0.13 * i;
    s->marks[0].published = false;
    along_rays += light_of(*s);
    s->marks[0].published = true;
    printed += light_of(*s);
  }
  EXPECT_NEAR(printed, along_rays, 0.35 * along_rays);
}

TEST(Shape, ABoxHasTheFourEdgesThatRainStrikes) {
  const Model box = box_model({1.0f, 0.5f, 2.0f}, 0.0f);
  const CatcherShape s = make_shape(box.meshes[0]);
  EXPECT_EQ(s.positions.size(), 8u);
  EXPECT_EQ(s.edges.size(), 4u);
  for (const CatcherEdge& e : s.edges) EXPECT_FLOAT_EQ(s.positions[e.a].y, 1.0f);
  const glm::vec3 top = surface_at({&s, glm::vec3(1.0f)}, 0.3f, -0.7f);
  EXPECT_NEAR(top.x, 1.0f, 1e-5f);
  EXPECT_EQ(top.y, 1.0f);
}

// Against the integral in small steps, from steep to grazing.
TEST(Shape, TheLayersClosedFormIsTheIntegral) {
  const Model box = box_model({1.0f, 0.5f, 2.0f}, 0.0f);
  const CatcherShape s = make_shape(box.meshes[0]);
  const ScaledShape scaled{&s, glm::vec3(1.0f)};
  for (const float degrees : {0.05f, 0.5f, 2.0f, 8.0f, 30.0f, 80.0f}) {
    const float a = glm::radians(degrees);
    const glm::vec3 way(0.0f, -std::sin(a), -std::cos(a)), eye = glm::vec3(0.1f, 1.0f, 0.2f) - way * 6.0f;
    double fine = 0.0;
    for (int i = 0; i < 200000; ++i) {
      const glm::vec3 p = eye + way * (6.0f * (float(i) + 0.5f) / 200000.0f);
      if (std::abs(p.x) < 1.0f && std::abs(p.z) < 2.0f && p.y > 1.0f)
        fine += 0.05 * std::exp(-(p.y - 1.0) / 0.03) * 6.0 / 200000.0;
    }
    EXPECT_NEAR(layer_depth(scaled, eye, way, 6.0f, 0.05f, 0.03f, 24), fine, 0.05 * fine) << degrees;
  }
}

}  // namespace
}  // namespace petrichor
