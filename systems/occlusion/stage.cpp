#include "systems/occlusion/stage.hpp"

#include <algorithm>
#include <chrono>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>

#include "systems/occlusion/occlusion.hpp"

namespace petrichor {
namespace {

double now_ms() {
  glFinish();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

std::uint32_t OcclusionStage::add(std::shared_ptr<const Model> model) {
  models_.push_back(model);
  return scene_.add(*model);
}

std::uint32_t OcclusionStage::add_placed(std::shared_ptr<const Model> model) {
  const std::uint32_t index = add(model);
  if (model->nodes.empty())
    for (std::uint32_t i = 0; i < model->meshes.size(); ++i)
      frame.instances.push_back({index, i, true, glm::mat4(1.0f)});
  std::vector<glm::mat4> placed;
  for (const Node& node : model->nodes) {
    const glm::mat4 local = glm::translate(glm::mat4(1.0f), node.translation_m) * glm::mat4_cast(node.rotation) *
                            glm::scale(glm::mat4(1.0f), node.scale);
    placed.push_back(node.parent == no_index ? local : placed[static_cast<std::size_t>(node.parent)] * local);
    if (node.mesh != no_index)
      frame.instances.push_back({index, static_cast<std::uint32_t>(node.mesh), true, placed.back()});
  }
  return index;
}

Result<void> OcclusionStage::load(int texels, int layers, const std::map<std::string, double>& parameters) {
  std::vector<PassOffer> offers = occlusion_passes();
  // Around the maps' own pass, so that it can be timed alone.
  offers.front().execute = [this, execute = offers.front().execute](PassContext& context) {
    const double start = now_ms();
    execute(context);
    maps_ms_ = now_ms() - start;
    map_ = context.texture("occlusion_map").id;
  };
  PassOffer ask;
  ask.name = "ask";
  ask.slots = {{"occlusion_map", SlotAccess::read}, {"picture", SlotAccess::write}};
  ask.shaders = {{"ask", {{"systems/occlusion/shelter_ask.comp.glsl"}, {}}}};
  ask.execute = [this](PassContext& context) {
    if (asked_count_ == 0) return;
    context.bind_texture(OCCLUSION_UNIT, "occlusion_map");
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 7, questions_.id);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 8, answers_.id);
    const Program& program = context.program("ask");
    program.use();
    program.set("count", static_cast<unsigned>(asked_count_));
    const double start = now_ms();
    program.dispatch(static_cast<int>(asked_count_));
    query_ms_ = now_ms() - start;
  };
  offers.push_back(std::move(ask));
  nlohmann::json table;
  table["resources"]["map"] = {
      {"format", "depth32f"}, {"width", texels}, {"height", texels}, {"layers", layers}, {"persistent", true}};
  table["resources"]["picture"] = {{"format", "rgba8"}, {"width", 1}, {"height", 1}};
  table["passes"] = {{{"pass", "occlusion_map"}, {"occlusion_map", "map"}, {"parameters", parameters}},
                     {{"pass", "ask"}, {"occlusion_map", "map"}, {"picture", "picture"}}};
  table["output"] = "picture";
  graph_ = std::make_unique<Graph>(shaders_, std::move(offers));
  return graph_->load_table(table, "the stage of shelter");
}

Result<void> OcclusionStage::draw() {
  frame.scene = &scene_;
  frame.width = frame.height = 16;
  ++frame.number;
  finish_frame(frame);
  gpu_.upload(frame);
  auto drawn = graph_->execute(frame, frame.width, frame.height, timer_);
  if (!drawn) return tl::unexpected(drawn.error());
  return {};
}

Result<std::vector<ShelterAnswer>> OcclusionStage::ask(const std::vector<ShelterQuestion>& questions) {
  asked_.clear();
  for (const ShelterQuestion& q : questions) {
    asked_.emplace_back(glm::vec3(glm::dvec3(q.place_m) - frame.camera.position_m), 0.0f);
    asked_.emplace_back(q.normal, 0.0f);
    asked_.emplace_back(q.velocity_mps, 0.0f);
  }
  asked_count_ = questions.size();
  upload(questions_, std::span<const glm::vec4>(asked_));
  if (answers_.bytes < asked_count_ * 32) answers_ = make_buffer(asked_count_ * 32);
  if (auto drawn = draw(); !drawn) return tl::unexpected(drawn.error());
  std::vector<glm::vec4> got(2 * asked_count_);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  if (!got.empty()) read_buffer(answers_, got.data(), got.size() * sizeof(glm::vec4));
  std::vector<ShelterAnswer> answers;
  for (std::size_t i = 0; i < asked_count_; ++i) {
    const glm::vec4 &a = got[2 * i], &b = got[2 * i + 1];
    redrawn_ = static_cast<int>(b.w);
    answers.push_back({a.x, a.y > 0.5f, a.z > 0.5f, a.w, b.x, b.y, b.z});
  }
  return answers;
}

Result<ShelterCost> OcclusionStage::time(const std::vector<ShelterQuestion>& questions, int repeats) {
  if (auto warm = ask(questions); !warm) return tl::unexpected(warm.error());
  ShelterCost cost;
  for (int i = 0; i < repeats; ++i) {
    ++frame.geometry_version;
    if (auto drawn = draw(); !drawn) return tl::unexpected(drawn.error());
    cost.maps_ms.push_back(maps_ms_);
    cost.query_ns.push_back(1e6 * query_ms_ / static_cast<double>(std::max<std::size_t>(questions.size(), 1)));
  }
  return cost;
}

ShelterRays OcclusionStage::rays() const {
  std::vector<const Model*> models;
  for (const auto& model : models_) models.push_back(model.get());
  return ShelterRays(models, frame.instances);
}

}  // namespace petrichor
