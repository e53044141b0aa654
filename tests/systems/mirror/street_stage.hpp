#pragma once
// The street of systems/mirror/street.hpp on its stage, for tests.

#include <memory>
#include <vector>

#include "engine/platform/context.hpp"
#include "systems/frame_gpu.hpp"
#include "systems/geometry/passes.hpp"
#include "systems/lighting/passes.hpp"
#include "systems/lighting/state.hpp"
#include "systems/mirror/camera.hpp"
#include "systems/mirror/extract.hpp"
#include "systems/mirror/mirror.hpp"
#include "systems/mirror/stage.hpp"
#include "systems/mirror/street.hpp"
#include "tests/engine/platform/gl_test.hpp"

namespace petrichor::test {

inline glm::quat facing(glm::vec3 eye, glm::vec3 at) {
  const glm::vec3 back = glm::normalize(eye - at);
  const glm::vec3 aside = std::abs(back.y) > 0.99f ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0);
  const glm::vec3 right = glm::normalize(glm::cross(aside, back));
  return glm::quat_cast(glm::mat3(right, glm::cross(back, right), back));
}

struct StreetStage {
  MirrorStreet street = make_mirror_street();
  std::shared_ptr<LightingState> state = std::make_shared<LightingState>();
  std::unique_ptr<MirrorStage> stage;
  std::vector<MirrorPane> panes;
  std::vector<FrameMirrors::Probe> probes;
  bool water = true;

  explicit StreetStage(double scale = 0.5, bool lit_picture = false) {
    std::vector<PassOffer> passes;
    for (auto some : {geometry_passes(), lighting_passes(state), mirror_passes()})
      passes.insert(passes.end(), some.begin(), some.end());
    auto made = MirrorStage::make(std::move(passes), true, scale, {{"software_share", 1.0}}, {}, lit_picture);
    EXPECT_TRUE(made) << (made ? "" : made.error().message);
    if (!made) return;
    stage = std::move(*made);
    Frame& f = stage->frame;
    f.width = 160;
    f.height = 90;
    f.sky = street.sky;
    f.camera.vertical_fov_rad = 0.9f;
    look({0.3f, 1.6f, 2.0f}, {0.2f, 0.6f, -8.0f});
  }
  void look(glm::vec3 eye, glm::vec3 at) {
    stage->frame.camera.position_m = eye;
    stage->frame.camera.orientation = facing(eye, at);
  }
  // Every box an instance whose entity is its number.
  void place(const std::vector<ShiningBox>& boxes) {
    const std::uint32_t model = stage->add(box_model(boxes));
    stage->frame.instances.clear();
    for (std::uint32_t i = 0; i < boxes.size(); ++i)
      stage->frame.instances.push_back({model, i, true, glm::mat4(1.0f), i});
    ++stage->frame.geometry_version;
  }
  void place() { place(street.boxes); }

  // frame.mirrors as the system fills it.
  void choose() {
    Frame& f = stage->frame;
    f.puddles.reset();
    if (water) {
      auto puddles = std::make_shared<FramePuddles>();
      puddles->puddles.push_back(street.puddle);
      f.puddles = puddles;
    }
    auto mirrors = std::make_shared<FrameMirrors>();
    mirrors->water = water_plane(f);
    mirrors->pane = pane_plane(f, panes);
    mirrors->probes = nearest_probes(f, probes);
    for (auto& p : mirrors->probes) std::sort(p.own.begin(), p.own.end());
    f.mirrors.reset();
    if (mirrors->water || mirrors->pane || !mirrors->probes.empty()) f.mirrors = mirrors;
  }
  std::vector<MirrorAnswer> ask(const std::vector<MirrorQuestion>& questions) {
    choose();
    auto answers = stage->ask(questions);
    EXPECT_TRUE(answers) << (answers ? "" : answers.error().message);
    return answers ? *answers : std::vector<MirrorAnswer>(questions.size());
  }
  std::vector<std::uint16_t> bytes(const char* resource) {
    ask({});
    return stage->texture(resource);
  }

  // What the eye sees of a plane's place: the question, with a normal that ripples may turn.
  MirrorQuestion seen(glm::vec3 place, glm::vec3 normal, float roughness = 0.02f) const {
    const glm::vec3 view = glm::normalize(place - glm::vec3(stage->frame.camera.position_m));
    return {place, normal, glm::reflect(view, normal), roughness};
  }
};

}  // namespace petrichor::test
