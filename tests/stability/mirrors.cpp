// Where planar mirrors and probes could break: each test provokes one failure.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "tests/systems/mirror/street_stage.hpp"

namespace petrichor {
namespace {

using namespace test;

class MirrorStability : public GlTest {};

bool finite(const std::vector<std::uint16_t>& halves) {
  for (const std::uint16_t h : halves)
    if ((h & 0x7c00u) == 0x7c00u) return false;
  return true;
}

// The eye sinks into the water and comes up again. In the plane itself its mirror image has no size: the image fades
// before, all stays finite, and under water nothing is drawn.
TEST_F(MirrorStability, TheEyeGoesThroughThePlane) {
  StreetStage s;
  s.place();
  float last = -1.0f;
  for (const float height :
       {0.5f, 0.12f, 0.1f, 0.08f, 0.07f, 0.06f, 0.05f, 0.04f, 0.03f, 0.02f, 0.01f, 1e-4f, 1e-7f, 0.0f, -0.01f}) {
    s.look({0.2f, height, 0.5f}, {0.2f, height - 0.1f, -6.0f});
    const MirrorAnswer a = s.ask({s.seen({0.2f, 0, -4}, {0, 1, 0})})[0];
    EXPECT_TRUE(finite(s.stage->texture("mirrors"))) << height;
    EXPECT_TRUE(std::isfinite(a.mirror.x) && std::isfinite(a.mirror.a)) << height;
    if (height <= 0.02f) {
      EXPECT_FALSE(s.stage->ran("mirrors")) << height;
    }
    const float share =
        s.stage->frame.mirrors ? s.stage->frame.mirrors->water ? s.stage->frame.mirrors->water->share : 0 : 0;
    if (last >= 0.0f) {
      EXPECT_LE(std::abs(share - last), 0.3f) << height;
    }
    last = share;
  }
}

// At grazing angles depths crowd together and a texel is metres long: what is seen there is still what rays find.
TEST_F(MirrorStability, GrazingAnglesKeepTheirDepths) {
  StreetStage s(1.0);
  s.street.puddle.half_size_m = {3.0f, 30.0f};
  s.street.puddle.world_from_puddle[3].z = -25.0f;
  s.place();
  s.look({0.1f, 0.15f, 1.0f}, {0.0f, 0.5f, -30.0f});
  std::vector<MirrorQuestion> questions;
  for (float z = -1.0f; z > -40.0f; z *= 1.07f)
    for (float x = -2.4f; x < 2.5f; x += 0.3f) questions.push_back(s.seen({x, 0, z}, {0, 1, 0}));
  const auto answers = s.ask(questions);
  int close = 0, all = 0;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (answers[i].mirror.a < 0.9f) continue;
    const double t = trace_street(s.street, questions[i].place_m, questions[i].direction).light_cd_m2.y;
    ++all;
    close += std::abs(t - double(answers[i].mirror.y)) < 0.1 + 0.1 * t ? 1 : 0;
  }
  ASSERT_GT(all, 200);
  EXPECT_GT(static_cast<double>(close) / all, 0.8);
}

// The plane at the horizon, edge on, behind, filling the view, and from a kilometre above.
TEST_F(MirrorStability, AnyViewOfThePlaneIsFinite) {
  StreetStage s;
  s.panes = {s.street.pane};
  s.place();
  int ran = 0;
  for (const glm::vec3 eye : {glm::vec3(0, 1.6f, 2), glm::vec3(0, 1000, -6), glm::vec3(4.899f, 1.7f, 0),
                              glm::vec3(4.9f, 1.7f, 0), glm::vec3(4.95f, 1.5f, -4.5f), glm::vec3(0, 0.3f, -6)})
    for (const glm::vec3 way : {glm::vec3(0, 0, -1), glm::vec3(0, -1, -1e-3f), glm::vec3(0, 1, -1e-3f),
                                glm::vec3(1, 0, 0), glm::vec3(0.3f, -0.2f, 1), glm::vec3(-1, -1, 0)}) {
      s.look(eye, eye + way);
      s.ask({});
      ran += s.stage->ran("mirrors") ? 1 : 0;
      EXPECT_TRUE(finite(s.stage->texture("mirrors")));
    }
  EXPECT_GT(ran, 8);
}

// Two fronts, one to either side: walking by, the larger one on screen changes. Chosen by a hard rule its image would
// appear at once; by dominance it comes and goes in small steps, with no memory of the frame before.
TEST_F(MirrorStability, TheChosenPaneChangesWithoutAFlash) {
  StreetStage s;
  s.water = false;
  MirrorPane left = s.street.pane;
  left.world =
      glm::mat4(glm::vec4(0, 0, -1, 0), glm::vec4(0, 1, 0, 0), glm::vec4(1, 0, 0, 0), glm::vec4(-4.9f, 1.7f, -4.5f, 1));
  s.panes = {s.street.pane, left};
  float last_right = -1.0f, most = 0.0f;
  bool hard_last = false, hard_flipped = false;
  float seen_right = 0.0f, seen_left = 0.0f;
  for (int i = 0; i <= 400; ++i) {
    const float yaw = -0.5f + 0.0025f * static_cast<float>(i);
    s.look({0, 1.6f, 6}, glm::vec3(std::sin(yaw), 0, -std::cos(yaw)) + glm::vec3(0, 1.6f, 6));
    s.choose();
    const auto& pane = s.stage->frame.mirrors ? s.stage->frame.mirrors->pane : std::optional<FrameMirrors::Plane>();
    const bool right = pane && pane->normal.x < 0.0f;
    const float share = pane ? pane->share : 0.0f;
    const float right_share = right ? share : 0.0f;
    if (last_right >= 0.0f) most = std::max(most, std::abs(right_share - last_right));
    if (i > 0 && pane && right != hard_last) hard_flipped = true;
    if (pane) hard_last = right;
    last_right = right_share;
    (right ? seen_right : seen_left) = std::max(right ? seen_right : seen_left, share);
  }
  EXPECT_TRUE(hard_flipped) << "the choice did change";
  EXPECT_EQ(seen_right, 1.0f);
  EXPECT_EQ(seen_left, 1.0f);
  EXPECT_LT(most, 0.25f);
}

// A car drives, a lamp throws its shadow, the camera jumps: a frame's bytes are its own, whatever was drawn before.
TEST_F(MirrorStability, AnyOrderOfFramesGivesTheSameBytes) {
  const auto scene = [](StreetStage& s) {
    auto boxes = s.street.boxes;
    boxes.push_back({{-0.8f, 0.2f, -2}, {0.8f, 1.2f, 2}, {2, 0, 0}});
    s.place(boxes);
    FrameLight lamp{};
    lamp.position_m = {1, 4, -8};
    lamp.direction = {0, -1, 0};
    lamp.intensity = glm::vec3(100.0f);
    lamp.range_m = 50.0f;
    lamp.kind = LIGHT_POINT;
    lamp.casts_shadow = true;
    s.stage->frame.lights = {lamp};
  };
  const auto frame = [](StreetStage& s, int number) {
    const float z = -4.0f - 0.37f * static_cast<float>(number);
    s.stage->frame.instances.back().matrix = glm::translate(glm::mat4(1.0f), {1.0f, 0, z});
    s.stage->frame.geometry_version = 100u + static_cast<unsigned>(number);
    s.stage->frame.lights[0].intensity = glm::vec3(100.0f + 10.0f * static_cast<float>(number % 3));
    FrameMirrors::Probe p;
    p.place_m = {1.0, 0.7, static_cast<double>(z)};
    p.radius_m = 2.2f;
    p.entity = s.stage->frame.instances.back().entity;
    p.own = {p.entity};
    s.probes = {p};
    if (number % 2)
      s.look({0.3f, 1.6f, 2.0f}, {0.2f, 0.6f, -8.0f});
    else
      s.look({-1.0f, 1.2f, 3.0f + 0.1f * static_cast<float>(number)}, {1.0f, 0.6f, -8.0f});
    s.ask({});
    auto bytes = s.stage->texture("mirrors");
    const auto probe = s.stage->texture("probes");
    // The layer of the probe in view.
    bytes.insert(bytes.end(), probe.begin(), probe.begin() + static_cast<std::ptrdiff_t>(probe.size() / 4 / 65 * 64));
    return bytes;
  };
  StreetStage one, other;
  scene(one);
  scene(other);
  std::vector<std::vector<std::uint16_t>> forward(6);
  for (int i = 0; i < 6; ++i) forward[static_cast<std::size_t>(i)] = frame(one, i);
  for (const int i : {4, 1, 5, 1, 0, 3, 2}) {
    const auto again = frame(other, i);
    const auto& first = forward[static_cast<std::size_t>(i)];
    ASSERT_EQ(again.size(), first.size());
    std::size_t different = 0;
    for (std::size_t k = 0; k < again.size(); ++k) different += again[k] != first[k] ? 1 : 0;
    EXPECT_EQ(different, 0u) << "frame " << i;
  }
}

// The published cube map stands at the object's place alone; captures at places of a grid would show each step. Seen
// from the object's middle, what a car mirrors moves in small steps, across the whole grid.
TEST_F(MirrorStability, ADrivingCarsImageDoesNotJump) {
  StreetStage s;
  s.place();
  s.look({0.5f, 1.6f, 3.0f}, {0, 0.8f, -20.0f});
  std::vector<MirrorQuestion> questions(48);
  std::vector<MirrorAnswer> last;
  double worst = 0.0, total = 0.0;
  for (int step = 0; step <= 40; ++step) {
    const float z = -6.0f - 0.05f * static_cast<float>(step);
    FrameMirrors::Probe p;
    p.place_m = {1.0, 0.7, static_cast<double>(z)};
    p.radius_m = 2.2f;
    s.probes = {p};
    for (std::size_t i = 0; i < questions.size(); ++i) {
      const float u = (static_cast<float>(i) + 0.5f) / 48.0f, a = 2.39996f * static_cast<float>(i);
      questions[i] = {{1.0f, 0.7f, z},
                      {0, 1, 0},
                      {std::sqrt(1 - u * u) * std::cos(a), u, std::sqrt(1 - u * u) * std::sin(a)},
                      0.4f};
    }
    const auto now = s.ask(questions);
    if (!last.empty()) {
      double change = 0.0, sum = 0.0;
      for (std::size_t i = 0; i < now.size(); ++i) {
        change += static_cast<double>(glm::length(glm::vec3(now[i].probe) - glm::vec3(last[i].probe)));
        sum += static_cast<double>(glm::length(glm::vec3(now[i].probe)));
      }
      worst = std::max(worst, change / sum);
      total += change / sum / 40.0;
    }
    last = now;
  }
  EXPECT_GT(total, 0.001) << "it does move";
  EXPECT_LT(worst, 0.15);  // of all its light, in 5 cm
}

}  // namespace
}  // namespace petrichor
