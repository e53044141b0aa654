// The project's own scripts run, and say what they should.

#include <unistd.h>

#include "tests/engine/script/fixture.hpp"

namespace petrichor {
namespace {

const std::filesystem::path scripts = std::filesystem::path(PETRICHOR_SOURCE_DIR) / "scripts";

class OwnScripts : public ScriptTest {
 protected:
  OwnScripts() {
    options.roots = {scripts};
    options.arguments = {{"model", "some/model.glb"}};
    // A town of two nodes; what the scripts ask of the real one is tested where it is loaded.
    options.services.load_model = [this](const std::filesystem::path& path) -> Result<std::vector<Entity>> {
      loaded.push_back(path);
      const Entity start = registry.create();
      registry.emplace<Name>(start, Name{"walker_start"});
      registry.emplace<Transform>(start).position_m = {-0.8f, 0.1f, 22.0f};
      const Entity view = registry.create();
      registry.emplace<Name>(view, Name{"view_crossing"});
      registry.emplace<Transform>(view);
      registry.emplace<Camera>(view).active = false;
      if (with_light) registry.emplace<Light>(view);
      return std::vector<Entity>{start, view};
    };
    options.services.bounds = [this](std::span<const Entity>) -> Result<std::pair<glm::vec3, glm::vec3>> {
      if (!with_bounds) return failure("nothing is drawn");
      return std::pair{low, high};
    };
  }
  void run_script(const std::string& name) {
    const auto ran = host().run_file(scripts / name);
    ASSERT_TRUE(ran) << ran.error().message;
  }
  void advance(double time_s) {
    const auto result = host().advance(time_s);
    ASSERT_TRUE(result) << result.error().message;
  }
  template <class T>
  T& the() {
    T* found = nullptr;
    registry.view<T>().each([&](Entity, T& t) { found = &t; });
    EXPECT_TRUE(found);
    return *found;
  }
  std::pair<Transform, Camera> active_camera() {
    std::pair<Transform, Camera> out;
    int count = 0;
    registry.view<Transform, Camera>().each([&](Entity, Transform& t, Camera& c) {
      if (c.active) out = {t, c}, ++count;
    });
    EXPECT_EQ(count, 1);
    return out;
  }

  Entity active_camera_entity() {
    Entity found;
    registry.view<Camera>().each([&](Entity e, Camera& c) {
      if (c.active) found = e;
    });
    return found;
  }

  std::vector<std::filesystem::path> loaded;
  bool with_light = false, with_bounds = true;
  glm::vec3 low{-2, 0, -2}, high{2, 3, 2};
};

TEST_F(OwnScripts, FirstRainRises) {
  run_script("cinematics/first_rain.lua");
  EXPECT_EQ(host().duration_s(), 10.0);
  EXPECT_EQ(host().cinematic().fps, 24.0);
  EXPECT_EQ(host().cinematic().size_px, glm::ivec2(640, 360));
  EXPECT_EQ(loaded, std::vector<std::filesystem::path>{"content/city.glb"});
  advance(0.0);
  EXPECT_LT(the<Emitter>().rain_mm_per_hour, 2.0f);
  glm::vec3 before = active_camera().first.position_m;
  float most = 0.0f;
  for (int frame = 1; frame <= 240; ++frame) {
    advance(frame / 24.0);
    const auto [transform, camera] = active_camera();
    // A walk: no leaps, on the carriageway, at the height of eyes, and always towards the toy shop.
    EXPECT_LT(glm::length(transform.position_m - before) * 24.0f, 2.5f) << frame;
    EXPECT_LT(std::abs(transform.position_m.x), 5.0f);
    EXPECT_NEAR(transform.position_m.y, 1.65f, 0.1f);
    EXPECT_LT((transform.orientation * glm::vec3(0, 0, -1)).z, -0.5f);
    before = transform.position_m;
    most = std::max(most, the<Emitter>().rain_mm_per_hour);
  }
  EXPECT_NEAR(the<Emitter>().rain_mm_per_hour, 42.0f, 1.0f);
  EXPECT_EQ(most, 42.0f);
  advance(30.0);
  EXPECT_FALSE(host().busy());
}

TEST_F(OwnScripts, TheSandboxChangesItsWeather) {
  run_script("sandbox.lua");
  advance(0.0);
  EXPECT_NEAR(active_camera().first.position_m.y, 1.8f, 1e-5f);
  EXPECT_EQ(registry.size<Walker>(), 1u);
  double now_s = 0.0;
  for (const auto& [key, least, most] : {std::tuple{"key:1", 0.2f, 2.0f},
                                         {"key:2", 4.0f, 15.0f},
                                         {"key:3", 30.0f, 100.0f},
                                         {"key:4", 0.0f, 0.0f},
                                         {"weather:downpour", 30.0f, 100.0f}}) {
    host().emit(key);
    advance(now_s += 0.1);
    advance(now_s += 10.0);
    EXPECT_GE(the<Emitter>().rain_mm_per_hour, least) << key;
    EXPECT_LE(the<Emitter>().rain_mm_per_hour, most) << key;
    EXPECT_FALSE(host().busy());
  }
}

TEST_F(OwnScripts, ModelsAreFramedAndLit) {
  run_script("scenes/model.lua");
  EXPECT_EQ(loaded, std::vector<std::filesystem::path>{"some/model.glb"});
  EXPECT_EQ(the<Emitter>().rain_mm_per_hour, 20.0f);
  EXPECT_EQ(registry.size<Light>(), 3u);
  made.reset();
  registry.clear();
  with_light = true;
  run_script("scenes/model.lua");
  EXPECT_EQ(registry.size<Light>(), 2u);  // its own and the moon
}

TEST_F(OwnScripts, TheWholeModelIsInThePicture) {
  for (const auto& [a, b] : {std::pair{glm::vec3(-2, 0, -2), glm::vec3(2, 3, 2)},
                             {glm::vec3(-60, -1, -60), glm::vec3(60, 25, 60)},
                             {glm::vec3(0.001f), glm::vec3(0.002f)},
                             {glm::vec3(-1, 0, 0), glm::vec3(1, 0, 0)},
                             {glm::vec3(500, 0, 0), glm::vec3(500, 40, 3)},
                             {glm::vec3(1, 2, 3), glm::vec3(1, 2, 3)}}) {
    made.reset();
    registry.clear();
    low = a;
    high = b;
    run_script("scenes/model.lua");
    const auto [transform, camera] = active_camera();
    const float tan_y = std::tan(glm::radians(camera.vertical_fov_deg) / 2);
    float widest = 0.0f;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::vec3 p(corner & 1 ? b.x : a.x, corner & 2 ? b.y : a.y, corner & 4 ? b.z : a.z);
      const glm::vec3 seen = glm::inverse(transform.orientation) * (p - transform.position_m);
      ASSERT_LT(seen.z, 0.0f);
      widest = std::max({widest, std::abs(seen.y / seen.z) / tan_y, std::abs(seen.x / seen.z) / (tan_y * 16 / 9)});
    }
    EXPECT_LE(widest, 1.0f);
    if (a != b) {
      EXPECT_GT(widest, 0.85f);  // and fills it
    }
    // The walker would not turn the camera away: its angles say the same as the rotation.
    const Walker& walker = the<Walker>();
    const glm::quat looks = glm::angleAxis(glm::radians(-walker.yaw_deg), glm::vec3(0, 1, 0)) *
                            glm::angleAxis(glm::radians(walker.pitch_deg), glm::vec3(1, 0, 0));
    EXPECT_LT(glm::length(looks * glm::vec3(0, 0, -1) - transform.orientation * glm::vec3(0, 0, -1)), 1e-3f);
  }
}

TEST_F(OwnScripts, AModelThatDrawsNothingStillHasAPicture) {
  with_bounds = false;
  run_script("scenes/model.lua");
  active_camera();
}

TEST_F(OwnScripts, EmptyRainIsNothingButRain) {
  run_script("scenes/empty_rain.lua");
  advance(0.0);
  EXPECT_EQ(registry.size<MeshInstance>(), 0u);
  EXPECT_GT(the<Emitter>().rain_mm_per_hour, 0.0f);
  active_camera();
}

TEST_F(OwnScripts, TheCityIsAPictureByItself) {
  run_script("scenes/city.lua");
  EXPECT_EQ(registry.get<Name>(active_camera_entity()).text, "view_crossing");
}

TEST_F(OwnScripts, EveryPresetIsWeather) {
  for (const auto& entry : std::filesystem::directory_iterator(scripts / "weather")) {
    const auto preset = read_table(entry.path(), options);
    ASSERT_TRUE(preset) << preset.error().message;
    for (const auto& [component, fields] : preset->items()) {
      const Schema* schema = find_schema(component_schemas(), component);
      ASSERT_TRUE(schema) << entry.path() << component;
      Registry scratch;
      const auto written = write_fields(*schema, schema->emplace(scratch, scratch.create()), fields);
      EXPECT_TRUE(written) << written.error().message;
    }
    EXPECT_TRUE(preset->contains("emitter") && preset->contains("wind") && preset->contains("fog")) << entry.path();
  }
}

}  // namespace
}  // namespace petrichor
