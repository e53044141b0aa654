#include "systems/splash/stage.hpp"

#include <nlohmann/json.hpp>

#include "systems/systems.hpp"

namespace petrichor {
namespace {

Primitive slab(glm::vec3 low, glm::vec3 high) {
  Primitive p;
  const auto side = [&](glm::vec3 a, glm::vec3 u, glm::vec3 v) {
    const auto first = static_cast<std::uint32_t>(p.vertices.size());
    for (const glm::vec3& at : {a, a + u, a + u + v, a + v}) {
      Vertex vertex;
      vertex.position_m = at;
      vertex.normal = glm::normalize(glm::cross(u, v));
      vertex.tangent = glm::vec4(glm::normalize(u), 1.0f);
      p.vertices.push_back(vertex);
    }
    for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) p.indices.push_back(first + i);
  };
  const glm::vec3 d = high - low, x(d.x, 0, 0), y(0, d.y, 0), z(0, 0, d.z);
  side(low + z, x, y);
  side(low + x, -x, y);
  side(low, z, y);
  side(low + x + z, -z, y);
  side(low + y + z, x, -z);
  side(low, x, z);
  p.material = 0;
  p.bounds_min_m = low;
  p.bounds_max_m = high;
  return p;
}

PassOffer ground_offer(float film_mm) {
  PassOffer offer;
  offer.name = "stage_ground";
  offer.meaning = "an even picture, and water on everything";
  offer.slots = {{"colour", SlotAccess::write}, {"water", SlotAccess::write, true}};
  offer.execute = [film_mm](PassContext& context) {
    clear_texture(context.texture("colour"), {0.02f, 0.02f, 0.02f, 1.0f});
    if (context.has("water")) clear_texture(context.texture("water"), {0.0f, film_mm, 0.0f, 0.0f});
  };
  return offer;
}

}  // namespace

Result<std::unique_ptr<SplashStage>> SplashStage::make(const SplashStageSet& set) {
  std::unique_ptr<SplashStage> stage(new SplashStage(set));
  if (auto loaded = stage->load(); !loaded) return tl::unexpected(loaded.error());
  return stage;
}

Result<void> SplashStage::load() {
  auto model = std::make_shared<Model>();
  model->materials.resize(1);
  model->materials[0].roughness = set_.roughness;
  model->materials[0].metallic = 0.0f;
  model->meshes.push_back({"ground", {slab({-60, -1, -60}, {60, 0, 60})}});
  if (set_.awning) model->meshes.push_back({"awning", {slab({-2, 3, -6}, {2, 3.1f, -2})}});
  model_ = model;
  scene_.add(*model);
  std::vector<PassOffer> offers = all_passes();
  offers.push_back(ground_offer(set_.film_mm));
  graph_ = std::make_unique<Graph>(shaders_, std::move(offers));
  using Json = nlohmann::json;
  Json table;
  Json& r = table["resources"];
  r["depth"] = r["map"] = {{"format", "depth32f"}};
  r["map"] = {{"format", "depth32f"}, {"width", 1024}, {"height", 1024}, {"layers", 8}, {"persistent", true}};
  r["albedo"] = {{"format", "rgba8"}};
  r["normal"] = {{"format", "rgba16"}};
  r["emissive"] = {{"format", "r11f_g11f_b10f"}};
  r["water"] = {{"format", "rg16f"}};
  r["overhead"] = {{"format", "rgba16f"}, {"width", 128}, {"height", 128}, {"persistent", true}};
  r["colour"] = {{"format", "rgba16f"}};
  Json list = {{"pass", "splash_list"},  {"depth", "depth"}, {"normal", "normal"},
               {"occlusion_map", "map"}, {"water", "water"}, {"overhead", "overhead"}};
  if (set_.unlimited) list["parameters"] = {{"software_most", 0}};
  Json overhead = {{"pass", "splash_overhead"}, {"overhead", "overhead"}, {"occlusion_map", "map"}};
  if (set_.unlimited) overhead["parameters"] = {{"software_reach", 0}};
  table["passes"] = Json::array(
      {{{"pass", "gbuffer"}, {"depth", "depth"}, {"albedo", "albedo"}, {"normal", "normal"}, {"emissive", "emissive"}},
       {{"pass", "occlusion_map"}, {"occlusion_map", "map"}},
       {{"pass", "stage_ground"}, {"colour", "colour"}, {"water", "water"}},
       overhead,
       list,
       {{"pass", "splash_draw"}, {"depth", "depth"}},
       {{"pass", "rain_composite"}, {"colour", "colour"}}});
  table["output"] = "colour";
  return graph_->load_table(table, "the stage of splashes");
}

Frame SplashStage::frame(int width, int height) const {
  Frame f;
  f.width = width;
  f.height = height;
  f.camera.position_m = {0.0, 1.4, 0.0};
  f.camera.orientation = glm::angleAxis(glm::radians(-14.0f), glm::vec3(1, 0, 0));
  f.camera.vertical_fov_rad = glm::radians(50.0f);
  f.camera.exposure_ev100 = 0.0f;
  f.sky.zenith_cd_m2 = f.sky.horizon_cd_m2 = glm::vec3(0.01f);
  f.geometry_version = f.lights_version = 1;
  for (std::uint32_t m = 0; m < model_->meshes.size(); ++m) f.instances.push_back({0, m, true, glm::mat4(1.0f)});
  for (const glm::vec3& at : {glm::vec3(-1.5f, 2.5f, -8.0f), glm::vec3(2.5f, 3.0f, -11.0f)}) {
    FrameLight light{};
    light.position_m = at;
    light.direction = {0, -1, 0};
    light.intensity = glm::vec3(200.0f, 160.0f, 110.0f);
    light.source_radius_m = 0.08f;
    light.kind = LIGHT_POINT;
    light.lights_rain = true;
    f.lights.push_back(light);
  }
  f.scene = &scene_;
  f.splashes = default_splashes();
  f.techniques.set(Effect::rainfall, RainRung::fog);
  f.techniques.set(Effect::occlusion, OcclusionRung::tilted);
  return f;
}

Result<void> SplashStage::draw(Frame& frame) {
  ++frame.number;
  if (frame.rain) frame.rain->techniques = frame.techniques;
  if (frame.techniques.share(Effect::splashes, SplashRung::none) >= 1.0f) frame.splashes.reset();
  finish_frame(frame);
  gpu_.upload(frame);
  auto drawn = graph_->execute(frame, frame.width, frame.height, timer_);
  if (!drawn) return tl::unexpected(drawn.error());
  output_ = *drawn;
  return {};
}

std::vector<float> SplashStage::light() const {
  std::vector<float> pixels(std::size_t(output_->width) * output_->height * 3);
  glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
  glGetTextureImage(output_->id, 0, GL_RGB, GL_FLOAT, static_cast<GLsizei>(pixels.size() * sizeof(float)),
                    pixels.data());
  return pixels;
}

std::shared_ptr<FrameSplashes> default_splashes() {
  return std::make_shared<FrameSplashes>();
}

}  // namespace petrichor
