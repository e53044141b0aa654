#pragma once
// An edge in the rain, over a floor, for tests.

#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <vector>

#include "components/transform.hpp"
#include "components/view.hpp"
#include "components/water.hpp"
#include "components/weather.hpp"
#include "systems/drip/drip.hpp"
#include "systems/drip/extract.hpp"
#include "systems/drip/motion.hpp"
#include "systems/drip_frame.hpp"
#include "systems/system_context.hpp"

namespace petrichor::test {

inline std::shared_ptr<Model> square_model(float half_m) {
  auto model = std::make_shared<Model>();
  Primitive p;
  for (const glm::vec2 c : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)}) {
    Vertex v;
    v.position_m = {c.x * half_m, 0.0f, c.y * half_m};
    p.vertices.push_back(v);
  }
  p.indices = {0, 2, 1, 0, 3, 2};
  p.bounds_min_m = {-half_m, 0, -half_m};
  p.bounds_max_m = {half_m, 0, half_m};
  model->meshes.push_back({"floor", {p}});
  return model;
}

struct RainyEdge {
  Registry registry;
  std::vector<std::shared_ptr<const Model>> models;
  Entity weather, edge;

  explicit RainyEdge(float rain_mm_per_hour, DripSource source = {}, float height_m = 4.0f) {
    weather = registry.create();
    Emitter emitter;
    emitter.rain_mm_per_hour = rain_mm_per_hour;
    registry.emplace<Emitter>(weather, emitter);
    models.push_back(square_model(50.0f));
    add_floor(0.0f);
    edge = add_edge(source, {0, height_m, 0});
  }
  Entity add_floor(float y) {
    const Entity floor = registry.create();
    registry.emplace<MeshInstance>(floor);
    registry.emplace<WorldTransform>(floor, glm::translate(glm::mat4(1.0f), {0, y, 0}));
    return floor;
  }
  Entity add_edge(const DripSource& source, const glm::vec3& at) {
    const Entity e = registry.create();
    registry.emplace<DripSource>(e, source);
    registry.emplace<WorldTransform>(e, glm::translate(glm::mat4(1.0f), at));
    return e;
  }
  void rain(float mm_per_hour) { registry.get<Emitter>(weather).rain_mm_per_hour = mm_per_hour; }
  void tick(double time_s, double step_s = 1.0 / 120.0) { simulate_drips(registry, models, time_s, step_s); }
  // Ticks from one time to another, both ends included.
  void run(double from_s, double to_s, double step_s = 1.0 / 120.0) {
    const auto steps = static_cast<int>(std::llround((to_s - from_s) / step_s));
    for (int i = 0; i <= steps; ++i) tick(from_s + (to_s - from_s) * i / std::max(steps, 1), step_s);
  }
  const DripMotion& motion() const { return *find_drip_motion(registry); }
  const DripSourceMotion& source(std::size_t i = 0) const { return motion().sources[i]; }
  DripLedger ledger(double time_s) const { return drip_ledger(source(), time_s); }

  FrameCamera camera;
  std::shared_ptr<const FrameDrips> frame(double time_s) {
    return make_frame_drips(motion(), camera, 320, 180, time_s);
  }
};

}  // namespace petrichor::test
