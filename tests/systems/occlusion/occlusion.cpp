#include "systems/occlusion/occlusion.hpp"

#include <embree3/rtcore.h>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/engine/platform/gl_test.hpp"
#include "tests/systems/geometry/stage.hpp"

namespace petrichor::test {
namespace {

constexpr float map_side_m = 64.0f;
constexpr int map_texels = 1024;

// The truth: rays.
class Rays {
 public:
  explicit Rays(const Model& model) : device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    for (const Mesh& mesh : model.meshes) {
      for (const Primitive& p : mesh.primitives) {
        RTCGeometry g = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* v = static_cast<glm::vec3*>(
            rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, p.vertices.size()));
        for (std::size_t i = 0; i < p.vertices.size(); ++i) v[i] = p.vertices[i].position_m;
        auto* t = static_cast<std::uint32_t*>(
            rtcSetNewGeometryBuffer(g, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, p.indices.size() / 3));
        std::copy(p.indices.begin(), p.indices.end(), t);
        rtcCommitGeometry(g);
        rtcAttachGeometry(scene_, g);
        rtcReleaseGeometry(g);
      }
    }
    rtcCommitScene(scene_);
  }
  ~Rays() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  // Metres to the first hit, or infinity.
  float distance(glm::vec3 from, glm::vec3 way) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit ray{};
    ray.ray.org_x = from.x, ray.ray.org_y = from.y, ray.ray.org_z = from.z;
    ray.ray.dir_x = way.x, ray.ray.dir_y = way.y, ray.ray.dir_z = way.z;
    ray.ray.tfar = INFINITY;
    ray.ray.mask = ~0u;
    ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene_, &context, &ray);
    return ray.hit.geomID == RTC_INVALID_GEOMETRY_ID ? INFINITY : ray.ray.tfar;
  }

 private:
  RTCDevice device_;
  RTCScene scene_;
};

// A street: ground, a house with an awning, a bus shelter with a glass roof, a lantern's arm, a deep gallery.
Model street() {
  Model model;
  model.materials = {coloured({0.5f, 0.5f, 0.5f}), coloured({0.8f, 0.9f, 1.0f})};
  model.materials[1].alpha_mode = AlphaMode::blend;
  model.materials[1].base_colour.a = 0.1f;
  const auto put = [&](glm::vec3 low, glm::vec3 high, int material) {
    model.meshes.push_back({"part", {box(low, high, material)}});
  };
  put({-40, -1, -40}, {40, 0, 40}, 0);
  put({-12, 0, -14}, {12, 9, -6}, 0);        // house
  put({-4, 2.6f, -6}, {4, 2.7f, -4.2f}, 0);  // awning
  put({5, 2.2f, 2}, {9, 2.22f, 4}, 1);       // glass roof on
  put({5, 0, 2}, {5.1f, 2.2f, 2.1f}, 0);     // a post
  put({-8, 5, 3}, {-5, 5.1f, 3.12f}, 0);     // arm
  put({-12, 3, 6}, {-4, 3.3f, 12}, 0);       // gallery
  put({-12, 0, 12}, {-4, 3, 12.3f}, 0);
  return model;
}

struct Answer {
  float first_hit_m;
  bool sheltered;
};

class Occlusion : public test::GlTest {
 protected:
  void SetUp() override {
    test::GlTest::SetUp();
    if (IsSkipped()) return;
    model_ = street();
    auto offers = occlusion_passes();
    PassOffer ask;
    ask.name = "ask";
    ask.slots = {{"occlusion_map", SlotAccess::read}};
    ask.shaders = {{"ask", {{"tests/systems/occlusion/ask.comp.glsl"}, {}}}};
    ask.side_effect = true;
    ask.execute = [this](PassContext& context) {
      glMemoryBarrier(GL_ALL_BARRIER_BITS);
      context.bind_texture(OCCLUSION_UNIT, "occlusion_map");
      map_ = context.texture("occlusion_map").id;
      if (places_.empty()) return;
      Buffer buffer = make_buffer(places_.size() * 16, places_.data());
      glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 7, buffer.id);
      context.program("ask").use();
      context.program("ask").dispatch(static_cast<int>(places_.size()));
      std::vector<glm::vec4> got(places_.size());
      read_buffer(buffer, got.data(), got.size() * 16);
      answers_.clear();
      for (const glm::vec4& g : got) answers_.push_back({g.x, g.y > 0.5f});
    };
    offers.push_back(ask);
    const auto table = nlohmann::json::parse(R"({
      "resources": {"occlusion_map": {"format": "depth32f", "width": 1024, "height": 1024, "layers": 1, "persistent": true},
                    "picture": {"format": "rgba8"}},
      "passes": [{"pass": "occlusion_map", "occlusion_map": "occlusion_map", "parameters": {"side_m": 64}},
                 {"pass": "ask", "occlusion_map": "occlusion_map"},
                 {"pass": "blank", "picture": "picture"}],
      "output": "picture"})");
    offers.push_back({"blank", "", {{"picture", SlotAccess::write}}, {}, {}, {}, [](PassContext&) {}});
    stage_ = std::make_unique<Stage>(std::move(offers), std::vector<std::string>{}, table);
    stage_->scene.add(model_);
    for (std::uint32_t i = 0; i < model_.meshes.size(); ++i) {
      stage_->frame.instances.push_back({0, i, false, glm::mat4(1.0f)});  // shelter asks not who casts shadows
    }
    stage_->frame.camera.position_m = {1.3, 1.7, 0.4};
    stage_->frame.rain = FrameRain{};
    stage_->frame.rain->rain_mm_per_hour = 10.0f;
  }

  void ask(const std::vector<glm::vec3>& world, glm::vec3 velocity) {
    places_.clear();
    for (const glm::vec3& p : world) {
      places_.push_back(glm::vec4(p - glm::vec3(stage_->frame.camera.position_m), 0.0f));
    }
    stage_->frame.rain->mean_velocity_mps = velocity;
    stage_->draw();
    ASSERT_EQ(answers_.size(), world.size());
  }

  Model model_;
  std::unique_ptr<Stage> stage_;
  std::vector<glm::vec4> places_;
  std::vector<Answer> answers_;
  GLuint map_ = 0;
};

std::vector<glm::vec3> random_places(int count) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  std::vector<glm::vec3> places;
  for (int i = 0; i < count; ++i) {
    // Half of them where people walk, just over the ground; half in the air.
    const float height = i % 2 ? 0.05f : 0.05f + 6.0f * unit(random);
    const glm::vec3 p(-16 + 32 * unit(random), height, -16 + 32 * unit(random));
    const bool in_house = std::abs(p.x) < 12 && p.z > -14 && p.z < -6;
    if (!in_house) places.push_back(p);
  }
  return places;
}

// Errors are allowed within a texel, the lattice's tilt and the bias of a shelter's edge, and nowhere else.
TEST_F(Occlusion, AgreesWithRaysUnderTiltedRain) {
  const Rays rays(model_);
  const std::vector<glm::vec3> places = random_places(20000);
  const float texel = map_side_m / map_texels;
  for (const float wind : {0.0f, 2.0f, 4.5f, 9.0f}) {
    const glm::vec3 velocity(0.6f * wind, -6.5f, -0.8f * wind);
    const glm::vec3 fall = glm::normalize(velocity);
    ask(places, velocity);
    int wrong = 0, inexcusable = 0, sheltered = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const bool truth = rays.distance(places[i], -fall) < INFINITY;
      sheltered += truth;
      if (truth == answers_[i].sheltered) continue;
      ++wrong;
      const float up_m = 10.0f;  // the highest shelter over a place
      const float reach = 1.5f * texel + std::tan(glm::radians(0.5f)) * up_m / -fall.y;
      bool near_edge = false;
      for (int k = 0; k < 16 && !near_edge; ++k) {
        const float a = 0.3926991f * static_cast<float>(k);
        for (const float r : {0.5f * reach, reach}) {
          for (const float down : {-0.08f, 0.0f, 0.08f}) {
            const glm::vec3 q = places[i] + glm::vec3(r * std::cos(a), 0, r * std::sin(a)) + down * fall;
            near_edge |= (rays.distance(q, -fall) < INFINITY) != truth;
          }
        }
      }
      inexcusable += !near_edge;
    }
    const double share = static_cast<double>(wrong) / static_cast<double>(places.size());
    RecordProperty("misjudged_percent_at_wind_" + std::to_string(static_cast<int>(10 * wind)),
                   std::to_string(100 * share));
    std::printf("wind %.1f m/s: %.2f%% of %zu places misjudged, %.1f%% sheltered\n", static_cast<double>(wind),
                100 * share, places.size(), 100.0 * sheltered / static_cast<double>(places.size()));
    EXPECT_EQ(inexcusable, 0) << wind;
    EXPECT_GT(sheltered, 500) << wind;
    // About 60 m of edges over 800 m2 of ground, half a texel and half the lattice's tilt on average.
    EXPECT_LT(share, 0.01) << wind;
  }
}

TEST_F(Occlusion, FirstHitIsWhereTheRayLands) {
  const Rays rays(model_);
  const std::vector<glm::vec3> places = random_places(8000);
  const glm::vec3 velocity(2.5f, -6.5f, 1.0f);
  // The map's own direction, so that what is left is its sampling alone.
  const glm::vec3 fall = lattice_direction(velocity, glm::radians(0.5f));
  ask(places, velocity);
  const float texel = map_side_m / map_texels;
  const float steep = std::sqrt(1 - fall.y * fall.y) / -fall.y;
  int compared = 0, far = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (rays.distance(places[i], -fall) < INFINITY) continue;
    const float truth = rays.distance(places[i], fall);
    ++compared;
    // Half a texel's diagonal along level ground, seen along the slope.
    far += std::abs(answers_[i].first_hit_m - truth) > 0.71f * texel * steep / -fall.y + 0.002f;
  }
  EXPECT_GT(compared, 4000);
  // Edges and walls, where one texel sees two heights.
  EXPECT_LT(far, compared / 50);
}

TEST_F(Occlusion, DepthUnderAnAwningIsTheFallSinceTheImpact) {
  ask({{0, 1.0f, -5}, {0, 2.69f, -5}, {7, 1.2f, 3}}, {0, -5, 0});
  EXPECT_TRUE(answers_[0].sheltered);
  EXPECT_NEAR(answers_[0].first_hit_m, -1.7f, 1e-3f);
  EXPECT_FALSE(answers_[1].sheltered) << "a place a centimetre under the surface is on it";
  EXPECT_TRUE(answers_[2].sheltered) << "glass shelters too";
  EXPECT_NEAR(answers_[2].first_hit_m, -1.02f, 1e-3f);
}

TEST_F(Occlusion, TheGroundDoesNotShelterItself) {
  std::vector<glm::vec3> places;
  for (const glm::vec3& p : random_places(4000)) places.push_back({p.x, 0.0f, p.z});
  const glm::vec3 velocity(4.0f, -5.0f, 3.0f);  // 45 degrees
  const Rays rays(model_);
  ask(places, velocity);
  int wrong = 0, open = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (rays.distance(places[i] + glm::vec3(0, 0.05f, 0), -glm::normalize(velocity)) < INFINITY) continue;
    ++open;
    wrong += answers_[i].sheltered;
  }
  EXPECT_GT(open, 1000);
  EXPECT_LT(wrong, open / 50);  // beside edges only
}

TEST_F(Occlusion, IsDrawnAgainOnlyWhenSomethingMoved) {
  const glm::vec3 place(0, 1.0f, -5);  // under the awning
  ask({place}, {0, -5, 0});
  ASSERT_TRUE(answers_[0].sheltered);
  const auto wiped = [&] {  // an empty map: stays empty for as long as the pass leaves it alone
    const float zero = 0.0f;
    glClearTexImage(map_, 0, GL_DEPTH_COMPONENT, GL_FLOAT, &zero);
    ask({place}, stage_->frame.rain->mean_velocity_mps);
    return !answers_[0].sheltered;
  };
  EXPECT_TRUE(wiped()) << "redrawn although nothing changed";
  stage_->frame.camera.position_m += glm::dvec3(0.3, 0.1, 0.2);
  EXPECT_TRUE(wiped()) << "redrawn for a small step";
  stage_->frame.rain->mean_velocity_mps = {0.02f, -5, 0};
  EXPECT_TRUE(wiped()) << "redrawn for a slight gust";
  stage_->frame.rain->mean_velocity_mps = {0.5f, -5, 0};
  EXPECT_FALSE(wiped()) << "kept in spite of the wind";
  stage_->frame.geometry_version = 9;
  EXPECT_FALSE(wiped()) << "kept in spite of new geometry";
  stage_->frame.camera.position_m += glm::dvec3(14, 0, 0);
  EXPECT_FALSE(wiped()) << "kept in spite of a walk";
  EXPECT_TRUE(wiped());
}

// Frames 100 to 110 must be the same bytes whether or not frames 0 to 99 came before.
TEST_F(Occlusion, TheMapIsTheSameWhicheverFrameDrewIt) {
  const auto texels = [&] {
    std::vector<float> all(static_cast<std::size_t>(map_texels * map_texels));
    glGetTextureImage(map_, 0, GL_DEPTH_COMPONENT, GL_FLOAT, static_cast<GLsizei>(all.size() * 4), all.data());
    return all;
  };
  ask({{0, 1, 0}}, {1.7f, -6.1f, 0.9f});
  const std::vector<float> first = texels();
  for (const glm::dvec3 step : {glm::dvec3(0.31, 0.07, 0.13), glm::dvec3(-0.6, 0.5, 0.77)}) {
    stage_->frame.camera.position_m += step;
    ++stage_->frame.geometry_version;  // the content is the same, but the pass does not know
    ask({{0, 1, 0}}, {1.7f, -6.1f, 0.9f});
    EXPECT_EQ(texels(), first);
  }
}

TEST_F(Occlusion, RunsOnlyInRain) {
  stage_->frame.rain->rain_mm_per_hour = 0.0f;
  stage_->draw();
  for (const PassReport& report : stage_->graph->report()) {
    if (report.name == "occlusion_map") {
      EXPECT_TRUE(report.culled);
    }
  }
}

TEST(OcclusionPlacement, DirectionsLieOnALatticeWithinTheTolerance) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(-1.0f, 1.0f);
  const float tolerance = glm::radians(0.5f);
  for (int i = 0; i < 2000; ++i) {
    const glm::vec3 fall = glm::normalize(glm::vec3(1.5f * unit(random), -1.0f, 1.5f * unit(random)));
    const glm::vec3 held = lattice_direction(fall * 7.0f, tolerance);
    EXPECT_NEAR(glm::length(held), 1.0f, 1e-6f);
    EXPECT_LE(std::acos(std::min(glm::dot(fall, held), 1.0f)), tolerance * 1.02f + 5e-4f);
    EXPECT_LT(glm::distance(lattice_direction(held, tolerance), held), 1e-5f);
  }
  EXPECT_EQ(lattice_direction({0, -8, 0}, tolerance), glm::vec3(0, -1, 0));
  EXPECT_EQ(lattice_direction({0.01f, -8, 0}, tolerance), glm::vec3(0, -1, 0));
  EXPECT_EQ(lattice_direction({0, 0, 0}, tolerance), glm::vec3(0, -1, 0));
}

TEST(OcclusionPlacement, StaysPutWhileTheCameraMovesALittle) {
  const glm::vec3 fall = glm::normalize(glm::vec3(0.3f, -1.0f, 0.1f));
  const glm::dvec3 scene_low(-60, -1, -60), scene_high(60, 20, 60);
  const auto at = [&](glm::dvec3 camera) {
    return place_occlusion_map(camera, fall, 128.0f, 1024, 16.0f, glm::vec3(scene_low - camera),
                               glm::vec3(scene_high - camera));
  };
  int changes = 0;
  OcclusionPlacement last = at({0, 1.7, 0});
  for (int i = 1; i <= 600; ++i) {  // 30 m
    const glm::dvec3 camera(0.05 * i, 1.7, 0);
    const OcclusionPlacement now = at(camera);
    changes += !(now == last);
    last = now;
    // The camera is never nearer than 48 m to the map's edge, and the whole scene lies between the ends.
    const glm::mat4 m = occlusion_matrix(now, camera);
    for (int axis = 0; axis < 2; ++axis) EXPECT_NEAR(m[3][axis], 0.5f, 8.001f / 128.0f);
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 c(corner & 1 ? scene_low.x : scene_high.x, corner & 2 ? scene_low.y : scene_high.y,
                         corner & 4 ? scene_low.z : scene_high.z);
      const float z = (m * glm::vec4(glm::vec3(c - camera), 1.0f)).z;
      EXPECT_GT(z, 0.0f);
      EXPECT_LT(z, now.depth_m);
    }
  }
  EXPECT_LE(changes, 3);
  EXPECT_GE(changes, 1);
}

}  // namespace
}  // namespace petrichor::test
