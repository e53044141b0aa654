#include <array>
#include <cmath>
#include <string>

#include "systems/borrowed_block.hpp"
#include "systems/drops/sums.hpp"
#include "systems/gpu_scene.hpp"
#include "systems/mirror/camera.hpp"
#include "systems/mirror/mirror.hpp"

namespace petrichor {
namespace {

constexpr int shadow_unit = 6, environment_unit = 7;

struct MirrorState {
  Texture depth, albedo, normal, emissive;  // of one plane after the other
  Framebuffer framebuffer;
  Buffer block, constants[MIRROR_PLANES];
  bool software = false, device_known = false;
};

std::string variant_name(unsigned variant) {
  return "variant_" + std::to_string(variant);
}

std::unordered_map<std::string, ShaderKey> mirror_shaders() {
  std::unordered_map<std::string, ShaderKey> shaders;
  for (unsigned v = 0; v < material_variants; ++v)  // the same programs as the G-buffer's
    shaders[variant_name(v)] = {{"systems/geometry/gbuffer.vert.glsl", "systems/geometry/gbuffer.frag.glsl"},
                                {"MATERIAL_VARIANT " + std::to_string(v)}};
  const std::vector<std::string> light{"systems/mirror/mirror_light.comp.glsl"};
  shaders["light"] = {light, {}};
  shaders["light_shadows"] = {light, {"SHADOWS"}};
  shaders["light_environment"] = {light, {"ENVIRONMENT"}};
  shaders["light_shadows_environment"] = {light, {"SHADOWS", "ENVIRONMENT"}};
  shaders["blur"] = {{"systems/mirror/mirror_blur.comp.glsl"}, {}};
  return shaders;
}

void make_targets(MirrorState& state, const glm::ivec2& size) {
  if (state.depth.id && state.depth.width == size.x && state.depth.height == size.y) return;
  state.depth = make_texture_2d(size.x, size.y, GL_DEPTH_COMPONENT32F);
  state.albedo = make_texture_2d(size.x, size.y, GL_RGBA8);
  state.normal = make_texture_2d(size.x, size.y, GL_RGBA16);
  state.emissive = make_texture_2d(size.x, size.y, GL_R11F_G11F_B10F);
  const std::array<GLuint, 3> colours{state.albedo.id, state.normal.id, state.emissive.id};
  state.framebuffer = make_framebuffer(colours, state.depth.id);
}

// The clip matrix of a window of the picture, for culling: what is outside the drawn rectangle is not even sent.
glm::mat4 cropped(const glm::mat4& clip, const glm::vec4& rect) {
  const glm::vec2 centre(rect.x + rect.z - 1.0f, rect.y + rect.w - 1.0f), half(rect.z - rect.x, rect.w - rect.y);
  glm::mat4 out = clip;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 2; ++row)
      out[column][row] = (clip[column][row] - centre[row] * clip[column][3]) / half[row];
  return out;
}

void draw_surfaces(MirrorState& state, PassContext& context, const MirrorGpu& mirror, Buffer& constants,
                   const glm::ivec2& size) {
  const BorrowedBlock block(FRAME_UNIFORMS_BINDING);
  FrameUniforms own = context.frame.uniforms;
  own.view_projection = mirror.picture_from_relative;
  upload(constants, &own, sizeof own);
  glBindBufferRange(GL_UNIFORM_BUFFER, FRAME_UNIFORMS_BINDING, constants.id, 0, sizeof own);
  clear_texture(state.depth);  // the rest is read only where something was drawn
  glBindFramebuffer(GL_FRAMEBUFFER, state.framebuffer);
  glViewport(0, 0, size.x, size.y);
  const glm::ivec2 low(glm::floor(glm::vec2(mirror.rect) * glm::vec2(size)));
  const glm::ivec2 high(glm::ceil(glm::vec2(mirror.rect.z, mirror.rect.w) * glm::vec2(size)));
  glEnable(GL_SCISSOR_TEST);
  glScissor(low.x, low.y, high.x - low.x, high.y - low.y);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  std::array<const Program*, material_variants> programs;
  for (unsigned v = 0; v < material_variants; ++v) programs[v] = &context.program(variant_name(v));
  draw_instances(*context.frame.scene, context.frame, cropped(mirror.picture_from_relative, mirror.rect),
                 DrawWhat::opaque, programs);
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void light_surfaces(MirrorState& state, PassContext& context, int layer, const glm::ivec2& size) {
  const bool shadows = context.has("shadow_atlas"), environment = context.has("environment");
  const Program& light =
      context.program(std::string("light") + (shadows ? "_shadows" : "") + (environment ? "_environment" : ""));
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
  const GLuint inputs[] = {state.depth.id, state.albedo.id, state.normal.id, state.emissive.id};
  glBindTextures(0, 4, inputs);
  if (shadows) context.bind_texture(shadow_unit, "shadow_atlas");
  if (environment) context.bind_texture(environment_unit, "environment");
  const Texture& picture = context.texture("mirrors");
  glBindImageTexture(0, picture.id, 0, GL_FALSE, layer, GL_WRITE_ONLY, GL_RGBA16F);
  light.use();
  light.set("layer", layer);
  // Lamps show on wet ground as the highlights of their own intensities already: there what shines is cut as in the
  // environment. Panes have no highlights: theirs shine as they are.
  light.set("brightest", context.parameter(layer == 0 ? "brightest_in_water_cd_m2" : "brightest_in_panes_cd_m2"));
  light.set("threshold", context.parameter("threshold"));
  light.dispatch(size.x, size.y);

  const Program& blur = context.program("blur");
  blur.use();
  glm::ivec2 finer = size;
  for (int level = 1; level < picture.levels; ++level) {
    const glm::ivec2 whole(std::max(picture.width >> level, 1), std::max(picture.height >> level, 1));
    const glm::ivec2 coarser = glm::min((finer + 1) / 2, whole);
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    glBindImageTexture(0, picture.id, level - 1, GL_FALSE, layer, GL_READ_ONLY, GL_RGBA16F);
    glBindImageTexture(1, picture.id, level, GL_FALSE, layer, GL_WRITE_ONLY, GL_RGBA16F);
    blur.set("finer_size", finer);
    blur.set("coarser_size", coarser);
    blur.dispatch(coarser.x, coarser.y);
    finer = coarser;
  }
}

void draw_mirrors(MirrorState& state, PassContext& context) {
  if (!state.device_known) state.software = is_software_gl();
  state.device_known = true;
  const Texture& picture = context.texture("mirrors");
  // Software draws as many pixels as it can afford: a quarter of the output's width and height.
  const int share = state.software ? static_cast<int>(context.parameter("software_share")) : 1;
  const glm::ivec2 texture(picture.width, picture.height), used = (texture + share - 1) / share;
  const MirrorsGpu gpu = mirrors_of(context.frame, used, texture, picture.levels);
  upload(state.block, &gpu, sizeof gpu);
  glBindBufferRange(GL_UNIFORM_BUFFER, MIRRORS_BINDING, state.block.id, 0, sizeof gpu);
  make_targets(state, used);
  for (int layer = 0; layer < MIRROR_PLANES; ++layer) {
    if (gpu.planes[layer].more.x <= 0.0f) continue;
    draw_surfaces(state, context, gpu.planes[layer], state.constants[layer], used);
    light_surfaces(state, context, layer, used);
  }
}

}  // namespace

std::vector<PassOffer> mirror_passes() {
  PassOffer offer;
  offer.name = "mirrors";
  offer.meaning = "the scene mirrored in the stillest water and the largest pane in view";
  // light_lists binds the block of chosen lamps.
  offer.slots = {{"light_lists", SlotAccess::read},
                 {"shadow_atlas", SlotAccess::read, true},
                 {"environment", SlotAccess::read, true},
                 {"mirrors", SlotAccess::write}};
  offer.parameters = {{"brightest_in_water_cd_m2", 30.0},
                      {"brightest_in_panes_cd_m2", 60000.0},
                      {"threshold", 0.003},  // of a white pixel: lamps that add less to a tile are left out
                      {"software_share", 2.0}};
  offer.shaders = mirror_shaders();
  offer.wanted = [](const Frame& frame) {
    return frame.scene && frame.mirrors && (frame.mirrors->water || frame.mirrors->pane) &&
           frame.techniques.share(Effect::reflections, ReflectionRung::planar) > 0.0f;
  };
  offer.execute = [state = std::make_shared<MirrorState>()](PassContext& context) { draw_mirrors(*state, context); };
  std::vector<PassOffer> offers;
  offers.push_back(std::move(offer));
  return offers;
}

}  // namespace petrichor
