#include "systems/lighting/passes.hpp"

#include <string>

#include "systems/gpu_scene.hpp"
#include "systems/lighting/chosen_lights.hpp"
#include "systems/lighting/state.hpp"
#include "systems/mirror_frame.hpp"

namespace petrichor {
namespace {

using State = std::shared_ptr<LightingState>;

// Units of the shaders here (gbuffer.glsl takes 0 to 3).
constexpr int light_lists_unit = 4, shadow_unit = 6, environment_unit = 7;

void bind_gbuffer(PassContext& context) {
  context.bind_texture(0, "depth");
  context.bind_texture(1, "albedo");
  context.bind_texture(2, "normal");
  context.bind_texture(3, "emissive");
}

// The slots of the atlas hold only while somebody drew it this frame.
std::span<const int> shadow_slots(const LightingState& state, const PassContext& context) {
  return context.has("shadow_atlas") ? std::span<const int>(state.shadows.slots) : std::span<const int>();
}

// Empty lists with room for all tiles in each.
void start_tiles(LightingState& state, unsigned tiles) {
  const std::size_t bytes = (TILES_HEADER + std::size_t{TILES_KINDS} * tiles) * sizeof(unsigned);
  if (state.tiles.bytes < bytes) state.tiles = make_buffer(bytes);
  state.list_length = tiles;
  const unsigned header[TILES_HEADER] = {0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 1, 0};
  glNamedBufferSubData(state.tiles.id, 0, sizeof header, header);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, TILES_BINDING, state.tiles.id);
}

PassOffer shadow_maps(State state) {
  return {"shadow_maps",
          "octahedral variance shadow maps of the lights that cast shadows, kept while nothing moves",
          {{"shadow_atlas", SlotAccess::write}},
          {},
          {{"depth", {{"systems/geometry/depth.vert.glsl", "systems/geometry/depth.frag.glsl"}, {}}},
           {"moments", {{"systems/lighting/shadow_moments.comp.glsl"}, {}}},
           {"pack", {{"systems/lighting/shadow_pack.comp.glsl"}, {}}}},
          [](const Frame& frame) { return frame.scene && !shadow_casters(frame).empty(); },
          [state](PassContext& context) {
            update_shadow_maps(state->shadows, context.frame, context.texture("shadow_atlas"),
                               context.fresh("shadow_atlas"),
                               {context.program("depth"), context.program("moments"), context.program("pack")});
          }};
}

PassOffer environment(State state) {
  return {"environment",
          "the surroundings captured near the camera: light from all round, diffuse and mirrored",
          {{"environment", SlotAccess::write}, {"shadow_atlas", SlotAccess::read, true}},
          {{"spacing_m", 6.0}},
          {{"surfaces",
            {{"systems/geometry/gbuffer.vert.glsl", "systems/geometry/gbuffer.frag.glsl"},
             {"MATERIAL_VARIANT " + std::to_string(static_cast<unsigned>(variant_general))}}},
           {"light", {{"systems/lighting/environment_light.comp.glsl"}, {}}},
           {"light_shadows", {{"systems/lighting/environment_light.comp.glsl"}, {"SHADOWS"}}},
           {"filter", {{"systems/lighting/environment_filter.comp.glsl"}, {}}},
           {"harmonics", {{"systems/lighting/environment_sh.comp.glsl"}, {}}},
           {"diffuse", {{"systems/lighting/environment_diffuse.comp.glsl"}, {}}},
           {"blend", {{"systems/lighting/environment_blend.comp.glsl"}, {}}}},
          {},
          [state](PassContext& context) {
            const bool shadows = context.has("shadow_atlas");
            const EnvironmentPrograms programs{
                context.program("surfaces"), context.program(shadows ? "light_shadows" : "light"),
                context.program("filter"),   context.program("harmonics"),
                context.program("diffuse"),  context.program("blend")};
            update_environment(state->environment, context.frame, context.parameter("spacing_m"),
                               shadows ? &context.texture("shadow_atlas") : nullptr, shadow_slots(*state, context),
                               programs, context.texture("environment"));
          }};
}

PassOffer probes(State state) {
  return {"probes",
          "cube maps about moving objects: what they mirror",
          {{"probes", SlotAccess::write}, {"shadow_atlas", SlotAccess::read, true}},
          {{"step_m", 1.0}},  // of the grid of places that captures are made at: chart `probes`
          {{"surfaces",
            {{"systems/geometry/gbuffer.vert.glsl", "systems/geometry/gbuffer.frag.glsl"},
             {"MATERIAL_VARIANT " + std::to_string(static_cast<unsigned>(variant_general))}}},
           {"light", {{"systems/lighting/environment_light.comp.glsl"}, {}}},
           {"light_shadows", {{"systems/lighting/environment_light.comp.glsl"}, {"SHADOWS"}}},
           {"filter", {{"systems/lighting/environment_filter.comp.glsl"}, {}}},
           {"blend", {{"systems/lighting/probe_blend.comp.glsl"}, {}}}},
          [](const Frame& frame) {
            if (!frame.scene || !frame.mirrors || frame.techniques.share(Effect::probes, ProbeRung::moving) <= 0.0f)
              return false;
            for (const FrameMirrors::Probe& probe : frame.mirrors->probes)
              if (probe.coverage > 0.0f) return true;
            return false;
          },
          [state](PassContext& context) {
            const bool shadows = context.has("shadow_atlas");
            const ProbePrograms programs{context.program("surfaces"),
                                         context.program(shadows ? "light_shadows" : "light"),
                                         context.program("filter"), context.program("blend")};
            update_probes(state->probes, context.frame, context.parameter("step_m"),
                          shadows ? &context.texture("shadow_atlas") : nullptr, shadow_slots(*state, context), programs,
                          context.texture("probes"));
          }};
}

PassOffer light_lists(State state) {
  return {"light_lists",
          "which lights matter in each tile of 8x8 pixels",
          {{"depth", SlotAccess::read},
           {"albedo", SlotAccess::read},
           {"normal", SlotAccess::read},
           {"shadow_atlas", SlotAccess::read, true},
           {"light_lists", SlotAccess::write}},
          {{"threshold", 0.003}},  // of a white pixel
          {{"plain", {{"systems/lighting/light_lists.comp.glsl"}, {}}},
           {"shadows", {{"systems/lighting/light_lists.comp.glsl"}, {"SHADOWS"}}}},
          {},
          [state](PassContext& context) {
            const ChosenLights chosen = choose_lights(context.frame, shadow_slots(*state, context));
            upload(state->chosen_lights, &chosen, sizeof chosen);
            glBindBufferBase(GL_UNIFORM_BUFFER, CHOSEN_LIGHTS_BINDING, state->chosen_lights.id);
            const bool shadows = context.has("shadow_atlas");
            const Program& lists = context.program(shadows ? "shadows" : "plain");
            lists.use();
            if (shadows) context.bind_texture(shadow_unit, "shadow_atlas");
            lists.set("threshold", context.parameter("threshold"));
            context.bind_texture(0, "depth");
            context.bind_texture(1, "albedo");
            context.bind_texture(2, "normal");
            context.bind_image(0, "light_lists", GL_WRITE_ONLY);
            const int across = (context.width + LIGHT_TILE - 1) / LIGHT_TILE;
            const int down = (context.height + LIGHT_TILE - 1) / LIGHT_TILE;
            start_tiles(*state, static_cast<unsigned>(across * down));
            lists.set("list_length", state->list_length);
            lists.dispatch(across, down);
          }};
}

// One kind of tiles after the other, each by the shader that does no more than they need.
void shade_tiles(const LightingState& state, PassContext& context) {
  const bool shadows = context.has("shadow_atlas"), environment = context.has("environment");
  bind_gbuffer(context);
  context.bind_texture(light_lists_unit, "light_lists");
  if (shadows) context.bind_texture(shadow_unit, "shadow_atlas");
  if (environment) context.bind_texture(environment_unit, "environment");
  context.bind_image(0, "colour", GL_WRITE_ONLY);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, TILES_BINDING, state.tiles.id);
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, state.tiles.id);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
  // The published billboards are the lamps, too, and the other rungs draw windows and signs: nothing may shine twice.
  const Techniques& by = context.frame.techniques;
  const float lamps_elsewhere =
      context.has("highlights") ? by.share(Effect::reflections, ReflectionRung::toyshop) : 0.0f;
  const float panels_elsewhere = context.has("highlights") && context.frame.reflectors
                                     ? by.share(Effect::reflections, ReflectionRung::impostors) +
                                           by.share(Effect::reflections, ReflectionRung::screen_space) +
                                           by.share(Effect::reflections, ReflectionRung::planar)
                                     : 0.0f;
  const auto shade = [&](unsigned kind, std::string_view program_name) {
    const Program& program = context.program(program_name);
    program.use();
    program.set("diffuse_gain", context.parameter("diffuse_gain"));
    program.set("lamps_elsewhere", lamps_elsewhere);
    program.set("panels_elsewhere", panels_elsewhere);
    program.set("list_start", TILES_HEADER + kind * state.list_length);
    glDispatchComputeIndirect(static_cast<GLintptr>(kind * 4 * sizeof(unsigned)));
  };
  shade(TILES_SKY, "sky");
  shade(TILES_LIT, environment ? "environment" : "plain");
  if (shadows) shade(TILES_SHADOWED, environment ? "shadows_environment" : "shadows");
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, 0);
}

PassOffer shade(State state) {
  const std::vector<std::string> files{"systems/lighting/shade.comp.glsl"};
  return {"shade",
          "lamps, surroundings and own light on every surface, and the sky: cd/m2",
          {{"depth", SlotAccess::read},
           {"albedo", SlotAccess::read},
           {"normal", SlotAccess::read},
           {"emissive", SlotAccess::read},
           {"light_lists", SlotAccess::read},
           {"shadow_atlas", SlotAccess::read, true},
           {"environment", SlotAccess::read, true},
           {"highlights", SlotAccess::write, true},  // of lamps: connected where pass reflections may take them over
           {"colour", SlotAccess::write}},
          {{"diffuse_gain", 1.0}},
          {{"sky", {files, {"SKY"}}},
           {"plain", {files, {}}},
           {"shadows", {files, {"SHADOWS"}}},
           {"environment", {files, {"ENVIRONMENT"}}},
           {"shadows_environment", {files, {"SHADOWS", "ENVIRONMENT"}}}},
          {},
          [state](PassContext& context) { shade_tiles(*state, context); }};
}

}  // namespace

std::vector<PassOffer> lighting_passes(std::shared_ptr<LightingState> state) {
  if (!state) state = std::make_shared<LightingState>();
  std::vector<PassOffer> offers;
  offers.push_back(shadow_maps(state));
  offers.push_back(environment(state));
  offers.push_back(probes(state));
  offers.push_back(light_lists(state));
  offers.push_back(shade(state));
  return offers;
}

}  // namespace petrichor
