// What the passes of light draw, measured in the picture.
#include <gtest/gtest.h>

#include <cmath>

#include "systems/atmosphere/airlight.h"
#include "systems/brdf.h"
#include "systems/lighting/chosen_lights.hpp"
#include "tests/engine/platform/gl_test.hpp"
#include "tests/systems/lighting/stage.hpp"

namespace petrichor {
namespace {

using namespace test;

constexpr float pi = 3.14159265f;

using Lighting = test::GlTest;

Model floor_model(const Look& look = {}) {
  Model model;
  add_box(model, {-20, -1, -20}, {20, 0, 20}, look);
  return model;
}

// Light that a matt floor of albedo 0.5 sends straight up when lit from straight above: the part below the clear
// coat plus the coat's own mirror lobe, both from the model under test (brdf.cpp checks that).
float floor_radiance(float lux, float roughness) {
  const shading::vec2 fit = shading::ggx_albedo(roughness, 1.0f);
  const float reflected = shading::DIELECTRIC_F0 * fit.x + fit.y;
  const float a = roughness * roughness;
  const float lobe =
      shading::ggx_distribution(1.0f, a * a) * shading::smith_visibility(1.0f, 1.0f, a * a) * shading::DIELECTRIC_F0;
  return lux * (0.5f * (1.0f - reflected) / pi + lobe);
}

nlohmann::json lamps_only() {
  nlohmann::json table = full_table();
  disable(table, {"environment", "airlight", "atmosphere", "shadow_maps"});
  return table;
}

TEST_F(Lighting, FallsWithTheSquareOfTheDistance) {
  Stage stage(floor_model());
  stage.look({0, 3, 0}, {0, 0, 0});
  for (const float height : {2.0f, 4.0f, 8.0f}) {
    // The lamp stands over the camera, so it is seen from straight behind.
    stage.frame.lights = {lamp({0, height, 0}, 400.0f)};
    const float measured = stage.centre(stage.draw(lamps_only(), "colour")).x;
    // 11 bits of rgba16f, 8-bit albedo, and the centre is half a pixel off the axis.
    EXPECT_NEAR(measured / floor_radiance(400.0f / (height * height), 1.0f), 1.0f, 0.015f) << height;
  }
}

TEST_F(Lighting, SpotsFollowTheKhronosCone) {
  Stage stage(floor_model());
  stage.look({0, 4, 0}, {0, 0, 0});
  const float inner = 0.2f, outer = 0.5f, height = 3.0f;
  FrameLight even = lamp({0, height, 0}, 300.0f), spot = even;
  spot.kind = LIGHT_SPOT;
  spot.inner_cone_rad = inner;
  spot.outer_cone_rad = outer;
  stage.frame.lights = {even};
  const auto without = stage.draw(lamps_only(), "colour");
  stage.frame.lights = {spot};
  const auto with = stage.draw(lamps_only(), "colour");
  ASSERT_EQ(with.size(), without.size());
  const float per_pixel =
      2.0f * 4.0f * std::tan(0.5f * stage.frame.camera.vertical_fov_rad) / static_cast<float>(stage.height);
  for (int x = 0; x < stage.width; x += 3) {
    const std::size_t i = static_cast<std::size_t>(stage.height / 2 * stage.width + x);
    const float dx = (static_cast<float>(x - stage.width / 2) + 0.5f) * per_pixel, dy = 0.5f * per_pixel;
    const float cosine = height / std::sqrt(height * height + dx * dx + dy * dy);
    const float edge =
        std::clamp((cosine - std::cos(outer)) / std::max(0.001f, std::cos(inner) - std::cos(outer)), 0.0f, 1.0f);
    EXPECT_NEAR(with[i].x / without[i].x, edge * edge, 0.01f) << x;
  }
}

TEST_F(Lighting, WetGroundDrawsALampOut) {
  // Physics 10: at a mirror elevation of 20.8 degrees the image of a lamp on ground of alpha 0.05 is about three
  // times as tall as wide (6 m lamp at 20 m, eye at 1.6 m).
  Look wet{glm::vec3(0.02f), std::sqrt(0.05f)};
  Model model;
  add_box(model, {-100, -1, -100}, {100, 0, 100}, wet);
  Stage stage(model, 192, 192);
  stage.look({0, 1.6f, 0}, {0, 1.6f - std::tan(0.36f), -1.0f});
  stage.frame.camera.vertical_fov_rad = 0.45f;
  stage.frame.lights = {lamp({0, 6, -20}, 1000.0f)};
  stage.frame.lights[0].source_radius_m = 0.005f;
  const auto pixels = stage.draw(lamps_only(), "colour");
  ASSERT_FALSE(pixels.empty());
  std::size_t peak = 0;
  for (std::size_t i = 0; i < pixels.size(); ++i)
    if (pixels[i].x > pixels[peak].x) peak = i;
  const int px = static_cast<int>(peak) % stage.width, py = static_cast<int>(peak) / stage.width;
  const auto extent = [&](int dx, int dy) {
    int n = 0;
    for (int way : {-1, 1})
      for (int k = 1; k < stage.width; ++k) {
        const int x = px + way * k * dx, y = py + way * k * dy;
        if (x < 0 || y < 0 || x >= stage.width || y >= stage.height) break;
        if (pixels[static_cast<std::size_t>(y * stage.width + x)].x < 0.5f * pixels[peak].x) break;
        ++n;
      }
    return static_cast<float>(n + 1);
  };
  EXPECT_NEAR(extent(0, 1) / extent(1, 0), 2.98f, 0.45f);  // 15 %, as physics 10d asks
}

Model awning() {
  Model model = floor_model();
  add_box(model, {-0.5f, 1.5f, -0.5f}, {0.5f, 1.6f, 0.5f}, {});  // a slab between lamp and floor
  return model;
}

TEST_F(Lighting, ShadowIsDarkAndOpenFloorIsNot) {
  Stage stage(awning());
  stage.look({0, 1.0f, 3.0f}, {0, 0, 0});
  FrameLight light = lamp({0, 4, 0}, 300.0f);
  nlohmann::json table = full_table();
  disable(table, {"environment", "airlight", "atmosphere"});
  stage.frame.lights = {light};
  const float open = stage.centre(stage.draw(table, "colour")).x;
  light.casts_shadow = true;
  stage.frame.lights = {light};
  const float shaded = stage.centre(stage.draw(table, "colour")).x;
  EXPECT_GT(open, 0.5f);
  EXPECT_LT(shaded, 0.02f * open);
  // Well outside the slab's shadow (its edge falls at 0.8 m) the shadow map must change nothing.
  stage.look({3.0f, 1.0f, 3.0f}, {3.0f, 0, 0});
  const float beside = stage.centre(stage.draw(table, "colour")).x;
  light.casts_shadow = false;
  stage.frame.lights = {light};
  EXPECT_NEAR(beside / stage.centre(stage.draw(table, "colour")).x, 1.0f, 0.03f);
}

TEST_F(Lighting, PenumbraWidensWithTheSource) {
  Stage stage(awning(), 256, 64);
  stage.look({0.8f, 1.2f, 0.0f}, {0.8f, 0, 0});
  stage.frame.camera.vertical_fov_rad = 0.35f;
  nlohmann::json table = full_table();
  disable(table, {"environment", "airlight", "atmosphere"});
  const auto width_of_edge = [&](float radius) {
    FrameLight light = lamp({0, 4, 0}, 300.0f);
    light.casts_shadow = true;
    light.source_radius_m = radius;
    stage.frame.lights = {light};
    const auto pixels = stage.draw(table, "colour");
    float brightest = 0.0f;
    for (const auto& p : pixels) brightest = std::max(brightest, p.x);
    int grey = 0;
    for (int x = 0; x < stage.width; ++x) {
      const float share = pixels[static_cast<std::size_t>(32 * stage.width + x)].x / brightest;
      if (share > 0.2f && share < 0.8f) ++grey;
    }
    return grey;
  };
  EXPECT_GT(width_of_edge(0.25f), 1.5f * static_cast<float>(width_of_edge(0.01f)));
}

TEST_F(Lighting, ShadowMapsAreKeptWhileNothingMoves) {
  Stage stage(awning());
  stage.look({0, 2, 6}, {0, 0, 0});
  FrameLight light = lamp({0, 4, 0}, 300.0f);
  light.casts_shadow = true;
  stage.frame.lights = {light, light};
  stage.frame.lights[1].position_m.x = 2.0f;
  stage.draw(full_table(), "picture");
  EXPECT_EQ(stage.state->shadows.maps_drawn, 2u);
  const auto captures = stage.state->environment.captures;
  stage.look({0.2f, 2, 6}, {0, 0, 0});
  stage.frame.lights[0].intensity *= 0.5f;  // a flicker needs no new map
  stage.draw(full_table(), "picture");
  EXPECT_EQ(stage.state->shadows.maps_drawn, 2u);
  EXPECT_EQ(stage.state->environment.captures, captures);
  stage.frame.lights[1].position_m.x = 2.5f;
  stage.draw(full_table(), "picture");
  EXPECT_EQ(stage.state->shadows.maps_drawn, 3u);
  ++stage.frame.geometry_version;
  stage.draw(full_table(), "picture");
  EXPECT_EQ(stage.state->shadows.maps_drawn, 5u);
  EXPECT_GT(stage.state->environment.captures, captures);
}

TEST_F(Lighting, TileListsLoseNoVisibleLight) {
  Stage stage(awning(), 160, 120);
  stage.look({0, 1.6f, 6}, {0, 0.5f, 0});
  for (int i = 0; i < 60; ++i) {
    FrameLight light = lamp({-9.0f + 0.3f * static_cast<float>(i), 0.5f + 0.07f * static_cast<float>(i % 7),
                             -8.0f + static_cast<float>(i % 13)},
                            3.0f + static_cast<float>(i % 5));
    light.casts_shadow = i % 10 == 0;
    stage.frame.lights.push_back(light);
  }
  nlohmann::json listed = full_table(), exhaustive = full_table();
  disable(listed, {"airlight"});
  disable(exhaustive, {"airlight"});
  pass(exhaustive, "light_lists")["parameters"] = {{"threshold", -1.0}};
  const auto a = stage.draw(listed, "colour"), b = stage.draw(exhaustive, "colour");
  const float exposure = exposure_scale(stage.frame.camera.exposure_ev100);
  float worst = 0.0f, brightest = 0.0f;
  for (std::size_t i = 0; i < a.size(); ++i) {
    worst = std::max(worst, (b[i].x - a[i].x) * exposure);
    brightest = std::max(brightest, b[i].x * exposure);
  }
  EXPECT_GT(brightest, 0.05f);
  // Each light that is left out lacks at most the threshold of 0.003; here dozens are that faint at once: five of them.
  EXPECT_LT(worst, 5.0f * 0.003f);
}

TEST_F(Lighting, ManyLightsKeepTheStrongest) {
  Frame frame;
  for (int i = 0; i < 300; ++i) frame.lights.push_back(lamp({static_cast<float>(i), 2, 0}, 10.0f));
  frame.lights[299].intensity = glm::vec3(1e7f);
  const ChosenLights chosen = choose_lights(frame, {});
  EXPECT_EQ(chosen.counts.x, static_cast<unsigned>(MAXIMUM_LIGHTS));
  EXPECT_EQ(chosen.lights[0].intensity_radius.x, 1e7f);
}

TEST_F(Lighting, MistTakesLightExponentially) {
  Model model;
  add_box(model, {-50, -50, -1}, {50, 50, 0}, {glm::vec3(0.0f), 1.0f, glm::vec3(100.0f)});
  Stage stage(model);
  nlohmann::json table = full_table();
  disable(table, {"environment"});
  stage.frame.mist = {0.03f, glm::vec3(0.96f)};
  for (const float distance : {5.0f, 20.0f, 60.0f}) {
    stage.look({0, 0, distance}, {0, 0, 0});
    const float share = stage.centre(stage.draw(table, "colour")).x / 100.0f;
    EXPECT_NEAR(share / std::exp(-0.03f * distance), 1.0f, 0.01f) << distance;
  }
}

TEST_F(Lighting, MistGlowsRoundALampAndFadesWithDistanceFromIt) {
  Model model;
  add_box(model, {-50, -50, -41}, {50, 50, -40}, {glm::vec3(0.0f)});
  Stage stage(model, 160, 120);
  stage.look({0, 0, 0}, {0, 0, -1});
  stage.frame.mist = {0.01f, glm::vec3(1.0f)};
  stage.frame.lights = {lamp({0, 0, -20}, 1000.0f)};
  nlohmann::json table = full_table();
  disable(table, {"environment", "shadow_maps"});
  const auto pixels = stage.draw(table, "colour");
  const auto at = [&](int x) { return pixels[static_cast<std::size_t>(60 * stage.width + 80 + x)].x; };
  // Single scattering at 10 degrees from a lamp of 1000 cd at 20 m in mist of 10 /km before a wall at 40 m, by the
  // formula that airlight.cpp holds against quadrature.
  const float pixels_per_rad = stage.frame.uniforms.lens.z;
  const float angle = 0.1745f;
  const float expected = 1000.0f * airlight::airlight(20.0f * std::cos(angle), 20.0f * std::sin(angle), 0.0f,
                                                      40.0f / std::cos(angle), 0.01f, 0.01f, 0.8f);
  EXPECT_NEAR(at(static_cast<int>(std::tan(angle) * pixels_per_rad)) / expected, 1.0f,
              0.15f);  // a quarter of the resolution
  EXPECT_GT(at(10), at(20));
  EXPECT_GT(at(20), at(40));
}

TEST_F(Lighting, ClearAirRunsNoAirlight) {
  Stage stage(floor_model());
  stage.look({0, 2, 6}, {0, 0, 0});
  stage.frame.lights = {lamp({0, 4, 0}, 300.0f)};
  stage.draw(full_table(), "picture");
  for (const PassReport& report : stage.graph->report())
    EXPECT_EQ(report.culled, report.name == "airlight" || report.name == "bloom" || report.name == "shadow_maps")
        << report.name << " " << report.reason;
}

TEST_F(Lighting, SurroundingsLightWhatNoLampReaches) {
  // Inside a white, glowing box of 1 cd/m2 a grey floor shines with its albedo (a furnace): all light comes from
  // the capture.
  Model model;
  const Look glow{glm::vec3(0.0f), 1.0f, glm::vec3(1.0f)};
  add_box(model, {-9, -9, -9}, {9, -8, 9}, {glm::vec3(0.5f)});
  for (const auto& [low, high] : {std::pair{glm::vec3(-9, 8, -9), glm::vec3(9, 9, 9)},
                                  {glm::vec3(-9, -9, -9), glm::vec3(-8, 9, 9)},
                                  {glm::vec3(8, -9, -9), glm::vec3(9, 9, 9)},
                                  {glm::vec3(-9, -9, -9), glm::vec3(9, 9, -8)},
                                  {glm::vec3(-9, -9, 8), glm::vec3(9, 9, 9)}})
    add_box(model, low, high, glow);
  Stage stage(model);
  stage.look({0, 0, 0}, {0, -8, 0});
  nlohmann::json table = full_table();
  disable(table, {"atmosphere"});
  const float floor = stage.centre(stage.draw(table, "colour")).x;
  // Half of the sphere is walls and ceiling at 1, the capture sees the floor itself as dark below: between the
  // albedo and a tenth less for the ring of nine coefficients.
  EXPECT_NEAR(floor, 0.5f, 0.08f);
}

TEST_F(Lighting, BloomKeepsTheSumOfLight) {
  Model model;
  add_box(model, {-0.1f, -0.1f, -10}, {0.1f, 0.1f, -9}, {glm::vec3(0.0f), 1.0f, glm::vec3(5000.0f)});
  Stage stage(model, 512, 512);
  stage.look({0, 0, 0}, {0, 0, -1});
  stage.frame.camera.bloom = 0.1f;
  const auto colour = stage.draw(full_table(), "colour");
  double before = 0.0, after = 0.0;
  for (const auto& p : colour) before += p.x;
  const auto bloom = stage.draw(full_table(), "bloom");
  for (const auto& p : bloom) after += 4.0 * p.x;  // half the resolution
  EXPECT_GT(before, 1000.0);
  EXPECT_NEAR(after / before, 1.0, 0.02);
  float far_from_lamp = 0.0f;
  for (int x = 0; x < 20; ++x)
    far_from_lamp = std::max(far_from_lamp, bloom[static_cast<std::size_t>(128 * 256 + 128 + 60 + x)].x);
  EXPECT_GT(far_from_lamp, 0.0f);
}

// How far a picture of a slanted white edge is from its true coverage, by pixel.
TEST_F(Lighting, AntialiasingMovesEdgesTowardsTheirCoverage) {
  Model model;
  add_box(model, {-20, -1, -20}, {20, 0, 20}, {glm::vec3(0.0f), 1.0f, glm::vec3(3.0f)});
  Stage stage(model, 192, 128);
  stage.look({0, 2, 0}, {0, 2, -1});
  stage.frame.camera.orientation = stage.frame.camera.orientation * glm::angleAxis(0.15f, glm::vec3(0, 0, 1));
  nlohmann::json table = full_table();
  disable(table, {"environment", "airlight", "atmosphere"});
  const auto raw = stage.draw(table, "display"), smooth = stage.draw(table, "picture");
  // Truth: the same at eight times the resolution, averaged in display values.
  Stage fine(model, 192 * 8, 128 * 8);
  fine.frame.camera = stage.frame.camera;
  const auto truth = fine.draw(table, "display");
  double before = 0.0, after = 0.0;
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 192; ++x) {
      double mean = 0.0;
      for (int k = 0; k < 64; ++k)
        mean += truth[static_cast<std::size_t>((y * 8 + k / 8) * 192 * 8 + x * 8 + k % 8)].x / 64.0;
      const std::size_t i = static_cast<std::size_t>(y * 192 + x);
      before += std::pow(raw[i].x - mean, 2.0);
      after += std::pow(smooth[i].x - mean, 2.0);
    }
  EXPECT_GT(before, 1.0);
  EXPECT_LT(after, 0.35 * before);
}

TEST_F(Lighting, AFrameDoesNotDependOnTheFramesBeforeIt) {
  const auto prepare = [](Stage& stage) {
    stage.frame.mist = {0.004f, glm::vec3(0.96f)};
    stage.frame.sky = {{0.01f, 0.01f, 0.02f}, {0.05f, 0.04f, 0.03f}, 0.25f, 1.0f};
    stage.frame.camera.bloom = 0.06f;
    for (int i = 0; i < 5; ++i) {
      FrameLight light = lamp({-4.0f + 2.0f * static_cast<float>(i), 3.3f, -1.7f * static_cast<float>(i)}, 200.0f);
      light.casts_shadow = i < 3;
      stage.frame.lights.push_back(light);
    }
  };
  const auto here = [](Stage& stage) { stage.look({1.3f, 1.7f, 7.1f}, {0, 1, 0}); };
  Stage first(awning()), second(awning());
  prepare(first);
  prepare(second);
  here(first);
  const auto alone = first.draw(full_table(), "picture");
  for (const glm::vec3 eye : {glm::vec3(-9.3f, 2, 3), glm::vec3(14, 5, -6), glm::vec3(4.4f, 1.5f, 8)}) {
    second.look(eye, {0, 0, 0});
    second.draw(full_table(), "picture");
  }
  here(second);
  const auto after_others = second.draw(full_table(), "picture");
  const auto again = second.draw(full_table(), "picture");
  EXPECT_TRUE(alone == after_others);
  EXPECT_TRUE(again == after_others);
  float brightest = 0.0f;
  for (const auto& p : alone) brightest = std::max(brightest, p.x);
  EXPECT_GT(brightest, 0.2f);
}

}  // namespace
}  // namespace petrichor
