#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "engine/gpu/objects.hpp"
#include "systems/drops/sums.hpp"
#include "systems/frame.hpp"
#include "systems/in_view.hpp"
#include "systems/mirror_frame.hpp"
#include "systems/reflection/choose.hpp"
#include "systems/reflection/reflection.hpp"

namespace petrichor {
namespace {

// Texture units of the shaders here beyond those of the G-buffer (0 to 3) and of lighting (6, 7).
constexpr int phases_unit = 4, own_unit = 5, environment_unit = 7, mirrors_unit = 9, probes_unit = 10;
constexpr int pyramid_levels = 6;

// Of the passes' own; pure functions of the frame, kept only to save making them.
struct ReflectionState {
  Buffer reflectors, tiles;
  Texture lists, pyramid, phases, streaks[2], black;
  Framebuffer canvas;
  bool software = false, device_known = false;
  bool listed = false;  // this frame's tiles, until pass reflections_over has used them
};
using State = std::shared_ptr<ReflectionState>;

bool fits(const Texture& texture, int width, int height) {
  return texture.id != 0 && texture.width == width && texture.height == height;
}

float share(const Frame& frame, ReflectionRung rung) {
  return frame.techniques.share(Effect::reflections, rung);
}
float rays_share(const Frame& frame) {
  return share(frame, ReflectionRung::screen_space) + share(frame, ReflectionRung::planar);
}

bool wanted(const Frame& frame) {
  return frame.scene && frame.reflectors && share(frame, ReflectionRung::environment) < 1.0f &&
         any_surface_in_view(frame);
}

void bind_gbuffer(PassContext& context, bool emissive) {
  context.bind_texture(0, "depth");
  context.bind_texture(1, "albedo");
  context.bind_texture(2, "normal");
  if (emissive) context.bind_texture(3, "emissive");
}

// Software OpenGL pays for each variant of a shader as for each lookup: what there is none of is black.
const Texture& black(ReflectionState& state) {
  if (state.black.id == 0) {
    state.black = make_texture_2d(1, 1, GL_RGBA16F);
    clear_texture(state.black);
  }
  return state.black;
}

void bind_environment(ReflectionState& state, PassContext& context) {
  if (context.has("environment"))
    context.bind_texture(environment_unit, "environment");
  else
    glBindTextureUnit(environment_unit, black(state).id);
}

// The chosen reflectors, and of each how much the picture shows.
unsigned upload_reflectors(ReflectionState& state, PassContext& context, bool with_lamps) {
  const ReflectorsGpu chosen = choose_reflectors(context.frame, context.frame.reflectors->all, with_lamps);
  upload(state.reflectors, &chosen, sizeof chosen);
  if (chosen.counts.x > 0) {
    const Program& seen = context.program("seen");
    seen.use();
    context.bind_texture(0, "depth");
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, REFLECTORS_STORAGE_BINDING, state.reflectors.id);
    seen.dispatch(static_cast<int>(chosen.counts.x));
    glMemoryBarrier(GL_UNIFORM_BARRIER_BIT);
  }
  glBindBufferBase(GL_UNIFORM_BUFFER, REFLECTORS_BINDING, state.reflectors.id);
  return chosen.counts.x;
}

// The published way: billboards into a half-size buffer, then a vertical streak of it, step by step.
void draw_streaks(ReflectionState& state, PassContext& context, int width, int height) {
  if (!fits(state.streaks[0], width, height)) {
    for (Texture& t : state.streaks) t = make_texture_2d(width, height, GL_RGBA16F);
    const GLuint colour[] = {state.streaks[0].id};
    state.canvas = make_framebuffer(colour, 0);
  }
  clear_texture(state.streaks[0]);
  const unsigned count = upload_reflectors(state, context, true);
  const Program& impostor = context.program("impostor");
  impostor.use();
  impostor.set("ground_m", context.parameter("ground_m") - static_cast<float>(context.frame.camera.position_m.y));
  impostor.set("stretch", context.parameter("stretch"));
  impostor.set("saturation", context.parameter("saturation"));
  impostor.set("count", count);
  glBindFramebuffer(GL_FRAMEBUFFER, state.canvas);
  glViewport(0, 0, width, height);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  VertexArray none;
  GLuint id = 0;
  glCreateVertexArrays(1, &id);
  none = VertexArray(id);
  glBindVertexArray(none);
  if (count > 0) glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(count));
  glBindVertexArray(0);
  glDisable(GL_BLEND);
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT);

  const Program& blur = context.program("blur");
  blur.use();
  const int steps = 2 * std::clamp(static_cast<int>(context.parameter("blur_steps")) / 2, 0, 4);  // back where it began
  for (int i = 0; i < steps; ++i) {
    glBindTextureUnit(0, state.streaks[i & 1].id);
    glBindImageTexture(0, state.streaks[(i + 1) & 1].id, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA16F);
    blur.set("offset", (0.5f + static_cast<float>(i)) * static_cast<float>(height) / 384.0f);
    blur.dispatch(width, height);
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  }
}

void draw_pyramid(ReflectionState& state, PassContext& context, int width, int height) {
  const int levels = std::min(pyramid_levels, full_mip_levels(width, height));
  if (!fits(state.pyramid, width, height)) state.pyramid = make_texture_2d(width, height, GL_RGBA16F, levels);
  for (int level = 0; level < levels; ++level) {
    const Program& shrink = context.program(level == 0 ? "pyramid_first" : "pyramid");
    shrink.use();
    if (level == 0) {
      context.bind_texture(0, "colour");
      context.bind_texture(3, "emissive");
    } else {
      glBindTextureUnit(0, state.pyramid.id);
    }
    shrink.set("source_level", std::max(level - 1, 0));
    glBindImageTexture(0, state.pyramid.id, level, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA16F);
    shrink.dispatch(std::max(width >> level, 1), std::max(height >> level, 1));
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  }
}

// Lists the tiles that have work. every_tile: all that mirror, not only those that a reflector can be seen in.
void draw_lists(ReflectionState& state, PassContext& context, double threshold, bool every_tile) {
  const int side = 2 * REFLECTION_TILE;
  const int across = (context.width + side - 1) / side, down = (context.height + side - 1) / side;
  if (!fits(state.lists, across, down)) state.lists = make_texture_2d(across, down, GL_RGBA32UI);
  const std::size_t bytes =
      (REFLECTION_TILES_HEADER + static_cast<std::size_t>(across) * static_cast<std::size_t>(down)) * sizeof(unsigned);
  if (state.tiles.bytes < bytes) state.tiles = make_buffer(bytes);
  const unsigned header[REFLECTION_TILES_HEADER] = {0, 1, 1, 0, 0, 1, 1, 0};
  glNamedBufferSubData(state.tiles.id, 0, sizeof header, header);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, REFLECTION_TILES_BINDING, state.tiles.id);
  if (!state.device_known) state.software = is_software_gl();
  state.device_known = true;
  const Program& lists = context.program(state.software ? "lists_software" : "lists");
  lists.use();
  bind_gbuffer(context, false);
  lists.set("threshold", static_cast<float>(threshold));
  lists.set("every_tile", every_tile ? 1u : 0u);
  int probes = 0;
  if (context.frame.mirrors)
    for (const FrameMirrors::Probe& probe : context.frame.mirrors->probes) {
      if (probes == 4) break;
      const glm::vec3 place(probe.place_m - context.frame.camera.position_m);
      lists.set("probe_spheres[" + std::to_string(probes++) + "]", glm::vec4(place, probe.radius_m));
    }
  lists.set("probe_count", probes);
  lists.set("backdrop", glm::max(context.frame.sky.horizon_cd_m2, glm::vec3(0.3f)));
  glBindImageTexture(0, state.lists.id, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA32UI);
  const int threads = state.software ? 1 : REFLECTION_TILE;  // a side, of a tile
  lists.dispatch(threads * across, threads * down);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                  GL_COMMAND_BARRIER_BIT);
  state.listed = true;
}

void dispatch_tiles(const ReflectionState& state, std::size_t command) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, REFLECTION_TILES_BINDING, state.tiles.id);
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, state.tiles.id);
  glDispatchComputeIndirect(static_cast<GLintptr>(command * 4 * sizeof(unsigned)));
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, 0);
}

// Whether something but reflectors may show in any tile that mirrors.
bool shows_everywhere(const Frame& frame) {
  return rays_share(frame) > 0.0f || share(frame, ReflectionRung::toyshop) > 0.0f;
}

void draw_reflections(ReflectionState& state, PassContext& context) {
  const Texture& target = context.texture("reflections");
  const Frame& frame = context.frame;
  const float impostors = share(frame, ReflectionRung::impostors), rays = rays_share(frame);
  if (share(frame, ReflectionRung::toyshop) > 0.0f) draw_streaks(state, context, target.width, target.height);
  if (impostors + rays <= 0.0f) return;
  if (rays > 0.0f) draw_pyramid(state, context, target.width, target.height);
  upload_reflectors(state, context, false);
  draw_lists(state, context, context.parameter("threshold"), shows_everywhere(frame));
  clear_texture(target);  // tiles without work

  const Texture* drawn = &target;
  if (rays > 0.0f) {
    if (!fits(state.phases, target.width, target.height))
      state.phases = make_texture_2d(target.width, target.height, GL_RGBA16F);
    drawn = &state.phases;
  }
  const Program& program = context.program(rays > 0.0f ? "rays" : "impostors");
  program.use();
  bind_gbuffer(context, true);
  glBindTextureUnit(own_unit, state.lists.id);
  if (rays > 0.0f) glBindTextureUnit(9, state.pyramid.id);
  bind_environment(state, context);
  program.set("impostor_share", impostors);
  if (rays > 0.0f) {
    program.set("screen_share", rays);
    program.set("ray_count", static_cast<int>(context.parameter("rays")));
    program.set("ray_steps", static_cast<int>(context.parameter("steps")));
  }
  glBindImageTexture(0, drawn->id, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA16F);
  dispatch_tiles(state, 0);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  if (rays <= 0.0f) return;
  const Program& smooth = context.program("smooth");
  smooth.use();
  glBindTextureUnit(phases_unit, state.phases.id);
  glBindImageTexture(0, target.id, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA16F);
  dispatch_tiles(state, 0);
}

PassOffer reflections(State state) {
  const std::vector<std::string> main{"systems/reflection/reflections.comp.glsl"};
  return {"reflections",
          "what wet and glossy surfaces mirror of lamps, lit panels, posts and the picture itself, half size",
          {{"depth", SlotAccess::read},
           {"albedo", SlotAccess::read},
           {"normal", SlotAccess::read},
           {"emissive", SlotAccess::read},
           {"highlights", SlotAccess::read, true},  // connected: pass shade leaves to this one what it draws
           {"colour", SlotAccess::read},
           {"environment", SlotAccess::read, true},
           {"reflections", SlotAccess::write}},
          // threshold: of a white pixel; what adds less in a tile is left out. rays, steps: of screen_space. The rest
          // are the published rung's: height of the plane that mirrors, how far a reflection is drawn out a metre of
          // distance, how much its colour is saturated, steps of the vertical blur.
          {{"threshold", 0.004},
           {"rays", 1},
           {"steps", 24},
           {"ground_m", 0.0},
           {"stretch", 0.12},
           {"saturation", 1.5},
           {"blur_steps", 4}},
          {{"seen", {{"systems/reflection/reflectors_seen.comp.glsl"}, {}}},
           {"lists", {{"systems/reflection/reflection_lists.comp.glsl"}, {}}},
           {"lists_software", {{"systems/reflection/reflection_lists.comp.glsl"}, {"SOFTWARE"}}},
           {"pyramid_first", {{"systems/reflection/picture_pyramid.comp.glsl"}, {"FIRST"}}},
           {"pyramid", {{"systems/reflection/picture_pyramid.comp.glsl"}, {}}},
           {"impostor", {{"systems/reflection/impostor.vert.glsl", "systems/reflection/impostor.frag.glsl"}, {}}},
           {"blur", {{"systems/reflection/streak_blur.comp.glsl"}, {}}},
           {"rays", {main, {"SCREEN_SPACE"}}},
           {"smooth", {{"systems/reflection/reflections_smooth.comp.glsl"}, {}}},
           {"impostors", {main, {}}}},
          wanted,
          [state](PassContext& context) { draw_reflections(*state, context); }};
}

void lay_reflections_over(ReflectionState& state, PassContext& context) {
  const Frame& frame = context.frame;
  const float toyshop = share(frame, ReflectionRung::toyshop);
  const float drawn = share(frame, ReflectionRung::impostors) + rays_share(frame);
  const bool rays = drawn > 0.0f;
  const bool mirrors = context.has("mirrors") && share(frame, ReflectionRung::planar) > 0.0f;
  const bool probes = context.has("probes");
  const float edges = context.parameter("published_edges");
  if (!rays && toyshop <= 0.0f && !mirrors && !probes) return;
  std::string name = toyshop > 0.0f ? "toyshop" : "rays";
  if (mirrors) name += "_mirrors";
  if (probes) name += "_probes";
  if (!state.listed) {  // pass reflections had nothing to do
    const ReflectorsGpu none{};
    upload(state.reflectors, &none, sizeof none);
    glBindBufferBase(GL_UNIFORM_BUFFER, REFLECTORS_BINDING, state.reflectors.id);
    draw_lists(state, context, 1.0, true);
  }
  state.listed = false;
  const Program& over = context.program(name);
  over.use();
  bind_gbuffer(context, true);
  const auto bind = [&](int unit, bool there, std::string_view slot) {
    if (there)
      context.bind_texture(unit, slot);
    else
      glBindTextureUnit(static_cast<GLuint>(unit), black(state).id);
  };
  bind(4, rays, "reflections");
  bind_environment(state, context);
  if (toyshop > 0.0f) glBindTextureUnit(own_unit, state.streaks[0].id);
  if (mirrors) context.bind_texture(mirrors_unit, "mirrors");
  if (probes) context.bind_texture(probes_unit, "probes");
  over.set("toyshop_share", toyshop);
  over.set("drawn_share", drawn);
  over.set("planar_share", share(frame, ReflectionRung::planar));
  over.set("edge_exponent", context.parameter("edge_exponent"));
  over.set("distortion", context.parameter("distortion"));
  over.set("published_edges", edges);
  context.bind_image(0, "colour", GL_READ_WRITE);
  dispatch_tiles(state, 1);
}

PassOffer reflections_over(State state) {
  std::unordered_map<std::string, ShaderKey> shaders{
      {"lists", {{"systems/reflection/reflection_lists.comp.glsl"}, {}}},
      {"lists_software", {{"systems/reflection/reflection_lists.comp.glsl"}, {"SOFTWARE"}}}};
  for (const bool toyshop : {false, true})
    for (const bool mirrors : {false, true})
      for (const bool probes : {false, true}) {
        std::vector<std::string> defines;
        if (toyshop) defines.push_back("TOYSHOP");
        if (mirrors) defines.push_back("WITH_MIRRORS");
        if (probes) defines.push_back("WITH_PROBES");
        shaders[std::string(toyshop ? "toyshop" : "rays") + (mirrors ? "_mirrors" : "") + (probes ? "_probes" : "")] = {
            {"systems/reflection/reflections_over.comp.glsl"}, defines};
      }
  return {"reflections_over",
          "what is really mirrored, in place of the captured surroundings",
          {{"colour", SlotAccess::modify},
           {"depth", SlotAccess::read},
           {"albedo", SlotAccess::read},
           {"normal", SlotAccess::read},
           {"emissive", SlotAccess::read},
           {"environment", SlotAccess::read, true},
           {"mirrors", SlotAccess::read, true},
           {"probes", SlotAccess::read, true},
           {"reflections", SlotAccess::read, true}},
          // Of Tatarchuk and Isidoro 2006, 6.3: edge_exponent f_o; distortion by the normal; published_edges: 1 lays
          // their k_a over every rung, 0 leaves the physical Fresnel term alone.
          {{"edge_exponent", 5.0}, {"distortion", 0.25}, {"published_edges", 0.0}},
          shaders,
          [](const Frame& frame) {
            return wanted(frame) || (frame.scene && frame.mirrors && any_surface_in_view(frame));
          },
          [state](PassContext& context) { lay_reflections_over(*state, context); }};
}

}  // namespace

std::vector<PassOffer> reflection_passes() {
  const auto state = std::make_shared<ReflectionState>();
  std::vector<PassOffer> offers;
  offers.push_back(reflections(state));
  offers.push_back(reflections_over(state));
  return offers;
}

}  // namespace petrichor
