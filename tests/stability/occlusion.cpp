// Where shelter by maps could break: each test provokes one failure.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "systems/occlusion/chart.hpp"
#include "systems/occlusion/stage.hpp"
#include "systems/occlusion/street.hpp"
#include "systems/rainfall/extract.hpp"
#include "tests/engine/platform/gl_test.hpp"

namespace petrichor {
namespace {

FrameRain rain_at(const Emitter& emitter, const Wind& wind, double time_s) {
  return make_frame_rain(emitter, start_rain_motion(emitter, wind), {}, 1, 1, time_s);
}

class OcclusionStability : public test::GlTest {
 protected:
  void SetUp() override {
    test::GlTest::SetUp();
    if (IsSkipped()) return;
    emitter.rain_mm_per_hour = 10.0f;
    stage = std::make_unique<OcclusionStage>();
  }
  void TearDown() override {
    stage.reset();
    test::GlTest::TearDown();
  }
  void use(OcclusionRung rung, float wind_mps, bool gusts, std::map<std::string, double> parameters = {}) {
    if (rung == OcclusionRung::jittered) parameters["maps"] = 8;
    const auto loaded = stage->load(1024, rung == OcclusionRung::jittered ? 8 : 1, parameters);
    ASSERT_TRUE(loaded) << loaded.error().message;
    stage->frame.techniques.set(Effect::occlusion, rung);
    blow(wind_mps, gusts);
  }
  void blow(float wind_mps, bool gusts) {
    wind = {};
    wind.velocity_mps = {wind_mps, 0, 0};
    if (gusts) wind.gust_mps = 0.3f * wind_mps, wind.swirl_mps = 0.15f * wind_mps;
    stage->frame.wind = wind;
    stage->frame.rain = rain_at(emitter, wind, 3.0);
  }
  std::vector<ShelterAnswer> ask(const std::vector<ShelterQuestion>& questions) {
    auto answers = stage->ask(questions);
    EXPECT_TRUE(answers) << (answers ? "" : answers.error().message);
    return answers ? *answers : std::vector<ShelterAnswer>(questions.size());
  }
  double error(const std::vector<ShelterQuestion>& places) {
    const auto answers = ask(places);
    const ShelterRays rays = stage->rays();
    const auto falls = falls_over_time(rain_at, emitter, wind, wind.gust_mps > 0.0f ? 12 : 1);
    double sum = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      double kept = 0.0;
      for (const FallTruth& f : falls)
        kept += rays.sheltered(places[i].place_m, f.velocity_mps) ? double(f.water) : 0.0;
      sum += std::pow(static_cast<double>(answers[i].shelter) - kept, 2);
    }
    return std::sqrt(sum / static_cast<double>(places.size()));
  }

  std::unique_ptr<OcclusionStage> stage;
  Emitter emitter;
  Wind wind;
};

// Chen's map looks straight down ("this method fails in situations where there are winds"): with the wind its error
// grows, that of the maps along the falls does not.
TEST_F(OcclusionStability, TheVerticalMapFailsAsTheWindRises) {
  stage->add_placed(shelter_street());
  const auto places = shelter_places("awning", 0.45f);
  double vertical = 0.0;
  for (const float speed : {0.0f, 1.0f, 2.0f, 3.0f, 4.0f, 5.0f}) {
    use(OcclusionRung::vertical, speed, true);
    const double now = error(places);
    EXPECT_GE(now, vertical - 0.01) << speed;
    vertical = now;
    use(OcclusionRung::jittered, speed, true);
    const double mended = error(places);
    EXPECT_LT(mended, 0.1) << speed;
    // In still air there is nothing to mend.
    if (speed == 0.0f) {
      EXPECT_LT(vertical, 0.1);
    }
  }
  EXPECT_GT(vertical, 0.3);
}

// A map that is kept must not keep the shadow of what has gone.
TEST_F(OcclusionStability, AMovingOccluderTakesItsShelterAlong) {
  const auto model = shelter_street();
  const std::uint32_t index = stage->add(model);
  stage->frame.instances.push_back({index, 0, true, glm::mat4(1.0f)});  // the ground
  stage->frame.instances.push_back({index, 1, true, glm::mat4(1.0f)});  // the roof, 4 x 8 m
  use(OcclusionRung::jittered, 3.0f, true);
  std::vector<ShelterQuestion> line;
  for (int i = 0; i < 400; ++i) line.push_back({{-8.0f + 0.1f * static_cast<float>(i), 0.0f, 0.2f}});
  for (int step = 0; step < 20; ++step) {
    const float moved = 1.1f * static_cast<float>(step);
    stage->frame.instances[1].matrix = glm::translate(glm::mat4(1.0f), {moved, 0, 0});
    ++stage->frame.geometry_version;
    const auto answers = ask(line);
    double middle = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < line.size(); ++i)
      middle += static_cast<double>(answers[i].shelter * line[i].place_m.x),
          sum += static_cast<double>(answers[i].shelter);
    double truth = 0.0;  // the middle of what all drops are kept from
    for (const FallTruth& f : falls_over_time(rain_at, emitter, wind, 12))
      truth += static_cast<double>(f.water * 3.05f * f.velocity_mps.x / -f.velocity_mps.y);
    EXPECT_NEAR(middle / sum, truth + static_cast<double>(moved), 0.15) << step;
    EXPECT_NEAR(0.1 * sum, 4.0, 0.4) << "the roof's own width " << step;
  }
}

// Chen compares depths as they are: a slope's own texels shelter it, in stripes. Bias and offset end it.
TEST_F(OcclusionStability, GrazedSlopesAreStripedWithoutBias) {
  auto model = std::make_shared<Model>();
  model->materials.resize(1);
  std::vector<ShelterQuestion> places;
  constexpr int slopes = 10;
  for (int k = 0; k < slopes; ++k) {  // planes of 10 x 10 m, 5 to 86 degrees steep, facing the wind or away
    const float angle = glm::radians(5.0f + 9.0f * static_cast<float>(k)), z = -48.0f + 10.0f * static_cast<float>(k);
    const glm::vec3 u(-10.0f * std::cos(angle), 10.0f * std::sin(angle), 0), v(0, 0, 8), corner(k % 2 ? 20 : -20, 1, z);
    const glm::vec3 along = k % 2 ? u : glm::vec3(-u.x, u.y, 0);
    Primitive p;
    for (const glm::vec3& at : {corner, corner + v, corner + along + v, corner + along}) {
      Vertex vertex;
      vertex.position_m = at;
      p.vertices.push_back(vertex);
    }
    p.indices = {0, 1, 2, 0, 2, 3};
    p.material = 0;
    p.bounds_min_m = glm::min(corner, corner + along + v);
    p.bounds_max_m = glm::max(corner, corner + along + v);
    model->meshes.push_back({"slope", {p}});
    glm::vec3 normal = glm::normalize(glm::cross(v, along));
    if (normal.y < 0.0f) normal = -normal;
    for (int i = 0; i < 400; ++i) {
      const float a = 0.05f + 0.9f * std::fmod(0.618034f * static_cast<float>(i), 1.0f);
      const float b = 0.05f + 0.9f * static_cast<float>(i) / 400.0f;
      places.push_back({corner + a * along + b * v, normal});
    }
  }
  stage->add_placed(model);
  const auto striped = [&](bool with_normal) {
    const auto answers = ask(places);
    const ShelterRays rays = stage->rays();
    const auto falls = falls_over_time(rain_at, emitter, wind, 1);
    double wrong = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      double kept = 0.0;
      for (const FallTruth& f : falls) {
        const bool behind = glm::dot(places[i].normal, f.velocity_mps) >= 0.0f;
        if (behind || rays.sheltered(places[i].place_m + 1e-3f * places[i].normal, f.velocity_mps))
          kept += static_cast<double>(f.water);
      }
      wrong += std::abs((with_normal ? answers[i].shelter_normal : answers[i].shelter) - kept);
    }
    return wrong / static_cast<double>(places.size());
  };
  use(OcclusionRung::vertical, 0.0f, false, {{"published", 1.0}});
  EXPECT_GT(striped(false), 0.3) << "half of a slope lies below its own texels";
  use(OcclusionRung::vertical, 0.0f, false);
  EXPECT_LT(striped(true), 0.005);
  use(OcclusionRung::jittered, 4.0f, false);
  EXPECT_LT(striped(true), 0.03);  // maps either side of a slope's own angle are some hundredths of the water
}

// A tilted map sees level ground as a slope of tan(tilt): half a texel of it is the least bias that keeps it wet, and
// what lies no deeper under a roof than the bias is taken for the roof.
TEST_F(OcclusionStability, TheBiasOfATiltedMapIsHalfATexelTimesTheTangent) {
  stage->add_placed(shelter_street());
  std::vector<ShelterQuestion> open;
  for (int i = 0; i < 4000; ++i) {
    open.push_back({{-50.0f + 20.0f * std::fmod(0.618034f * static_cast<float>(i), 1.0f), 0.0f,
                     -50.0f + 20.0f * static_cast<float>(i) / 4000.0f}});
  }
  const auto wet = [&] {
    const auto answers = ask(open);
    double kept = 0.0;
    for (const ShelterAnswer& a : answers) kept += static_cast<double>(a.shelter);
    return 1.0 - kept / static_cast<double>(open.size());
  };
  for (const float speed : {3.0f, 6.0f, 13.0f}) {
    use(OcclusionRung::tilted, speed, false, {{"published", 1.0}});
    EXPECT_LT(wet(), 0.75) << "published: the ground shelters itself at " << speed << " m/s";
    use(OcclusionRung::tilted, speed, false);
    EXPECT_EQ(wet(), 1.0) << speed;
    const glm::vec3 mean = stage->frame.rain->mean_velocity_mps;
    const float tangent = mean.x / -mean.y, bias_m = 0.02f + 0.71f * 0.125f * tangent;
    // Down the fall from the roof's top by less and by more than the bias and the texel's own error.
    const glm::vec3 roof(0.0f, awning_height_m + 0.1f, 0.0f), fall = glm::normalize(mean);
    const auto under = ask({{roof + 0.02f * fall}, {roof + 2.2f * bias_m * fall}});
    EXPECT_EQ(under[0].shelter, 0.0f) << speed;
    EXPECT_EQ(under[1].shelter, 1.0f) << speed;
  }
}

// Single drops under an awning: their own fall, not the mean of all, says who gets in.
TEST_F(OcclusionStability, OneTiltedMapLetsSmallDropsUnderAnAwning) {
  stage->add_placed(shelter_street());
  std::vector<ShelterQuestion> drops;
  const auto wrong = [&](float smallest_mm, float largest_mm) {
    drops.clear();
    for (const ShelterQuestion& q : shelter_places("awning", 0.4f))
      for (const RainClass& c : stage->frame.rain->classes)
        if (c.diameter_mm > smallest_mm && c.diameter_mm < largest_mm)
          drops.push_back({q.place_m + glm::vec3(0, 0.02f, 0), q.normal, c.velocity_mps});
    const auto answers = ask(drops);
    const ShelterRays rays = stage->rays();
    double count = 0.0;
    for (std::size_t i = 0; i < drops.size(); ++i)
      count += answers[i].sheltered_velocity != rays.sheltered(drops[i].place_m, drops[i].velocity_mps);
    return count / static_cast<double>(drops.size());
  };
  use(OcclusionRung::tilted, 5.0f, false);
  const double small_by_one = wrong(0.5f, 1.0f), large_by_one = wrong(2.0f, 6.0f);
  use(OcclusionRung::jittered, 5.0f, false);
  const double small = wrong(0.5f, 1.0f), large = wrong(2.0f, 6.0f);
  std::printf("misjudged, 0.5 to 1 mm: one map %.3f, eight %.3f; 2 to 6 mm: %.3f, %.3f\n", small_by_one, small,
              large_by_one, large);
  EXPECT_GT(small_by_one, 0.15);
  EXPECT_LT(small, 0.4 * small_by_one);
  EXPECT_LT(large, large_by_one);
}

}  // namespace
}  // namespace petrichor
