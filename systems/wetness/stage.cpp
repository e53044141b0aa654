#include "systems/wetness/stage.hpp"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>

namespace petrichor {
namespace {

template <class Texel>
void read(const Texture& texture, GLenum format, std::vector<Texel>& out) {
  out.resize(static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height));
  glGetTextureImage(texture.id, 0, format, GL_FLOAT, static_cast<GLsizei>(out.size() * sizeof(Texel)), out.data());
}

}  // namespace

void WetStage::add(std::shared_ptr<const Model> model) {
  models_.push_back(model);
  pointers_.push_back(model.get());
  const std::uint32_t index = scene_.add(*model);
  for (std::uint32_t i = 0; i < model->meshes.size(); ++i) frame.instances.push_back({index, i, true, glm::mat4(1.0f)});
}

Result<void> WetStage::load(std::vector<PassOffer> all, int layers) {
  PassOffer keep;
  keep.name = "keep";
  for (const char* slot : {"depth", "albedo", "normal"}) keep.slots.push_back({slot, SlotAccess::read});
  keep.slots.push_back({"water", SlotAccess::read, true});
  keep.slots.push_back({"picture", SlotAccess::write});
  keep.execute = [this](PassContext& context) {
    if (!reads_) return;
    const Texture& depth = context.texture("depth");
    pixels_.width = depth.width;
    pixels_.height = depth.height;
    read(depth, GL_DEPTH_COMPONENT, pixels_.depth);
    read(context.texture("albedo"), GL_RGBA, pixels_.albedo);
    read(context.texture("normal"), GL_RGBA, pixels_.normal);
    pixels_.water.assign(pixels_.depth.size(), {});
    if (context.has("water")) read(context.texture("water"), GL_RG, pixels_.water);
  };
  all.push_back(std::move(keep));
  nlohmann::json table;
  table["resources"] = {
      {"depth", {{"format", "depth32f"}}},
      {"albedo", {{"format", "rgba8"}}},
      {"normal", {{"format", "rgba16"}}},
      {"emissive", {{"format", "r11f_g11f_b10f"}}},
      {"water_mask", {{"format", "rg8"}}},
      {"water", {{"format", "rg16f"}}},
      {"picture", {{"format", "rgba8"}}},
      {"map", {{"format", "depth32f"}, {"width", 1024}, {"height", 1024}, {"layers", layers}, {"persistent", true}}}};
  const nlohmann::json over{{"depth", "depth"}, {"albedo", "albedo"}, {"normal", "normal"}};
  nlohmann::json gbuffer = over, wet = over, kept = over;
  gbuffer.update({{"pass", "gbuffer"}, {"emissive", "emissive"}, {"water_mask", "water_mask"}});
  wet.update({{"pass", "wet_surfaces"}, {"water_mask", "water_mask"}, {"occlusion_map", "map"}, {"water", "water"}});
  kept.update({{"pass", "keep"}, {"water", "water"}, {"picture", "picture"}});
  table["passes"] = {gbuffer, {{"pass", "occlusion_map"}, {"occlusion_map", "map"}}, wet, kept};
  table["output"] = "picture";
  graph_ = std::make_unique<Graph>(shaders_, std::move(all));
  return graph_->load_table(table, "the stage of wet surfaces");
}

Result<void> WetStage::execute(FrameTimer& timer) {
  frame.scene = &scene_;
  ++frame.number;
  finish_frame(frame);
  gpu_.upload(frame);
  auto drawn = graph_->execute(frame, frame.width, frame.height, timer);
  if (!drawn) return tl::unexpected(drawn.error());
  return {};
}

Result<WetPixels> WetStage::draw() {
  FrameTimer timer(true);
  reads_ = true;
  if (auto drawn = execute(timer); !drawn) return tl::unexpected(drawn.error());
  return pixels_;
}

Result<std::vector<double>> WetStage::time(int frames, bool software) {
  FrameTimer timer(software);
  reads_ = false;
  std::vector<double> all;
  for (int i = 0; i < frames + 3; ++i) {
    timer.begin_frame(true);
    if (auto drawn = execute(timer); !drawn) return tl::unexpected(drawn.error());
    timer.end_frame();
    glFinish();
    double sum = 0.0;
    const std::vector<Timing> timings = timer.collect();
    for (const Timing& t : timings)
      if (t.name == "wet_surfaces") sum += t.milliseconds;
    if (i >= 3 && !timings.empty()) all.push_back(sum);
  }
  return all;
}

bool WetStage::ran() const {
  for (const PassReport& r : graph_->report())
    if (r.name == "wet_surfaces") return !r.culled;
  return false;
}

}  // namespace petrichor
