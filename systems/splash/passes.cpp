#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "systems/drip_frame.hpp"
#include "systems/in_view.hpp"
#include "systems/splash/columns.hpp"
#include "systems/splash/crown.hpp"
#include "systems/splash/impact.h"
#include "systems/splash/overhead.hpp"
#include "systems/splash/splash.hpp"
#include "systems/splash/splash_shared.h"

namespace petrichor {
namespace {

struct SplashGpuState {
  Buffer layers, tiles, cells, candidates, command, list, landings, read_back;
  Texture crown;
  std::uint32_t capacity = 0, cell_capacity = 0, candidate_capacity = 0, columns = 0;
  bool software = false, device_known = false, listed = false;
  std::shared_ptr<RainOptics> optics;
  std::shared_ptr<RainSums> sums;
  std::shared_ptr<OverheadState> overhead;
};

std::weak_ptr<SplashGpuState> newest;

// Columns count up to some six times what is there: so many of those wanted may be listed before they are thinned.
std::uint32_t listed_for_each(const SplashGpuState& gpu) {
  return gpu.software ? 3u : 5u;
}

void bind(GLuint binding, const Buffer& buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.id);
}

// What this frame's splashes are limited to, on this device.
struct Limits {
  float reach_m, secondary_reach_m, least_mm;
  std::int32_t most;
};
Limits limits_of(const SplashGpuState& gpu, PassContext& context) {
  const FrameSplashes& s = *context.frame.splashes;
  Limits l{s.reach_m, s.secondary_reach_m, 0.0f, s.most_splashes};
  if (gpu.software && context.parameter("software_most") > 0.0f) {
    l.most = std::min(l.most, static_cast<std::int32_t>(context.parameter("software_most")));
    l.reach_m = std::min(l.reach_m, context.parameter("software_reach"));
    l.secondary_reach_m = std::min(l.secondary_reach_m, context.parameter("software_secondary_reach"));
    l.least_mm = context.parameter("software_least_mm");
  }
  return l;
}

float ambient_of(const Frame& frame) {
  const glm::vec3 sky = 0.5f * (frame.sky.zenith_cd_m2 + frame.sky.horizon_cd_m2);
  return std::max({sky.r, sky.g, sky.b}) * frame.uniforms.lens.w;
}

// Section 3.1: l_b = 1 + k_c (L_1 + L_2); the layered composite carries k_c (L_1 + L_2) for all of the rain.
float lightning_bias(const Frame& frame) {
  return 1.0f + (frame.rain ? frame.rain->layered.lightning : 0.0f);
}

bool is_printed(const Frame& frame) {
  return frame.splashes->published && frame.techniques.share(Effect::splashes, SplashRung::random) > 0.0f;
}

// What a flash adds from all of the sky, cd/m2: l_b - 1 times what the sky gives, and under a black sky a hundredth of
// the picture's white, so that it is seen there too. (No lamp: the scene's own lights of a flash come as lamps do.)
glm::vec3 flash_of(const Frame& frame) {
  const glm::vec3 sky = 0.5f * (frame.sky.zenith_cd_m2 + frame.sky.horizon_cd_m2);
  const float least = 0.01f / std::max(frame.uniforms.lens.w, 1e-12f);
  return (lightning_bias(frame) - 1.0f) * glm::max(sky, glm::vec3(least));
}

void prepare(const SplashGpuState& gpu, PassContext& context, const Program& program, const Limits& limits) {
  const Frame& frame = context.frame;
  const FrameSplashes& s = *frame.splashes;
  program.use();
  program.set("seed", unsigned(frame.rain ? frame.rain->seed : 0u));
  program.set("has_normal", int(context.has("normal")));
  program.set("has_water", int(context.has("water")));
  program.set("has_overhead", int(context.has("overhead")));
  if (context.has("overhead")) {
    program.set("overhead_place",
                overhead_place(*gpu.overhead, frame, context.has("environment") ? overhead_at_camera(frame) : 0.0f));
    program.set("overhead_reach", gpu.overhead->reach_m);
  }
  const float field = frame.techniques.share(Effect::splashes, SplashRung::field),
              secondary = frame.techniques.share(Effect::splashes, SplashRung::secondary);
  program.set("reach", glm::vec4(limits.reach_m, limits.secondary_reach_m, field + secondary, secondary));
  program.set("look", glm::vec4(s.size, s.size_variation, s.opacity, s.opacity_variation));
  program.set("lights_look", glm::vec3(s.backlight, lightning_bias(frame), ambient_of(frame)));
  program.set("flash", is_printed(frame) ? glm::vec3(0.0f) : flash_of(frame));
  program.set("published", int(s.published));
  program.set("capacity", unsigned(gpu.capacity));
  program.set("cell_capacity", unsigned(gpu.cell_capacity));
  program.set("candidate_capacity", unsigned(gpu.candidate_capacity));
  program.set("least_radiance", context.parameter("least_radiance"));
}

void dispatch_wide(std::uint64_t invocations) {
  const std::uint64_t groups = (invocations + 63) / 64, wide = std::min<std::uint64_t>(groups, 16384);
  glDispatchCompute(static_cast<GLuint>(wide), static_cast<GLuint>((groups + wide - 1) / wide), 1);
}

std::string shader_of(const SplashGpuState& gpu, std::string name) {
  return gpu.software ? name + "_software" : name;
}

void list_field(SplashGpuState& gpu, PassContext& context, const Limits& limits) {
  const Frame& frame = context.frame;
  const float secondary = frame.techniques.share(Effect::splashes, SplashRung::secondary);
  const RainLayers columns = splash_columns(*frame.rain, frame.camera, context.width, context.height, limits.reach_m,
                                            limits.least_mm, secondary > 0.0f ? limits.secondary_reach_m : 0.0f);
  gpu.columns = static_cast<std::uint32_t>(columns.candidates);
  if (columns.layers.empty()) return;
  upload(gpu.layers, std::span<const RainLayerGpu>(columns.layers));
  gpu.cell_capacity = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(2 * columns.candidates, 1024, 400000));
  if (gpu.cells.bytes < gpu.cell_capacity * sizeof(SplashCellGpu))
    gpu.cells = make_buffer(std::size_t(gpu.cell_capacity + gpu.cell_capacity / 4) * sizeof(SplashCellGpu));
  bind(RAIN_LAYERS_BINDING, gpu.layers);
  bind(SPLASH_CELLS_BINDING, gpu.cells);
  gpu.candidate_capacity = 4u * gpu.capacity;  // some six for each that is listed
  if (gpu.candidates.bytes < gpu.candidate_capacity * sizeof(glm::uvec2))
    gpu.candidates = make_buffer(gpu.candidate_capacity * sizeof(glm::uvec2));
  bind(SPLASH_CANDIDATES_BINDING, gpu.candidates);
  // Tiles stand still in the world, so that which lamps count does not flicker.
  const int tiles = gpu.software ? 16 : SPLASH_TILES;
  const double side = 2.0 * std::max(limits.reach_m, 0.1f) / (tiles - 2);
  const auto first = [&](double eye) { return static_cast<float>((std::floor(eye / side) - tiles / 2) * side - eye); };
  const glm::vec3 tiling(first(frame.camera.position_m.x), first(frame.camera.position_m.z), static_cast<float>(side));
  if (gpu.tiles.bytes == 0) gpu.tiles = make_buffer(SPLASH_TILES * SPLASH_TILES * sizeof(SplashTileGpu));
  bind(SPLASH_TILES_BINDING, gpu.tiles);
  const Program& light = context.program(shader_of(gpu, "tiles"));
  prepare(gpu, context, light, limits);
  light.set("tiling", tiling);
  light.dispatch(tiles * tiles);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  const Program& find = context.program(shader_of(gpu, "columns"));
  prepare(gpu, context, find, limits);
  find.set("layer_count", static_cast<unsigned>(columns.layers.size()));
  find.set("tiling", tiling);
  find.set("candidates", static_cast<unsigned>(columns.candidates));
  dispatch_wide(columns.candidates);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  const Program& threshold = context.program("threshold");
  threshold.use();
  threshold.set("most", static_cast<float>(listed_for_each(gpu)) * static_cast<float>(limits.most));
  threshold.set("of_listed", 0);
  glDispatchCompute(1, 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
  const Program& drops = context.program(shader_of(gpu, "drops"));
  prepare(gpu, context, drops, limits);
  drops.set("layer_count", static_cast<unsigned>(columns.layers.size()));
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, gpu.command.id);
  glDispatchComputeIndirect(offsetof(SplashCommandGpu, cell_groups));
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
  const Program& impacts = context.program(shader_of(gpu, "impacts"));
  prepare(gpu, context, impacts, limits);
  impacts.set("layer_count", static_cast<unsigned>(columns.layers.size()));
  glDispatchComputeIndirect(offsetof(SplashCommandGpu, candidate_groups));
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  threshold.use();
  threshold.set("most", static_cast<float>(limits.most));
  threshold.set("of_listed", 1);
  glDispatchCompute(1, 1, 1);
}

// As printed: places at random, fixed to the world; how many land is as in the rain.
void list_random(SplashGpuState& gpu, PassContext& context, const Limits& limits) {
  const Frame& frame = context.frame;
  constexpr double period_s = 0.08;
  std::vector<RainLayerGpu> classes;
  double per_m2_s = 0.0;
  for (const RainClass& c : frame.rain->classes) {
    if (!may_splash(c)) continue;
    per_m2_s += double(c.drops_per_m3) * -c.velocity_mps.y;
    RainLayerGpu one{};
    one.velocity_diameter = glm::vec4(c.velocity_mps, c.diameter_mm * 1e-3f);
    one.expected.x = static_cast<float>(per_m2_s);
    classes.push_back(one);
  }
  if (classes.empty()) return;
  for (RainLayerGpu& one : classes) one.expected.x = static_cast<float>(one.expected.x / per_m2_s);
  const double side = 2.0 * limits.reach_m, truly = per_m2_s * side * side * period_s;
  // About a sixth of them is in view, and a quarter of the time of each is its splash's.
  const double most = gpu.software && limits.most < frame.splashes->most_splashes ? 0.3 * limits.most : limits.most;
  const double places = std::max(1.0, std::floor(std::min(truly, 24.0 * most)));
  upload(gpu.layers, std::span<const RainLayerGpu>(classes));
  bind(RAIN_LAYERS_BINDING, gpu.layers);
  const Program& program = context.program(shader_of(gpu, "random"));
  prepare(gpu, context, program, limits);
  const double turns = frame.time_s / period_s, whole = std::floor(turns);
  const auto wrapped = [&](double v) { return static_cast<float>(v - side * std::floor(v / side)); };
  program.set("layer_count", static_cast<unsigned>(classes.size()));
  program.set("places", static_cast<unsigned>(places));
  program.set("square", glm::vec3(static_cast<float>(side), wrapped(frame.camera.position_m.x),
                                  wrapped(frame.camera.position_m.z)));
  program.set("turn", static_cast<unsigned>(static_cast<std::int64_t>(whole)));
  program.set("moment", glm::vec3(0.0f, static_cast<float>(turns - whole), static_cast<float>(period_s)));
  program.set("chances", glm::vec2(frame.techniques.share(Effect::splashes, SplashRung::random),
                                   frame.splashes->published ? 1.0f : static_cast<float>(truly / places)));
  dispatch_wide(static_cast<std::uint64_t>(places));
}

void list_landings(SplashGpuState& gpu, PassContext& context, const Limits& limits) {
  const Frame& frame = context.frame;
  std::vector<SplashLandingGpu> landings;
  const float share = 1.0f - frame.techniques.share(Effect::splashes, SplashRung::none);
  for (const DripLanding& d : frame.drips->landings) {
    const double age = frame.time_s - d.time_s;
    const glm::vec3 place(d.place_m - frame.camera.position_m);
    if (age < 0.0 || age > impact::SECONDARY_LIFE + frame.camera.exposure_s || glm::length(place) > limits.reach_m)
      continue;
    SplashLandingGpu one{};
    one.place_age = glm::vec4(place, static_cast<float>(age));
    one.velocity_diameter = glm::vec4(d.velocity_mps, d.diameter_mm * 1e-3f);
    one.bits = {d.seed, static_cast<std::uint32_t>(share * 65536.0f), 0u, 0u};
    landings.push_back(one);
  }
  if (landings.empty()) return;
  if (landings.size() > 4096) landings.erase(landings.begin(), landings.end() - 4096);
  upload(gpu.landings, std::span<const SplashLandingGpu>(landings));
  bind(SPLASH_LANDINGS_BINDING, gpu.landings);
  const Program& program = context.program(shader_of(gpu, "landings"));
  prepare(gpu, context, program, limits);
  program.set("landing_count", static_cast<unsigned>(landings.size()));
  program.dispatch(static_cast<int>(landings.size()));
}

void list_splashes(SplashGpuState& gpu, PassContext& context) {
  const Frame& frame = context.frame;
  if (!gpu.device_known) gpu.software = is_software_gl();
  gpu.device_known = true;
  gpu.listed = true;
  const Limits limits = limits_of(gpu, context);
  // Twice what is listed on average at most, and more: it is never full, or who came first would count.
  const auto most = static_cast<std::uint32_t>(std::max(limits.most, 0));
  gpu.capacity = std::min(2u * listed_for_each(gpu) * most, 800000u) + 8192u;
  if (gpu.list.bytes < gpu.capacity * sizeof(SplashGpu)) gpu.list = make_buffer(gpu.capacity * sizeof(SplashGpu));
  SplashCommandGpu start{};
  start.cell_groups = start.candidate_groups = start.draw_groups = {SPLASH_ROW, 0u, 1u, 0u};
  upload(gpu.command, &start, sizeof start);
  bind_rain_optics(*gpu.optics, frame);
  bind(SPLASH_COMMAND_BINDING, gpu.command);
  bind(SPLASH_LIST_BINDING, gpu.list);
  context.bind_texture(0, "depth");
  if (context.has("normal")) context.bind_texture(1, "normal");
  if (context.has("water")) context.bind_texture(2, "water");
  if (context.has("overhead")) context.bind_texture(3, "overhead");
  context.bind_texture(OCCLUSION_UNIT, "occlusion_map");
  const Techniques& t = frame.techniques;
  const bool rains = frame.rain && frame.rain->rain_mm_per_hour > 0.0f;
  if (rains && t.share(Effect::splashes, SplashRung::field) + t.share(Effect::splashes, SplashRung::secondary) > 0.0f)
    list_field(gpu, context, limits);
  if (rains && t.share(Effect::splashes, SplashRung::random) > 0.0f) list_random(gpu, context, limits);
  if (frame.drips) list_landings(gpu, context, limits);
}

void draw_splashes(SplashGpuState& gpu, PassContext& context) {
  const Frame& frame = context.frame;
  const FrameSplashes& s = *frame.splashes;
  if (!gpu.listed) return;
  gpu.listed = false;
  if (gpu.crown.width == 0) {
    const std::vector<std::uint16_t> baked = bake_crowns();
    constexpr int levels = 7;
    gpu.crown =
        make_texture_2d_array(CROWN_SIDE, CROWN_SIDE, CROWN_PHASES * CROWN_VIEWS * CROWN_KINDS, GL_RGBA16, levels);
    glTextureSubImage3D(gpu.crown.id, 0, 0, 0, 0, CROWN_SIDE, CROWN_SIDE, gpu.crown.layers, GL_RGBA, GL_UNSIGNED_SHORT,
                        baked.data());
    glGenerateTextureMipmap(gpu.crown.id);
    glTextureParameteri(gpu.crown.id, GL_TEXTURE_MIN_FILTER,
                        gpu.software ? GL_LINEAR_MIPMAP_NEAREST : GL_LINEAR_MIPMAP_LINEAR);
  }
  bind_rain_sums(*gpu.sums, context.width, context.height);
  bind(SPLASH_COMMAND_BINDING, gpu.command);
  bind(SPLASH_LIST_BINDING, gpu.list);
  const bool printed = is_printed(frame);
  const bool lit = frame.uniforms.counts.x > 0 || (!printed && lightning_bias(frame) > 1.0f);
  context.bind_texture(0, "depth");
  glBindTextureUnit(1, gpu.crown.id);
  const Program& program = context.program(shader_of(gpu, lit ? "draw_lamps" : "draw"));
  program.use();
  program.set("capacity", unsigned(gpu.capacity));
  program.set("edges", glm::vec2(s.edge_strength, s.edge_bias));
  // Section 3.2, as printed: opacity times 1 - l_b/2, by which a flash would darken splashes. Else lightning is light.
  program.set("clear_share", printed ? std::max(1.0f - 0.5f * lightning_bias(frame), 0.0f) : 1.0f);
  program.set("distance_fade", printed ? 1.0f / s.reach_m : 0.0f);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, gpu.command.id);
  glDispatchComputeIndirect(offsetof(SplashCommandGpu, draw_groups));
}

bool wanted(const Frame& frame) {
  // Out to the corners of the square that those at random are strewn over.
  return frame.splashes && any_surface_in_view(frame, 1.4143f * frame.splashes->reach_m);
}

void add_shader(PassOffer& offer, const std::string& name, const std::string& file, std::vector<std::string> defines) {
  offer.shaders[name] = {{file}, defines};
  defines.emplace_back("SOFTWARE");
  offer.shaders[name + "_software"] = {{file}, defines};
}

}  // namespace

std::vector<PassOffer> splash_passes(const DropPainting& painting) {
  auto gpu = std::make_shared<SplashGpuState>();
  gpu->optics = painting.optics;
  gpu->sums = painting.sums;
  gpu->overhead = std::make_shared<OverheadState>();
  newest = gpu;
  std::vector<PassOffer> offers;
  offers.push_back(overhead_pass(gpu->overhead));

  PassOffer list;
  list.name = "splash_list";
  list.meaning = "splashes that are alive: impacts of the drop field, found through the maps of shelter";
  list.slots = {{"depth", SlotAccess::read},          {"occlusion_map", SlotAccess::read},
                {"normal", SlotAccess::read, true},   {"water", SlotAccess::read, true},
                {"overhead", SlotAccess::read, true}, {"environment", SlotAccess::read, true}};
  list.parameters = {{"least_radiance", 0.004},
                     {"software_most", 650},
                     {"software_reach", 8},
                     {"software_secondary_reach", 1.2},
                     {"software_least_mm", 1.1}};
  const std::string folder = "systems/splash/";
  for (const char* name : {"tiles", "columns", "drops", "impacts", "random", "landings"})
    add_shader(list, name, folder + "splash_" + name + ".comp.glsl", {});
  list.shaders["threshold"] = {{folder + "splash_threshold.comp.glsl"}, {}};
  list.wanted = wanted;
  list.execute = [gpu](PassContext& context) { list_splashes(*gpu, context); };
  list.side_effect = true;
  offers.push_back(std::move(list));

  PassOffer draw;
  draw.name = "splash_draw";
  draw.meaning = "crowns and droplets of the splashes, into the sums of drops";
  draw.slots = {{"depth", SlotAccess::read}};
  add_shader(draw, "draw", folder + "splash_draw.comp.glsl", {"SCENE"});
  add_shader(draw, "draw_lamps", folder + "splash_draw.comp.glsl", {"SCENE", "LAMPS"});
  draw.wanted = wanted;
  draw.execute = [gpu](PassContext& context) { draw_splashes(*gpu, context); };
  draw.side_effect = true;
  offers.push_back(std::move(draw));
  return offers;
}

SplashStats splash_stats() {
  const auto gpu = newest.lock();
  if (!gpu || gpu->command.bytes < sizeof(SplashCommandGpu)) return {};
  SplashCommandGpu command;
  if (gpu->read_back.bytes == 0) gpu->read_back = make_buffer(sizeof command);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glCopyNamedBufferSubData(gpu->command.id, gpu->read_back.id, 0, 0, sizeof command);
  read_buffer(gpu->read_back, &command, sizeof command);
  return {gpu->columns, std::min(command.cell_groups.w, gpu->cell_capacity),
          std::min(command.draw_groups.w, gpu->capacity), command.threshold.z, command.threshold.w};
}

std::vector<SplashGpu> read_splashes() {
  const auto gpu = newest.lock();
  std::vector<SplashGpu> all(splash_stats().splashes);
  if (all.empty()) return all;
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  read_buffer(gpu->list, all.data(), all.size() * sizeof(SplashGpu));
  return all;
}

}  // namespace petrichor
