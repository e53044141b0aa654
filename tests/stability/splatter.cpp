// Where rings and mist on moving things fail.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "systems/drops/sums.hpp"
#include "systems/occlusion/occlusion.hpp"
#include "systems/splatter/mist.hpp"
#include "systems/splatter/placed.hpp"
#include "systems/splatter/stage.hpp"
#include "tests/engine/platform/gl_test.hpp"

namespace petrichor {
namespace {

using Splatter = test::GlTest;

std::unique_ptr<SplatterStage> body_in_rain(float rate, bool maps = false) {
  auto made = SplatterStage::make(is_software_gl(), maps ? occlusion_passes() : std::vector<PassOffer>());
  if (!made) throw std::runtime_error(made.error().message);
  SplatterStage& s = **made;
  s.frame.width = 160;
  s.frame.height = 90;
  s.frame.rain = still_rain(rate);
  FrameLight lamp{};
  lamp.position_m = {0.0f, 6.0f, 0.0f};  // on the axis that things turn about
  lamp.intensity = glm::vec3(400.0f);
  lamp.kind = LIGHT_POINT;
  lamp.lights_rain = true;
  s.frame.lights = {lamp};
  s.frame.time_s = 20.0;
  s.add(body_model(), glm::mat4(1.0f));
  return std::move(*made);
}

std::vector<float> picture(SplatterStage& s) {
  auto drawn = s.draw();
  EXPECT_TRUE(drawn) << drawn.error().message;
  return s.read_light();
}

double sum_of(const std::vector<float>& light) {
  double sum = 0.0;
  for (std::size_t i = 0; i < light.size(); i += 4) sum += light[i];
  return sum;
}

// The car turns and the eye with it: what it sees is the same, rings and all.
TEST_F(Splatter, RingsStayOnAThingThatMovesAndTurns) {
  auto s = body_in_rain(80.0f);
  s->frame.techniques.set(Effect::halos, HaloRung::none);
  const auto seen = [&](float degrees, const glm::vec3& shift) {
    const glm::mat4 m = glm::rotate(glm::translate(glm::mat4(1.0f), shift), glm::radians(degrees), glm::vec3(0, 1, 0));
    s->frame.instances[0].matrix = m;
    s->frame.lights[0].position_m = glm::vec3(m * glm::vec4(0.0f, 6.0f, 0.0f, 1.0f));
    look(s->frame.camera, glm::vec3(m * glm::vec4(0.3f, 2.0f, 1.6f, 1.0f)),
         glm::vec3(m * glm::vec4(0.0f, 1.2f, 0.4f, 1.0f)), 40.0f);
    return picture(*s);
  };
  const std::vector<float> still = seen(0.0f, glm::vec3(0.0f));
  ASSERT_GT(sum_of(still), 0.0);
  for (const float degrees : {3.0f, 90.0f, 180.0f}) {
    const std::vector<float> moved = seen(degrees, {7.3f, 0.2f, -4.1f});
    double difference = 0.0;
    for (std::size_t i = 0; i < still.size(); i += 4) difference += std::abs(still[i] - moved[i]);
    EXPECT_LT(difference, 0.1 * sum_of(still)) << degrees;  // edges of pixels
  }
  // The test can fail: a moment later the rings are others.
  s->frame.time_s += 0.5;
  const std::vector<float> later = seen(0.0f, glm::vec3(0.0f));
  double difference = 0.0;
  for (std::size_t i = 0; i < still.size(); i += 4) difference += std::abs(still[i] - later[i]);
  EXPECT_GT(difference, 0.5 * sum_of(still));
}

// Largest jump of the outline's summed opacity from frame to frame while the car turns at 180 degrees a second, over
// what it changes on average.
double largest_jump(SplatterStage& s, bool published) {
  s.marks[0].published = published;
  ShapeStore shapes;
  // By the half metre along the outline: fins that go where others come do not cancel from one end to the other.
  std::vector<double> last;
  double largest = 0.0, total = 0.0;
  auto splatter = std::make_shared<FrameSplatter>();
  for (int frame = 0; frame < 60; ++frame) {
    s.frame.instances[0].matrix = glm::rotate(glm::mat4(1.0f), glm::radians(3.0f * float(frame)), glm::vec3(0, 1, 0));
    look(s.frame.camera, {0.6f, 1.6f, 4.5f}, {0.0f, 1.1f, 0.0f}, 45.0f);
    splatter->catchers = s.marks;
    splatter->mist = splash_mist(*s.frame.rain);
    s.frame.splatter = splatter;
    finish_frame(s.frame);
    const auto placed = place_catchers(shapes, s.frame, 640, 360, 0.1f, 1.0f, 0.3f, 4, 8);
    std::vector<FinGpu> fins;
    if (!placed.empty()) append_fins(placed[0], s.frame, 16, fins);
    std::vector<double> now(12, 0.0);
    double sum = 0.0;
    for (const FinGpu& f : fins) {
      const glm::vec3 middle = 0.5f * (glm::vec3(f.a_depth) + glm::vec3(f.b_depth));
      const double share = f.struck.w * glm::distance(glm::vec3(f.a_depth), glm::vec3(f.b_depth));
      const int at = std::clamp(int(3.0 * (middle.x + 2.5)), 0, 11);
      now[std::size_t(at)] += share;
      sum += share;
    }
    total += sum / 60.0;
    for (std::size_t i = 0; i < last.size(); ++i) largest = std::max(largest, std::abs(now[i] - last[i]));
    last = now;
  }
  return largest / total;
}

TEST(SplatterShare, HardSilhouettesPopSoftOnesDoNot) {
  // A row of edges round a cylinder of 24 sides that turns by 3 degrees a frame: the outline's share of one edge.
  const auto jump = [](float width) {
    double most = 0.0, last = -1.0;
    for (int frame = 0; frame < 120; ++frame) {
      const double turn = glm::radians(3.0 * frame), side = glm::radians(15.0);
      double share = outline_share(float(std::cos(turn)), float(std::cos(turn + side)), width);
      if (last >= 0.0) most = std::max(most, std::abs(share - last));
      last = share;
    }
    return most;
  };
  EXPECT_EQ(jump(0.0f), 1.0);  // as printed: there or not
  EXPECT_LT(jump(0.12f), 0.5);
  // From a face that looks here to one that looks away the shares sum to 1, however many edges lie between.
  for (const float width : {0.0f, 0.05f, 0.12f})
    for (int sides = 3; sides < 40; ++sides) {
      double sum = 0.0;
      for (int i = 0; i < sides; ++i)
        sum += outline_share(std::cos(3.14159265f * float(i) / float(sides)),
                             std::cos(3.14159265f * float(i + 1) / float(sides)), width);
      EXPECT_NEAR(sum, 1.0, 1e-5);
    }
}

TEST_F(Splatter, HardSilhouettesPop) {
  auto s = body_in_rain(50.0f);
  const double hard = largest_jump(*s, true), soft = largest_jump(*s, false);
  EXPECT_LT(soft, 0.8 * hard);
  EXPECT_LT(soft, 0.5);
}

TEST_F(Splatter, NothingUnderAnAwning) {
  auto s = body_in_rain(50.0f, true);
  look(s->frame.camera, {0.6f, 1.6f, 4.5f}, {0.0f, 1.1f, 0.0f}, 45.0f);
  for (const HaloRung rung : {HaloRung::layer, HaloRung::fins}) {
    s->frame.techniques.set(Effect::halos, rung);
    EXPECT_GT(sum_of(picture(*s)), 0.0);
  }
  s->add(box_model({5.0f, 0.05f, 5.0f}, 3.0f), glm::mat4(1.0f), false);
  for (const HaloRung rung : {HaloRung::layer, HaloRung::fins}) {
    s->frame.techniques.set(Effect::halos, rung);
    EXPECT_EQ(sum_of(picture(*s)), 0.0);
  }
}

// The layer is bounded by its own chord: no eye inside it sees more than the droplets there are.
TEST_F(Splatter, AnEyeInsideTheMistSeesOnlyAVeil) {
  auto s = body_in_rain(50.0f);
  s->frame.techniques.set(Effect::splatter, SplatterRung::none);
  s->frame.lights.clear();
  s->frame.sky.zenith_cd_m2 = s->frame.sky.horizon_cd_m2 = glm::vec3(1.0f);
  for (const HaloRung rung : {HaloRung::layer, HaloRung::fins})
    for (const float height : {1.41f, 1.43f, 1.45f, 1.5f}) {
      s->frame.techniques.set(Effect::halos, rung);
      look(s->frame.camera, {0.0f, height, 1.2f}, {0.0f, height, -5.0f}, 60.0f);
      for (const float l : picture(*s)) {
        ASSERT_TRUE(std::isfinite(l));
        if (l == 1.0f) continue;  // alpha
        // 4 m of 0.05 per metre, and the deviation of the texture.
        ASSERT_LT(l, 0.4f) << height;
      }
    }
}

TEST_F(Splatter, AStepOfTheRateIsAStepOfTheMistNoMore) {
  float last = splash_mist(still_rain(1.0f)).column();
  for (float rate = 1.0f; rate < 100.0f; rate *= 1.02f) {
    const float column = splash_mist(still_rain(rate)).column();
    EXPECT_GE(column, 0.999f * last);
    EXPECT_LT(column, 1.08f * last) << rate;
    last = column;
  }
}

TEST_F(Splatter, SameBytesInAnyOrder) {
  auto s = body_in_rain(50.0f);
  look(s->frame.camera, {0.6f, 2.0f, 2.5f}, {0.0f, 1.1f, 0.0f}, 45.0f);
  const auto at = [&](double time) {
    s->frame.time_s = time;
    return picture(*s);
  };
  const std::vector<float> first = at(15.0);
  at(3.0);
  at(1000.5);
  EXPECT_EQ(first, at(15.0));
  auto other = body_in_rain(50.0f);
  other->frame.camera = s->frame.camera;
  other->frame.time_s = 15.0;
  EXPECT_EQ(first, picture(*other));
}

}  // namespace
}  // namespace petrichor
