#include "systems/ripple/stage.hpp"

#include <chrono>
#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>

#include "components/transform.hpp"
#include "components/view.hpp"
#include "systems/puddle_frame.hpp"
#include "systems/ripple/ripple.hpp"
#include "systems/ripple_frame.hpp"

namespace petrichor {

RippleStage::RippleStage() : timer_(std::make_unique<FrameTimer>(true)) {
  rain_ = registry_.create();
  registry_.emplace<Emitter>(rain_);
  registry_.emplace<Wind>(rain_);
  registry_.emplace<Ripples>(rain_);
  eye_ = registry_.create();
  registry_.emplace<Camera>(eye_);
  registry_.emplace<WorldTransform>(eye_);
  puddle_ = registry_.create();
  registry_.emplace<Puddle>(puddle_);
  registry_.emplace<WorldTransform>(puddle_);
  emitter().rain_mm_per_hour = 10.0f;
  look({0.0, 1.6, 2.0}, glm::normalize(glm::vec3(0, -0.5f, -1)));
}

Emitter& RippleStage::emitter() {
  return registry_.get<Emitter>(rain_);
}
Wind& RippleStage::wind() {
  return registry_.get<Wind>(rain_);
}
Ripples& RippleStage::ripples() {
  return registry_.get<Ripples>(rain_);
}

Entity RippleStage::add_wader(const Wader& wader, glm::vec3 place_m) {
  const Entity e = registry_.create();
  registry_.emplace<Wader>(e, wader);
  registry_.emplace<WorldTransform>(e, glm::translate(glm::mat4(1.0f), place_m));
  return e;
}

void RippleStage::place(Entity e, glm::vec3 place_m) {
  registry_.get<WorldTransform>(e).matrix = glm::translate(glm::mat4(1.0f), place_m);
}

void RippleStage::look(glm::dvec3 from_m, glm::vec3 ahead) {
  const glm::vec3 up = std::abs(ahead.y) > 0.99f ? glm::vec3(0, 0, -1) : glm::vec3(0, 1, 0);
  glm::mat4 m(1.0f);
  const glm::vec3 right = glm::normalize(glm::cross(ahead, up));
  m[0] = glm::vec4(right, 0);
  m[1] = glm::vec4(glm::cross(right, ahead), 0);
  m[2] = glm::vec4(-ahead, 0);
  m[3] = glm::vec4(glm::vec3(from_m), 1);
  registry_.get<WorldTransform>(eye_).matrix = m;
}

void RippleStage::tick() {
  simulate_ripples(registry_, static_cast<double>(ticks_) / 120.0, 1.0 / 120.0);
  ++ticks_;
}

void RippleStage::run(double seconds) {
  for (int i = 0; i < static_cast<int>(std::lround(seconds * 120.0)); ++i) tick();
}

Frame RippleStage::frame(double before) const {
  Frame f;
  f.width = 160, f.height = 90;
  f.techniques = techniques;
  f.time_s = (static_cast<double>(ticks_ - 1) - before) / 120.0;
  const glm::mat4& eye = registry_.find<WorldTransform>(eye_)->matrix;
  f.camera.position_m = glm::dvec3(eye[3]);
  f.camera.orientation = glm::quat_cast(glm::mat3(eye));
  auto puddles = std::make_shared<FramePuddles>();
  FramePuddles::Puddle p;
  p.half_size_m = glm::vec2(3.0f);
  p.level_m = p.depth_m = 0.01f;
  p.world_from_puddle = registry_.find<WorldTransform>(puddle_)->matrix;
  // Beneath the eye, wherever that is.
  p.world_from_puddle[3] += glm::vec4(eye[3].x, 0, eye[3].z - 2.0f, 0);
  puddles->puddles.push_back(p);
  puddles->any_water = true;
  f.puddles = std::move(puddles);
  auto drips = std::make_shared<FrameDrips>();
  drips->landings = landings;
  f.drips = std::move(drips);
  extract_ripples(registry_, f, f.time_s);
  return f;
}

Result<void> RippleStage::load(int cells, int layers, double rings) {
  timer_ = std::make_unique<FrameTimer>(software);
  cells_ = cells;
  layers_ = layers;
  std::vector<PassOffer> offers = ripple_passes();
  PassOffer look;
  look.name = "look";
  look.slots = {{"ripples", SlotAccess::read, true}};
  look.side_effect = true;
  look.shaders = {{"ask", {{"systems/ripple/ripple_ask.comp.glsl"}, {}}}};
  look.execute = [this](PassContext& context) {
    ran_ = context.has("ripples");
    if (!ran_) return;
    map_ = context.texture("ripples").id;
    if (questions.empty()) return;
    upload(questions_, std::span<const glm::vec4>(questions));
    if (answers_.bytes < questions.size() * sizeof(glm::vec4))
      answers_ = make_buffer(questions.size() * sizeof(glm::vec4));
    context.bind_texture(8, "ripples");
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 13, questions_.id);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 14, answers_.id);
    const Program& program = context.program("ask");
    program.use();
    program.set("count", static_cast<unsigned>(questions.size()));
    program.dispatch(static_cast<int>(questions.size()));
  };
  offers.push_back(std::move(look));
  PassOffer paint;
  paint.name = "paint";
  paint.slots = {{"picture", SlotAccess::write}};
  paint.execute = [](PassContext&) {};
  offers.push_back(std::move(paint));
  nlohmann::json table;
  table["resources"]["ripples"] = {{"format", "rgba16f"}, {"width", cells}, {"height", cells}, {"layers", layers}};
  table["resources"]["picture"] = {{"format", "rgba8"}, {"width", 1}, {"height", 1}};
  table["passes"] = {{{"pass", "ripples"}, {"ripples", "ripples"}, {"parameters", {{"rings", rings}}}},
                     {{"pass", "look"}, {"ripples", "ripples"}},
                     {{"pass", "paint"}, {"picture", "picture"}}};
  table["output"] = "picture";
  graph_ = std::make_unique<Graph>(shaders_, std::move(offers));
  return graph_->load_table(table, "the stage of ripples");
}

Result<double> RippleStage::draw(Frame f) {
  f.number = number_++;
  finish_frame(f);
  gpu_.upload(f);
  glFinish();
  timer_->begin_frame(true);
  const auto start = std::chrono::steady_clock::now();
  auto drawn = graph_->execute(f, f.width, f.height, *timer_);
  if (!drawn) return tl::unexpected(drawn.error());
  timer_->end_frame();
  glFinish();
  double ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  for (const Timing& t : timer_->collect())
    if (t.name == "ripples") ms = t.milliseconds;
  return ms;
}

std::vector<glm::vec4> RippleStage::answers() const {
  std::vector<glm::vec4> all(questions.size());
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  if (!all.empty()) read_buffer(answers_, all.data(), all.size() * sizeof(glm::vec4));
  return all;
}

std::vector<glm::vec4> RippleStage::layer(int layer) const {
  std::vector<glm::vec4> all(static_cast<std::size_t>(cells_) * cells_ * layers_);
  glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
  glGetTextureImage(map_, 0, GL_RGBA, GL_FLOAT, static_cast<GLsizei>(all.size() * sizeof(glm::vec4)), all.data());
  const auto plane = static_cast<std::ptrdiff_t>(cells_) * cells_;
  return {all.begin() + layer * plane, all.begin() + (layer + 1) * plane};
}

}  // namespace petrichor
