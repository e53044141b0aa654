#include "systems/geometry/passes.hpp"

#include <array>
#include <span>
#include <string>

#include "systems/frame.hpp"
#include "systems/gpu_scene.hpp"
#include "systems/mirror_frame.hpp"

namespace petrichor {
namespace {

std::string variant_name(unsigned variant) {
  return "variant_" + std::to_string(variant);
}

std::unordered_map<std::string, ShaderKey> gbuffer_shaders() {
  std::unordered_map<std::string, ShaderKey> shaders;
  for (unsigned v = 0; v < material_variants; ++v) {
    shaders[variant_name(v)] = {{"systems/geometry/gbuffer.vert.glsl", "systems/geometry/gbuffer.frag.glsl"},
                                {"MATERIAL_VARIANT " + std::to_string(v)}};
  }
  return shaders;
}

// Reversed depth; the state that the rest of the engine expects comes back with the scope's end.
struct DepthState {
  explicit DepthState(bool write) {
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_GREATER);
    glDepthMask(write);
    glDisable(GL_BLEND);
  }
  ~DepthState() {
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
    glDepthMask(GL_TRUE);
  }
};

void draw_gbuffer(PassContext& context) {
  static constexpr std::array<std::string_view, 4> all{"albedo", "normal", "emissive", "water_mask"};
  const auto colours = std::span(all).first(context.has("water_mask") ? 4 : 3);
  context.bind_framebuffer(colours, "depth");
  const DepthState state(true);
  const float zero[4] = {0, 0, 0, 0};
  glClearBufferfv(GL_DEPTH, 0, zero);
  for (GLint i = 0; i < static_cast<GLint>(colours.size()); ++i) glClearBufferfv(GL_COLOR, i, zero);
  if (!context.frame.scene) return;
  std::array<const Program*, material_variants> programs;
  for (unsigned v = 0; v < material_variants; ++v) programs[v] = &context.program(variant_name(v));
  draw_instances(*context.frame.scene, context.frame, context.frame.uniforms.view_projection, DrawWhat::opaque,
                 programs);
}

void draw_glass(PassContext& context) {
  if (!context.frame.scene) return;
  static constexpr std::array<std::string_view, 1> colours{"colour"};
  context.bind_framebuffer(colours, "depth");
  const DepthState state(false);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);  // what the shader gives is premultiplied
  // The environment is captured by lighting; without it the sky's gradient stands in.
  const bool environment = context.has("environment");
  if (environment) context.bind_texture(7, "environment");
  // Panes on the plane that pass "mirrors" drew show its picture.
  const bool mirrors = context.has("mirrors") && context.frame.mirrors && context.frame.mirrors->pane;
  if (mirrors) context.bind_texture(9, "mirrors");
  const char* const sky = mirrors ? "glass_sky_mirrors" : "glass_sky";
  context.program(!environment ? sky : mirrors ? "glass_environment_mirrors" : "glass_environment").use();
  draw_instances(*context.frame.scene, context.frame, context.frame.uniforms.view_projection, DrawWhat::blended);
}

}  // namespace

std::vector<PassOffer> geometry_passes() {
  const std::vector<std::string> glass_files{"systems/geometry/gbuffer.vert.glsl", "systems/geometry/glass.frag.glsl"};
  std::vector<PassOffer> offers;
  offers.push_back({"gbuffer",
                    "depth and materials of the opaque surfaces",
                    {{"depth", SlotAccess::write},
                     {"albedo", SlotAccess::write},
                     {"normal", SlotAccess::write},
                     {"emissive", SlotAccess::write},
                     {"water_mask", SlotAccess::write, true}},
                    {},
                    gbuffer_shaders(),
                    {},
                    draw_gbuffer});
  offers.push_back(
      {"glass",
       "thin panes over the lit picture: the sky's reflection, tint",
       {{"colour", SlotAccess::modify},
        {"depth", SlotAccess::read},
        {"environment", SlotAccess::read, true},
        {"mirrors", SlotAccess::read, true}},
       {},
       {{"glass_sky", {glass_files, {"MATERIAL_VARIANT 16"}}},
        {"glass_environment", {glass_files, {"MATERIAL_VARIANT 16", "ENVIRONMENT"}}},
        {"glass_sky_mirrors", {glass_files, {"MATERIAL_VARIANT 16", "MIRRORS"}}},
        {"glass_environment_mirrors", {glass_files, {"MATERIAL_VARIANT 16", "ENVIRONMENT", "MIRRORS"}}}},
       [](const Frame& frame) { return frame.scene && has_blended(*frame.scene, frame); },
       draw_glass});
  return offers;
}

}  // namespace petrichor
