// What passes mirrors, probes and glass draw, against rays in the same street.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/systems/mirror/street_stage.hpp"

namespace petrichor {
namespace {

using namespace test;

class Mirrors : public GlTest {};

float luminance(const glm::vec3& c) {
  return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z;
}

// Along lines on the puddle the mirrored windows begin and end where rays say, to a quarter of a texel.
TEST_F(Mirrors, EdgesOfBoxesStandToAFractionOfATexel) {
  StreetStage s(1.0);
  s.stage->frame.width = 480;
  s.stage->frame.height = 270;
  s.place();
  struct Edge {
    glm::vec3 dark, light;
  };
  std::vector<Edge> edges;
  const auto truth = [&](const glm::vec3& p) {
    const MirrorQuestion q = s.seen(p, {0, 1, 0});
    return luminance(trace_street(s.street, q.place_m, q.direction).light_cd_m2);
  };
  for (float z = -2.0f; z > -11.0f; z -= 0.13f)
    for (float x = -1.9f; x < 1.9f; x += 0.05f) {
      const glm::vec3 a(x, 0, z), b(x + 0.05f, 0, z);
      if (truth(a) < 0.2f && truth(b) > 4.0f) edges.push_back({a, b});
      if (truth(b) < 0.2f && truth(a) > 4.0f) edges.push_back({b, a});
    }
  ASSERT_GT(edges.size(), 20u);
  const float texel_rad = 1.0f / (0.5f * 270.0f / MIRROR_GUARD / std::tan(0.45f));
  int checked = 0;
  double shift = 0.0;
  for (const Edge& edge : edges) {
    glm::vec3 dark = edge.dark, light = edge.light;
    for (int i = 0; i < 20; ++i) {
      const glm::vec3 middle = 0.5f * (dark + light);
      (truth(middle) > 2.0f ? light : dark) = middle;
    }
    // The share of light over a stretch of two texels to either side says where the edge is.
    const float texel_m = texel_rad * glm::distance(light, glm::vec3(s.stage->frame.camera.position_m));
    const glm::vec3 way = glm::normalize(edge.light - edge.dark) * texel_m;
    std::vector<MirrorQuestion> line;
    bool alone = true;
    const float shine = truth(light);
    for (int i = -8; i <= 8; ++i) {
      const glm::vec3 p = light + way * (static_cast<float>(i) * 0.25f);
      const float lit = truth(p);
      alone = alone && std::abs(p.x) < 1.99f && (i < 0 ? lit < 0.2f : i > 0 ? std::abs(lit - shine) < 1e-3f : true);
      line.push_back(s.seen(p, {0, 1, 0}));
    }
    const float beyond = truth(light + way * 3.5f), before = truth(light - way * 3.5f);
    if (std::abs(beyond - shine) > 1e-3f || before > 0.2f) continue;
    if (!alone) continue;
    const auto answers = s.ask(line);
    const float high = luminance(answers.back().mirror), low = luminance(answers.front().mirror);
    ASSERT_GT(high, 4.0f);
    float mean = 0.0f;
    for (const MirrorAnswer& a : answers) {
      EXPECT_GT(a.mirror.a, 0.99f);
      mean += (luminance(a.mirror) - low) / (high - low) / static_cast<float>(answers.size());
    }
    shift += static_cast<double>((0.5f - mean) * 4.25f);  // texels
    EXPECT_NEAR((0.5f - mean) * 4.25f, 0.0f, 0.6f) << "a texel is lit or dark as a whole: half of one either way";
    if (++checked == 24) break;
  }
  ASSERT_GT(checked, 8);
  EXPECT_NEAR(shift / checked, 0.0, 0.25);
}

TEST_F(Mirrors, NothingBehindTheMirrorShows) {
  StreetStage s;
  // No ground: a bright hall under the water, and one that stands half in it.
  s.place({{{-8, -4, -20}, {8, -0.4f, 6}, {25, 25, 25}}, {{-1, -3, -12}, {1, 1, -11.9f}, {3, 3, 3}}});
  s.street.boxes = {{{-1, 0, -12}, {1, 1, -11.9f}, {3, 3, 3}}};  // for the rays: what is above alone
  std::vector<MirrorQuestion> questions;
  for (float z = -1.0f; z > -11.5f; z -= 0.5f)
    for (float x = -1.8f; x < 1.9f; x += 0.4f) questions.push_back(s.seen({x, 0, z}, {0, 1, 0}));
  const auto answers = s.ask(questions);
  float brightest = 0.0f;
  for (const MirrorAnswer& a : answers) brightest = std::max(brightest, a.mirror.y);
  EXPECT_GT(brightest, 2.9f);
  EXPECT_LT(brightest, 3.1f);
}

// Ripples turn the ray: the picture is asked along it, and gives what a ray from the puddle itself finds wherever the
// camera's mirror image sees that place at all.
TEST_F(Mirrors, RipplesFetchWhatRaysFind) {
  StreetStage s(1.0);
  s.stage->frame.width = 480;
  s.stage->frame.height = 270;
  s.place();
  std::vector<MirrorQuestion> questions;
  for (float z = -1.5f; z > -10.0f; z -= 0.23f)
    for (float x = -1.5f; x < 1.6f; x += 0.19f) {
      const glm::vec3 n = glm::normalize(glm::vec3(0.05f * std::sin(9.0f * x + z), 1.0f, 0.05f * std::cos(7.0f * z)));
      questions.push_back(s.seen({x, 0, z}, n));
    }
  const auto answers = s.ask(questions);
  int close = 0, all = 0;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (answers[i].mirror.a < 0.9f) continue;
    const glm::vec3 truth(trace_street(s.street, questions[i].place_m, questions[i].direction).light_cd_m2);
    ++all;
    if (std::abs(luminance(truth) - luminance(answers[i].mirror)) < 0.1f + 0.1f * luminance(truth)) ++close;
  }
  ASSERT_GT(all, 300);
  // The rest lies within a texel of an edge, or behind what the mirrored camera sees in front of it.
  EXPECT_GT(static_cast<double>(close) / all, 0.85);
}

TEST_F(Mirrors, PanesMirrorWhatIsAcrossTheStreet) {
  StreetStage s;
  s.water = false;
  s.panes = {s.street.pane};
  s.place();
  s.look({1.0f, 1.6f, 0.5f}, {4.9f, 1.7f, -4.5f});
  std::vector<MirrorQuestion> questions;
  for (float z = -6.3f; z < -2.6f; z += 0.21f)
    for (float y = 0.7f; y < 2.8f; y += 0.17f) questions.push_back(s.seen({4.9f, y, z}, {-1, 0, 0}));
  const auto answers = s.ask(questions);
  int close = 0;
  float brightest = 0.0f;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    EXPECT_GT(answers[i].mirror.a, 0.99f);
    const glm::vec3 truth(trace_street(s.street, questions[i].place_m, questions[i].direction).light_cd_m2);
    brightest = std::max(brightest, luminance(truth));
    if (std::abs(luminance(truth) - luminance(answers[i].mirror)) < 0.1f + 0.1f * luminance(truth)) ++close;
  }
  EXPECT_GT(brightest, 4.0f) << "there is something to see in it";
  EXPECT_GT(static_cast<double>(close) / static_cast<double>(answers.size()), 0.85);
  // The wall beside it, 8 cm deeper, mirrors nothing of it.
  EXPECT_EQ(s.ask({s.seen({5.0f, 1.7f, -4.5f}, {-1, 0, 0})})[0].mirror.a, 0.0f);
}

// Rough water and wet asphalt: the lobe of the picture's mips against GGX by rays.
TEST_F(Mirrors, RoughSurfacesBlurAsGgxDoes) {
  StreetStage s;
  s.stage->frame.width = 480;
  s.stage->frame.height = 270;
  s.place();
  for (const float roughness : {0.08f, 0.15f}) {
    std::vector<MirrorQuestion> questions;
    for (float z = -2.0f; z > -9.0f; z -= 0.23f)
      for (float x = -1.5f; x < 1.6f; x += 0.1f) questions.push_back(s.seen({x, 0, z}, {0, 1, 0}, roughness));
    const auto answers = s.ask(questions);
    double error = 0.0, shared = 0.0, sum = 0.0, true_sum = 0.0;
    for (std::size_t i = 0; i < answers.size(); ++i) {
      const glm::dvec3 view = glm::normalize(s.stage->frame.camera.position_m - glm::dvec3(questions[i].place_m));
      const glm::vec3 truth(
          trace_lobe(s.street, questions[i].place_m, {0, 1, 0}, view, static_cast<double>(roughness), 128));
      const float t = luminance(truth), e = luminance(answers[i].environment), sure = answers[i].mirror.a;
      const float m = sure * luminance(answers[i].mirror) + (1.0f - sure) * e;
      error += std::pow(m - t, 2) / (t * t + 0.01);
      shared += std::pow(e - t, 2) / (t * t + 0.01);
      sum += m;
      true_sum += t;
    }
    EXPECT_LT(error, 0.5 * shared) << roughness;
    EXPECT_NEAR(sum / true_sum, 1.0, 0.15) << roughness;
  }
}

TEST_F(Mirrors, PassesRunOnlyWhereTheSceneAsks) {
  StreetStage s;
  s.place();
  s.ask({});
  EXPECT_TRUE(s.stage->ran("mirrors"));
  EXPECT_FALSE(s.stage->ran("probes"));
  s.water = false;
  s.ask({});
  EXPECT_FALSE(s.stage->ran("mirrors")) << "no water, no pane";
  s.panes = {s.street.pane};
  s.look({1.0f, 1.6f, 0.5f}, {4.9f, 1.7f, -4.5f});
  s.ask({});
  EXPECT_TRUE(s.stage->ran("mirrors"));
  s.look({1.0f, 1.6f, 0.5f}, {-4.9f, 1.7f, -4.5f});
  s.ask({});
  EXPECT_FALSE(s.stage->ran("mirrors")) << "the pane is behind the eye";
  s.water = true;
  s.look({0.3f, 1.6f, 2.0f}, {0.2f, 0.6f, -8.0f});
  s.stage->frame.techniques.set(Effect::reflections, ReflectionRung::screen_space);
  s.ask({});
  EXPECT_FALSE(s.stage->ran("mirrors")) << "another rung";
  s.probes = {{{0, 0.7, -6}, 2.0f}};
  s.ask({});
  EXPECT_TRUE(s.stage->ran("probes"));
  EXPECT_GT(probes_ladder().coverage(s.stage->frame), 0.0);
  s.stage->frame.techniques.set(Effect::probes, ProbeRung::shared);
  s.ask({});
  EXPECT_FALSE(s.stage->ran("probes"));
  s.stage->frame.techniques.set(Effect::probes, ProbeRung::moving);
  s.look({0, 1.6f, 2}, {0, 1.6f, 10});
  s.ask({});
  EXPECT_FALSE(s.stage->ran("probes")) << "the object is out of view";
  EXPECT_EQ(probes_ladder().coverage(s.stage->frame), 0.0);
}

// Half a share of the rung: half the confidence, so that the rest comes from the rung beside it.
TEST_F(Mirrors, ASharedRungGivesItsShare) {
  StreetStage s;
  s.place();
  const auto question = s.seen({0.2f, 0, -5}, {0, 1, 0});
  const float whole = s.ask({question})[0].mirror.a;
  s.stage->frame.techniques[Effect::reflections] = {static_cast<std::uint8_t>(ReflectionRung::planar),
                                                    static_cast<std::uint8_t>(ReflectionRung::screen_space), 0.3f};
  EXPECT_NEAR(s.ask({question})[0].mirror.a, 0.3f * whole, 1e-3f);
}

// Lamps, and what they light, as seen in the mirror: albedo / pi times the illuminance.
TEST_F(Mirrors, LampsLightTheMirroredScene) {
  StreetStage s;
  Model wall = box_model({{{-4, 0, -12}, {4, 4, -11}, {0, 0, 0}}});
  wall.materials[0].base_colour = {0.5f, 0.5f, 0.5f, 1.0f};
  wall.materials[0].roughness = 1.0f;
  s.stage->frame.instances = {{s.stage->add(wall), 0, true, glm::mat4(1.0f)}};
  FrameLight lamp{};
  lamp.position_m = {0, 1.0f, -9};
  lamp.direction = {0, -1, 0};
  lamp.intensity = glm::vec3(200.0f);
  lamp.range_m = 100.0f;
  lamp.source_radius_m = 0.02f;
  lamp.kind = LIGHT_POINT;
  s.stage->frame.lights = {lamp};
  s.stage->frame.sky.ambient = 0.0f;
  // The ray from the eye by way of (x, 0, z) to (0, 1, -11) straight behind the lamp.
  const glm::vec3 eye(s.stage->frame.camera.position_m), image(0, -1, -11);
  const glm::vec3 on = eye + (image - eye) * (eye.y / (eye.y + 1.0f));
  const auto answer = s.ask({s.seen(on, {0, 1, 0})})[0];
  EXPECT_NEAR(answer.mirror.x, 0.5f / 3.14159265f * 200.0f / 4.0f, 0.05f * 8.0f);
}

Model glass_model(const MirrorPane& pane) {
  Model model;
  Material glass;
  glass.base_colour = {1, 1, 1, 0};
  glass.metallic = 0.0f;
  glass.roughness = 0.04f;
  glass.alpha_mode = AlphaMode::blend;
  glass.double_sided = true;
  model.materials.push_back(glass);
  Primitive p;
  p.material = 0;
  for (int i = 0; i < 4; ++i) {
    Vertex v;
    v.position_m = glm::vec3(
        pane.world * glm::vec4((i & 1 ? 0.5f : -0.5f) * pane.size_m.x, (i & 2 ? 0.5f : -0.5f) * pane.size_m.y, 0, 1));
    v.normal = glm::vec3(pane.world[2]);
    p.vertices.push_back(v);
  }
  p.indices = {0, 1, 2, 2, 1, 3};
  p.bounds_min_m = p.vertices[0].position_m;
  p.bounds_max_m = p.vertices[3].position_m;
  p.bounds_min_m = glm::min(p.bounds_min_m, p.bounds_max_m) - 0.01f;
  p.bounds_max_m = glm::max(p.vertices[0].position_m, p.bounds_max_m) + 0.01f;
  Mesh mesh;
  mesh.primitives.push_back(p);
  model.meshes.push_back(mesh);
  return model;
}

// Glass shows the plane's picture with a pane's reflectance: on top of what is behind, which here is a dark wall.
TEST_F(Mirrors, GlassShowsThePlanesPicture) {
  StreetStage s(0.5, true);
  s.water = false;
  s.panes = {s.street.pane};
  s.place();
  s.stage->frame.instances.push_back({s.stage->add(glass_model(s.street.pane)), 0, false, glm::mat4(1.0f)});
  s.look({1.0f, 1.6f, 0.5f}, {4.9f, 1.7f, -4.5f});
  const auto half = [](std::uint16_t h) {  // finite, not negative
    const int exponent = (h >> 10) & 31, mantissa = h & 1023;
    return exponent == 0 ? std::ldexp(static_cast<float>(mantissa), -24)
                         : std::ldexp(1.0f + static_cast<float>(mantissa) / 1024.0f, exponent - 15);
  };
  const auto picture = [&] {
    std::vector<float> out;
    for (const std::uint16_t h : s.bytes("colour")) out.push_back(half(h));
    return out;
  };
  const auto with = picture();
  s.stage->frame.techniques.set(Effect::reflections, ReflectionRung::screen_space);
  const auto without = picture();
  ASSERT_EQ(with.size(), static_cast<std::size_t>(160 * 90 * 4));
  const glm::mat4 clip = s.stage->frame.uniforms.view_projection;
  const glm::vec3 eye(s.stage->frame.camera.position_m);
  double error = 0.0, error_without = 0.0;
  int pixels = 0;
  for (float z = -6.3f; z < -2.6f; z += 0.06f)
    for (float y = 0.7f; y < 2.8f; y += 0.06f) {
      const glm::vec3 place(4.9f, y, z);
      const glm::vec4 q = clip * glm::vec4(place - eye, 1.0f);
      const glm::ivec2 at((glm::vec2(q) / q.w * 0.5f + 0.5f) * glm::vec2(160, 90));
      if (at.x < 0 || at.y < 0 || at.x >= 160 || at.y >= 90) continue;
      const glm::vec3 view = glm::normalize(place - eye);
      const float c = -glm::dot(view, glm::vec3(-1, 0, 0));
      const float f = 0.04f + 0.96f * std::pow(1.0f - c, 5.0f), pane = 2.0f * f / (1.0f + f);
      const float smooth = 1.0f - 2.0f * 0.04f;
      const double behind = trace_street(s.street, place, view).light_cd_m2.y;
      const double mirrored = trace_street(s.street, place, glm::reflect(view, glm::vec3(-1, 0, 0))).light_cd_m2.y;
      const double truth = behind * (1.0 - double(pane * smooth)) + mirrored * double(pane * smooth);
      const std::size_t i = static_cast<std::size_t>(at.y * 160 + at.x) * 4 + 1;
      error += std::pow(static_cast<double>(with[i]) - truth, 2);
      error_without += std::pow(static_cast<double>(without[i]) - truth, 2);
      ++pixels;
    }
  ASSERT_GT(pixels, 500);
  EXPECT_LT(error, 0.4 * error_without);
}

class Probes : public GlTest {};

FrameMirrors::Probe car_at(glm::dvec3 place, std::vector<std::uint32_t> own = {}) {
  FrameMirrors::Probe p;
  p.place_m = place;
  p.radius_m = 2.2f;
  p.entity = 1000;
  p.own = std::move(own);
  return p;
}

// A car drives down the street: points on its skin mirror what rays from there find, and better than by what the
// camera's surroundings say.
TEST_F(Probes, AMovingCarMirrorsWhatIsAroundIt) {
  StreetStage s;
  s.place();
  s.look({0.5f, 1.6f, 3.0f}, {0, 0.8f, -20.0f});
  double probe = 0.0, shared = 0.0;
  for (const double z : {-6.3, -11.8, -20.1}) {
    const glm::dvec3 place(1.0, 0.7, z);
    s.probes = {car_at(place)};
    std::vector<MirrorQuestion> questions;
    for (int i = 0; i < 400; ++i) {
      const float u = (static_cast<float>(i) + 0.5f) / 400.0f, a = 2.39996f * static_cast<float>(i);
      const glm::vec3 n(std::sqrt(1 - u * u) * std::cos(a), u, std::sqrt(1 - u * u) * std::sin(a));
      const glm::vec3 skin = glm::vec3(place) + n * glm::vec3(0.8f, 0.6f, 1.8f);
      const MirrorQuestion q = s.seen(skin, glm::normalize(n / glm::vec3(0.8f, 0.6f, 1.8f)), 0.25f);
      const glm::vec3 view = skin - glm::vec3(s.stage->frame.camera.position_m);
      if (glm::dot(q.normal, view) < 0.0f) questions.push_back(q);
    }
    const auto answers = s.ask(questions);
    for (std::size_t i = 0; i < answers.size(); ++i) {
      EXPECT_EQ(answers[i].probe.a, 1.0f);
      const glm::dvec3 view = glm::normalize(s.stage->frame.camera.position_m - glm::dvec3(questions[i].place_m));
      const float t =
          luminance(glm::vec3(trace_lobe(s.street, questions[i].place_m, questions[i].normal, view, 0.25, 64)));
      probe += std::pow(luminance(answers[i].probe) - t, 2) / (t * t + 0.01f);
      shared += std::pow(luminance(answers[i].environment) - t, 2) / (t * t + 0.01f);
    }
  }
  EXPECT_LT(probe, 0.5 * shared);
  // Elsewhere it says nothing.
  EXPECT_EQ(s.ask({s.seen({1.0f, 0.0f, -2.0f}, {0, 1, 0})})[0].probe.a, 0.0f);
}

TEST_F(Probes, ACarDoesNotSeeItself) {
  StreetStage s;
  auto boxes = s.street.boxes;
  const auto own = static_cast<std::uint32_t>(boxes.size());
  boxes.push_back({{0.5f, 0.2f, -8}, {0.8f, 1.8f, -4}, {28, 0, 28}});  // its side shines, past the capture
  s.place(boxes);
  s.probes = {car_at({0, 0.7, -6}, {own})};
  std::vector<MirrorQuestion> questions;
  for (int i = 0; i < 64; ++i) {
    const float u = static_cast<float>(i) / 32.0f - 0.98f, a = 2.4f * static_cast<float>(i);
    questions.push_back(
        {{0, 0.7f, -6}, {0, 1, 0}, {std::sqrt(1 - u * u) * std::cos(a), u, std::sqrt(1 - u * u) * std::sin(a)}, 0.0f});
  }
  for (const MirrorAnswer& a : s.ask(questions)) EXPECT_FALSE(a.probe.x > 12.0f && a.probe.y < 1.0f);
  // Of another car it sees that very box.
  s.probes = {car_at({0, 0.7, -6}, {})};
  int violet = 0;
  for (const MirrorAnswer& a : s.ask(questions)) violet += a.probe.x > 12.0f && a.probe.y < 1.0f ? 1 : 0;
  EXPECT_GT(violet, 12);
}

TEST_F(Probes, WhatStandsIsCapturedOnceAndLightsShowAtOnce) {
  StreetStage s;
  s.place();
  FrameLight lamp{};
  lamp.position_m = {0, 4, -6};
  lamp.direction = {0, -1, 0};
  lamp.intensity = glm::vec3(100.0f);
  lamp.range_m = 50.0f;
  lamp.kind = LIGHT_POINT;
  s.stage->frame.lights = {lamp};
  s.probes = {car_at({0, 0.7, -6})};
  s.ask({});
  const auto captured = s.state->probes.captured, lit = s.state->probes.lit;
  EXPECT_EQ(captured, 1u);
  for (int i = 0; i < 3; ++i) {
    s.look({0.3f * static_cast<float>(i), 1.6f, 2}, {0, 0.6f, -8});
    s.ask({});
  }
  EXPECT_EQ(s.state->probes.captured, captured);
  EXPECT_EQ(s.state->probes.lit, lit);
  s.stage->frame.lights[0].intensity *= 0.5f;  // a lamp flickers
  s.ask({});
  EXPECT_EQ(s.state->probes.captured, captured);
  EXPECT_EQ(s.state->probes.lit, lit + 1);
  s.probes = {car_at({0, 0.7, -6.1})};  // within the plateau round a place of the grid
  s.ask({});
  EXPECT_EQ(s.state->probes.captured, captured);
  s.probes = {car_at({0, 0.7, -6.5})};  // between two
  s.ask({});
  EXPECT_EQ(s.state->probes.captured, captured + 1);
}

}  // namespace
}  // namespace petrichor
