#include "systems/image/passes.hpp"

#include <algorithm>
#include <memory>
#include <string>

#include "engine/gpu/objects.hpp"
#include "systems/frame.hpp"

namespace petrichor {
namespace {

constexpr GLuint edges_binding = 7;

glm::ivec2 level_size(const Texture& texture, int level) {
  return {std::max(texture.width >> level, 1), std::max(texture.height >> level, 1)};
}

void blur(PassContext& context) {
  const Texture& pyramid = context.texture("bloom");
  const int levels = pyramid.levels;
  const Program& down = context.program("down");
  down.use();
  for (int level = 0; level < levels; ++level) {
    const glm::ivec2 size = level_size(pyramid, level);
    if (level == 0) {
      context.bind_texture(0, "colour");
      down.set("fine_size", glm::vec2(context.width, context.height));
      down.set("level", 0.0f);
    } else {
      context.bind_texture(0, "bloom");
      down.set("fine_size", glm::vec2(level_size(pyramid, level - 1)));
      down.set("level", static_cast<float>(level - 1));
    }
    down.set("size", size);
    context.bind_image(0, "bloom", GL_WRITE_ONLY, level);
    down.dispatch(size.x, size.y);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  }
  const Program& up = context.program("up");
  up.use();
  up.set("share", std::clamp(context.parameter("spread"), 0.0f, 1.0f));
  context.bind_texture(0, "bloom");
  for (int level = levels - 2; level >= 0; --level) {
    const glm::ivec2 size = level_size(pyramid, level);
    up.set("coarse_size", glm::vec2(level_size(pyramid, level + 1)));
    up.set("level", static_cast<float>(level + 1));
    up.set("size", size);
    context.bind_image(0, "bloom", GL_READ_WRITE, level);
    up.dispatch(size.x, size.y);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  }
}

void map_tones(PassContext& context, std::string_view target) {
  const bool bloom = context.has("bloom");
  const Program& program = context.program(bloom ? "bloom" : "plain");
  program.use();
  program.set("bloom_strength", std::clamp(context.frame.camera.bloom, 0.0f, 1.0f));
  context.bind_texture(0, "colour");
  if (bloom) context.bind_texture(1, "bloom");
  context.bind_image(0, target, GL_WRITE_ONLY);
  program.dispatch(context.width, context.height);
}

PassOffer tonemap(std::string name, std::string meaning, std::string target, std::vector<std::string> defines) {
  const std::vector<std::string> files{"systems/image/tonemap.comp.glsl"};
  std::vector<std::string> with_bloom = defines;
  with_bloom.push_back("BLOOM");
  return {std::move(name),
          std::move(meaning),
          {{"colour", SlotAccess::read}, {"bloom", SlotAccess::read, true}, {target, SlotAccess::write}},
          {},
          {{"plain", {files, defines}}, {"bloom", {files, with_bloom}}},
          {},
          [target](PassContext& context) { map_tones(context, target); }};
}

void antialias(Buffer& edges, PassContext& context) {
  const unsigned header[4] = {0, 1, 1, 0};
  const std::size_t bytes = sizeof header + sizeof(unsigned) * static_cast<std::size_t>(context.width) *
                                                static_cast<std::size_t>(context.height);
  if (edges.bytes < bytes) edges = make_buffer(bytes);
  glNamedBufferSubData(edges.id, 0, sizeof header, header);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, edges_binding, edges.id);
  context.bind_texture(0, "display");
  context.bind_image(0, "picture", GL_WRITE_ONLY);
  const auto use = [&](std::string_view name) -> const Program& {
    const Program& program = context.program(name);
    program.use();
    for (const char* parameter : {"least_contrast", "relative_contrast", "softening"})
      program.set(parameter, context.parameter(parameter));
    // Where it is off no contrast is an edge.
    if (context.frame.techniques.share(Effect::antialias, AntialiasRung::edges) < 0.5f)
      program.set("least_contrast", 1e9f);
    return program;
  };
  use("find").dispatch(context.width, context.height);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
  use("smooth");
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, edges.id);
  glDispatchComputeIndirect(0);
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, 0);
}

}  // namespace

Ladder antialias_ladder() {
  Ladder l;
  l.effect = Effect::antialias;
  l.name = "antialias";
  l.meaning = "smooth edges";
  l.truth = "the picture drawn at four times the width and height";
  l.error_measure = "root mean square, without antialiasing: 1";
  l.rungs = {{"off", "edges as they fall on pixels", {"antialias"}, 0.0, 1.0},
             {"edges", "edges found in the finished picture are smoothed", {"antialias"}, 2.0, 0.5}};
  // Pixels on edges; what is enlarged has larger stairs.
  l.coverage = [](const Frame& frame) {
    constexpr double on_edges = 0.06;
    switch (static_cast<ResolutionRung>(frame.techniques[Effect::resolution].rung)) {
      case ResolutionRung::half:
        return 4.0 * on_edges;
      case ResolutionRung::two_thirds:
        return 2.25 * on_edges;
      default:
        return on_edges;
    }
  };
  l.fades = false;
  return l;
}

Ladder resolution_ladder() {
  Ladder l;
  l.effect = Effect::resolution;
  l.name = "resolution";
  l.meaning = "pixels drawn, of those shown";
  l.truth = "the picture at its full size";
  l.error_measure = "root mean square; an even picture: 1";
  l.rungs = {{"half", "half the width and height", {}, 0.0, 0.5},
             {"two_thirds", "two thirds of the width and height", {}, 0.0, 0.3},
             {"full", "every pixel", {}, 0.0, 0.0}};
  l.coverage = [](const Frame&) { return 1.0; };
  l.fades = false;
  return l;
}

std::vector<PassOffer> image_passes() {
  std::vector<PassOffer> offers;
  offers.push_back(
      {"bloom",
       "light that the lens scatters, as a sum of Gaussians",
       {{"colour", SlotAccess::read}, {"bloom", SlotAccess::write}},
       {{"spread", 0.6}},  // share of each coarser level
       {{"down", {{"systems/image/bloom_down.comp.glsl"}, {}}}, {"up", {{"systems/image/bloom_up.comp.glsl"}, {}}}},
       [](const Frame& frame) { return frame.camera.bloom > 0.0f; },
       blur});
  offers.push_back(tonemap("tonemap", "exposure and film curve", "display", {}));
  offers.push_back(tonemap("tonemap8", "exposure, film curve and dither to 8 bits", "picture", {"FINAL"}));
  offers.push_back({"antialias",
                    "smooths edges and dithers to 8 bits",
                    {{"display", SlotAccess::read}, {"picture", SlotAccess::write}},
                    {{"least_contrast", 0.05}, {"relative_contrast", 0.16}, {"softening", 0.7}},
                    {{"find", {{"systems/image/antialias.comp.glsl"}, {"FIND"}}},
                     {"smooth", {{"systems/image/antialias.comp.glsl"}, {}}}},
                    {},
                    [edges = std::make_shared<Buffer>()](PassContext& context) { antialias(*edges, context); }});
  return offers;
}

}  // namespace petrichor
