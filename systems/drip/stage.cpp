#include "systems/drip/stage.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>

#include "components/transform.hpp"
#include "components/view.hpp"
#include "systems/drip/drip.hpp"
#include "systems/drip/extract.hpp"
#include "systems/drops/composite.hpp"

namespace petrichor {
namespace {

std::shared_ptr<const Model> floor_model() {
  auto model = std::make_shared<Model>();
  Primitive p;
  for (const glm::vec2 c : {glm::vec2(-50, -50), glm::vec2(50, -50), glm::vec2(50, 50), glm::vec2(-50, 50)}) {
    Vertex v;
    v.position_m = {c.x, 0.0f, c.y};
    p.vertices.push_back(v);
  }
  p.indices = {0, 2, 1, 0, 3, 2};
  model->meshes.push_back({"floor", {p}});
  return model;
}

PassOffer wall_offer() {
  PassOffer offer;
  offer.name = "stage_wall";
  offer.meaning = "an even wall";
  offer.slots = {{"colour", SlotAccess::write}};
  offer.execute = [](PassContext& context) {
    const glm::vec4& h = context.frame.uniforms.sky_horizon;
    clear_texture(context.texture("colour"), {h.r, h.g, h.b, 1.0f}, ClearBy::compute);
  };
  return offer;
}

// As pass rain_composite, of whose folder this one knows nothing.
PassOffer composite_offer(const DropPainting& painting) {
  PassOffer offer;
  offer.name = "stage_composite";
  offer.meaning = "lays the drops over the picture";
  offer_composite(offer, false);
  offer.execute = [painting](PassContext& context) {
    bind_rain_optics(*painting.optics, context.frame);
    lay_over(*painting.sums, context, *painting.optics, 0.0f);
  };
  return offer;
}

}  // namespace

Result<std::unique_ptr<DripStage>> DripStage::make(bool software_gl) {
  std::unique_ptr<DripStage> stage(new DripStage(software_gl));
  const DropPainting painting;
  std::vector<PassOffer> offers = drip_passes(painting);
  offers.push_back(wall_offer());
  offers.push_back(composite_offer(painting));
  stage->graph_ = std::make_unique<Graph>(stage->library_, std::move(offers));
  using Json = nlohmann::json;
  Json table;
  // As city.lua has it: rain_composite.comp.glsl declares its image rgba16f, and to store into another format is undefined.
  table["resources"]["colour"] = {{"format", "rgba16f"}};
  table["passes"] = Json::array({{{"pass", "stage_wall"}, {"colour", "colour"}},
                                 {{"pass", "drips"}},
                                 {{"pass", "stage_composite"}, {"colour", "colour"}},
                                 {{"pass", "drips_over"}, {"colour", "colour"}}});
  table["output"] = "colour";
  if (auto loaded = stage->graph_->load_table(table, "the stage of drips"); !loaded)
    return tl::unexpected(loaded.error());
  return stage;
}

Frame DripStage::frame(const DripSet& set, int width, int height, double time_s, std::size_t most) const {
  Registry registry;
  const Entity weather = registry.create();
  Emitter emitter;
  emitter.rain_mm_per_hour = set.rain_mm_per_hour;
  registry.emplace<Emitter>(weather, emitter);
  const std::vector<std::shared_ptr<const Model>> models{floor_model()};
  const Entity floor = registry.create();
  registry.emplace<MeshInstance>(floor);
  registry.emplace<WorldTransform>(floor);
  for (int i = 0; i < set.rows; ++i) {
    const Entity e = registry.create();
    registry.emplace<DripSource>(e, set.source);
    registry.emplace<WorldTransform>(
        e, glm::translate(glm::mat4(1.0f), {-0.5f * set.source.length_m, 3.0f, -0.1f * static_cast<float>(i)}));
  }
  simulate_drips(registry, models, 0.0, 1.0 / 120.0);
  Frame f;
  f.time_s = time_s;
  f.width = width;
  f.height = height;
  f.camera.position_m = {0.0, 3.0 - 0.4 * set.camera_away_m, set.camera_away_m};
  f.camera.vertical_fov_rad = 1.0f;
  f.camera.exposure_s = 1.0f / 60.0f;
  f.camera.exposure_ev100 = 0.0f;
  f.sky.horizon_cd_m2 = set.wall_cd_m2;
  f.sky.zenith_cd_m2 = 0.1f * set.wall_cd_m2;
  for (const float x : {-0.9f, 1.2f}) {
    FrameLight light{};
    light.position_m = {x, 2.6f, -3.0f};
    light.direction = {0.0f, -1.0f, 0.0f};
    light.intensity = glm::vec3(60.0f, 45.0f, 30.0f);
    light.range_m = 30.0f;
    light.source_radius_m = 0.08f;
    light.kind = LIGHT_POINT;
    light.lights_rain = true;
    f.lights.push_back(light);
  }
  if (const auto made = make_frame_drips(*find_drip_motion(registry), f.camera, width, height, time_s, most)) {
    auto drips = std::make_shared<FrameDrips>(*made);
    drips->shows_world_px = set.shows_world_px;
    f.drips = std::move(drips);
  }
  return f;
}

Result<void> DripStage::draw(Frame& f) {
  finish_frame(f);
  frame_gpu_.upload(f);
  auto drawn = graph_->execute(f, f.width, f.height, timer_);
  if (!drawn) return tl::unexpected(drawn.error());
  output_ = *drawn;
  return {};
}

std::vector<float> DripStage::read_light() const {
  std::vector<float> rgba(static_cast<std::size_t>(output_->width) * static_cast<std::size_t>(output_->height) * 4);
  glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
  glGetTextureImage(output_->id, 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(rgba.size() * 4), rgba.data());
  std::vector<float> light(rgba.size() / 4);
  for (std::size_t i = 0; i < light.size(); ++i)
    light[i] = 0.2126f * rgba[4 * i] + 0.7152f * rgba[4 * i + 1] + 0.0722f * rgba[4 * i + 2];
  return light;
}

Result<double> DripStage::time(Frame& f) {
  timer_.begin_frame(true);
  const auto drawn = draw(f);
  timer_.end_frame();
  if (!drawn) return tl::unexpected(drawn.error());
  glFinish();
  double sum = 0.0;
  for (const Timing& t : timer_.collect())
    if (t.name == "drips" || t.name == "drips_over") sum += t.milliseconds;
  return sum;
}

}  // namespace petrichor
