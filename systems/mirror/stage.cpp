#include "systems/mirror/stage.hpp"

#include <nlohmann/json.hpp>

#include "systems/mirror_shared.h"

namespace petrichor {

MirrorStage::MirrorStage(std::vector<PassOffer> passes, bool software) : timer_(software) {
  PassOffer ask;
  ask.name = "mirror_ask";
  ask.slots = {{"mirrors", SlotAccess::read, true},
               {"probes", SlotAccess::read, true},
               {"environment", SlotAccess::read, true},
               {"colour", SlotAccess::read, true},
               {"picture", SlotAccess::write}};
  ask.shaders = {{"ask", {{"systems/mirror/mirror_ask.comp.glsl"}, {}}}};
  ask.execute = [this](PassContext& context) {
    const bool mirrors = context.has("mirrors"), probes = context.has("probes");
    const bool environment = context.has("environment");
    mirrors_ = mirrors ? GLuint(context.texture("mirrors").id) : 0;
    probes_ = probes ? GLuint(context.texture("probes").id) : 0;
    colour_ = context.has("colour") ? GLuint(context.texture("colour").id) : 0;
    if (mirrors) mirrors_size_ = {context.texture("mirrors").width, context.texture("mirrors").height};
    if (asked_count_ == 0) return;
    if (mirrors) context.bind_texture(9, "mirrors");
    if (probes) context.bind_texture(10, "probes");
    if (environment) context.bind_texture(7, "environment");
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 7, questions_.id);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 8, answers_.id);
    const Program& program = context.program("ask");
    program.use();
    program.set("count", static_cast<unsigned>(asked_count_));
    program.set("has_mirrors", int(mirrors));
    program.set("has_probes", int(probes));
    program.set("has_environment", int(environment));
    program.dispatch(static_cast<int>(asked_count_));
  };
  passes.push_back(std::move(ask));
  graph_ = std::make_unique<Graph>(shaders_, std::move(passes));
  frame.scene = &scene_;
  frame.geometry_version = frame.lights_version = 1;
}

Result<std::unique_ptr<MirrorStage>> MirrorStage::make(std::vector<PassOffer> passes, bool software, double scale,
                                                       const std::map<std::string, double>& mirrors_parameters,
                                                       const std::map<std::string, double>& probes_parameters,
                                                       bool lit_picture) {
  std::unique_ptr<MirrorStage> stage(new MirrorStage(std::move(passes), software));
  nlohmann::json table = nlohmann::json::parse(R"json({
    "resources": {
      "depth": {"format": "depth32f"}, "albedo": {"format": "rgba8"}, "normal": {"format": "rgba16"},
      "emissive": {"format": "r11f_g11f_b10f"},
      "shadow_atlas": {"format": "rgba32f", "width": 2048, "height": 2048, "persistent": true},
      "environment": {"format": "rgba16f", "width": 448, "height": 65},
      "probes": {"format": "rgba16f", "width": 448, "height": 65, "layers": 4},
      "light_lists": {"format": "rgba32ui", "scale": 0.125},
      "mirrors": {"format": "rgba16f", "layers": 2, "mips": 6},
      "picture": {"format": "rgba8", "width": 1, "height": 1}},
    "passes": [
      {"pass": "gbuffer", "depth": "depth", "albedo": "albedo", "normal": "normal", "emissive": "emissive"},
      {"pass": "shadow_maps", "shadow_atlas": "shadow_atlas"},
      {"pass": "environment", "environment": "environment", "shadow_atlas": "shadow_atlas"},
      {"pass": "probes", "probes": "probes", "shadow_atlas": "shadow_atlas"},
      {"pass": "light_lists", "depth": "depth", "albedo": "albedo", "normal": "normal",
       "shadow_atlas": "shadow_atlas", "light_lists": "light_lists"},
      {"pass": "mirrors", "light_lists": "light_lists", "shadow_atlas": "shadow_atlas",
       "environment": "environment", "mirrors": "mirrors"},
      {"pass": "mirror_ask", "mirrors": "mirrors", "probes": "probes", "environment": "environment",
       "picture": "picture"}],
    "output": "picture"})json");
  table["resources"]["mirrors"]["scale"] = scale;
  for (auto& pass : table["passes"]) {
    if (pass["pass"] == "mirrors") pass["parameters"] = mirrors_parameters;
    if (pass["pass"] == "probes") pass["parameters"] = probes_parameters;
  }
  if (lit_picture) {
    table["resources"]["colour"] = {{"format", "rgba16f"}};
    nlohmann::json shade = {{"pass", "shade"}}, glass = {{"pass", "glass"}};
    for (const char* slot :
         {"depth", "albedo", "normal", "emissive", "light_lists", "shadow_atlas", "environment", "colour"})
      shade[slot] = slot;
    for (const char* slot : {"depth", "environment", "mirrors", "colour"}) glass[slot] = slot;
    nlohmann::json ask = table["passes"].back();
    ask["colour"] = "colour";
    table["passes"].erase(table["passes"].size() - 1);
    for (const nlohmann::json& pass : {shade, glass, ask}) table["passes"].push_back(pass);
  }
  if (auto loaded = stage->graph_->load_table(table, "the stage of mirrors"); !loaded)
    return tl::unexpected(loaded.error());
  return stage;
}

std::uint32_t MirrorStage::add(const Model& model) {
  return scene_.add(model);
}

Result<std::vector<MirrorAnswer>> MirrorStage::ask(const std::vector<MirrorQuestion>& questions) {
  asked_.clear();
  for (const MirrorQuestion& q : questions) {
    asked_.emplace_back(glm::vec3(glm::dvec3(q.place_m) - frame.camera.position_m), q.roughness);
    asked_.emplace_back(q.normal, 0.0f);
    asked_.emplace_back(q.direction, 0.0f);
  }
  asked_count_ = questions.size();
  if (asked_count_ > 0) upload(questions_, std::span<const glm::vec4>(asked_));
  if (answers_.bytes < asked_count_ * sizeof(MirrorAnswer)) answers_ = make_buffer(asked_count_ * sizeof(MirrorAnswer));
  ++frame.number;
  mirrors_ = probes_ = colour_ = 0;
  finish_frame(frame);
  gpu_.upload(frame);
  timer_.begin_frame(true);
  auto drawn = graph_->execute(frame, frame.width, frame.height, timer_);
  timer_.end_frame();
  glFinish();
  timings_ = timer_.collect();
  if (!drawn) return tl::unexpected(drawn.error());
  std::vector<MirrorAnswer> answers(asked_count_);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  if (asked_count_ > 0) read_buffer(answers_, answers.data(), answers.size() * sizeof(MirrorAnswer));
  return answers;
}

double MirrorStage::milliseconds(std::string_view pass) const {
  double sum = 0.0;
  for (const Timing& t : timings_)
    if (t.name == pass) sum += t.milliseconds;
  return sum;
}

bool MirrorStage::ran(std::string_view pass) const {
  for (const PassReport& r : graph_->report())
    if (r.name == pass) return !r.culled;
  return false;
}

std::vector<std::uint16_t> MirrorStage::texture(std::string_view resource) const {
  const GLuint id = resource == "mirrors" ? mirrors_ : resource == "probes" ? probes_ : colour_;
  if (!id) return {};
  GLint width = 0, height = 0, layers = 0;
  glGetTextureLevelParameteriv(id, 0, GL_TEXTURE_WIDTH, &width);
  glGetTextureLevelParameteriv(id, 0, GL_TEXTURE_HEIGHT, &height);
  glGetTextureLevelParameteriv(id, 0, GL_TEXTURE_DEPTH, &layers);
  std::vector<std::uint16_t> texels(static_cast<std::size_t>(4 * width) * static_cast<std::size_t>(height * layers));
  glGetTextureImage(id, 0, GL_RGBA, GL_HALF_FLOAT, static_cast<GLsizei>(texels.size() * sizeof(std::uint16_t)),
                    texels.data());
  return texels;
}

}  // namespace petrichor
