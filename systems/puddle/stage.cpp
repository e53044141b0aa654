#include "systems/puddle/stage.hpp"

#include <chrono>
#include <nlohmann/json.hpp>

#include "systems/puddle/puddle.hpp"

namespace petrichor {
namespace {

double now_ms() {
  glFinish();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

Result<void> PuddleStage::load() {
  std::vector<PassOffer> offers = puddle_passes();
  offers.front().execute = [this, execute = offers.front().execute](PassContext& context) {
    const double start = now_ms();
    execute(context);
    pass_ms_ = now_ms() - start;
  };
  PassOffer ask;
  ask.name = "ask";
  ask.slots = {{"puddle_list", SlotAccess::read, true}, {"picture", SlotAccess::write}};
  ask.shaders = {{"ask", {{"systems/puddle/puddle_ask.comp.glsl"}, {}}}};
  ask.execute = [this](PassContext& context) {
    ran_ = context.has("puddle_list");
    query_ms_ = 0.0;
    if (!ran_ || asked_ == 0) return;
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, WET_MATERIALS_BINDING, kinds_.id);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 7, questions_.id);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 8, answers_.id);
    const Program& program = context.program("ask");
    program.use();
    program.set("count", static_cast<unsigned>(asked_));
    const double start = now_ms();
    program.dispatch(static_cast<int>(asked_));
    query_ms_ = now_ms() - start;
  };
  offers.push_back(std::move(ask));
  nlohmann::json table;
  table["resources"]["list"] = {{"format", "none"}};
  table["resources"]["picture"] = {{"format", "rgba8"}, {"width", 1}, {"height", 1}};
  table["passes"] = {{{"pass", "puddles"}, {"puddle_list", "list"}},
                     {{"pass", "ask"}, {"puddle_list", "list"}, {"picture", "picture"}}};
  table["output"] = "picture";
  graph_ = std::make_unique<Graph>(shaders_, std::move(offers));
  return graph_->load_table(table, "the stage of puddles");
}

Result<std::vector<PuddleAnswer>> PuddleStage::ask(const std::vector<PuddleQuestion>& questions) {
  std::vector<glm::vec4> asked;
  for (const PuddleQuestion& q : questions) {
    asked.emplace_back(glm::vec3(glm::dvec3(q.place_m) - frame.camera.position_m), 0.0f);
    asked.emplace_back(q.mask, 0.0f, 0.0f);
  }
  asked_ = questions.size();
  upload(questions_, std::span<const glm::vec4>(asked));
  if (answers_.bytes < asked_ * 32) answers_ = make_buffer(asked_ * 32);
  std::vector<WetMaterialGpu> table = kinds;
  table.resize(WET_MATERIAL_KINDS);
  upload(kinds_, std::span<const WetMaterialGpu>(table));
  frame.width = frame.height = 16;
  ++frame.number;
  finish_frame(frame);
  gpu_.upload(frame);
  pass_ms_ = 0.0;
  if (auto drawn = graph_->execute(frame, frame.width, frame.height, timer_); !drawn)
    return tl::unexpected(drawn.error());
  std::vector<PuddleAnswer> answers;
  if (!ran_) return answers;
  std::vector<glm::vec4> got(2 * asked_);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  if (!got.empty()) read_buffer(answers_, got.data(), got.size() * sizeof(glm::vec4));
  for (std::size_t i = 0; i < asked_; ++i) {
    const glm::vec4& a = got[2 * i];
    answers.push_back({a.x, a.y, a.z, a.w, glm::vec3(got[2 * i + 1])});
  }
  return answers;
}

}  // namespace petrichor
