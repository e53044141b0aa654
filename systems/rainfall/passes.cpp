#include "systems/rainfall/passes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "systems/drops/composite.hpp"
#include "systems/rainfall/cone/passes.hpp"
#include "systems/rainfall/layered/passes.hpp"
#include "systems/drops/layers.hpp"
#include "systems/rainfall/light_volume.hpp"
#include "systems/rainfall/near_drops/near.hpp"
#include "systems/rainfall/near_drops/passes.hpp"
#include "systems/drops/lists.hpp"
#include "systems/rainfall/snow/passes.hpp"
#include "systems/rainfall/sprites/passes.hpp"
#include "systems/rainfall/streaks/gpu.hpp"

namespace petrichor {
namespace {

// What the three passes share between them and from frame to frame.
struct RainGpu {
  Buffer layers, cells, command, read_back;
  bool software = false;  // draw sorted by length
  bool software_device = false, device_known = false;
  std::uint32_t layer_count = 0, capacity = 0;
  float least_radiance = 0.0f;
  std::uint64_t frame_number = std::numeric_limits<std::uint64_t>::max();
  std::shared_ptr<RainOptics> optics;
  std::shared_ptr<RainSums> sums;
};

std::weak_ptr<RainGpu> newest;

bool rains(const Frame& frame) {
  return frame.rain && frame.rain->rain_mm_per_hour > 0.0f && frame.rain->drawn_distance_m > 0.0f &&
         frame.rain->field_share() > 0.0f;
}

bool draws_sprites(const Frame& frame) {
  return frame.rain && frame.rain->rain_mm_per_hour > 0.0f && frame.rain->share(RainRung::sprites) > 0.0f;
}

bool lamps_on_rain(const Frame& frame) {
  return frame.uniforms.counts.x > 0;
}

glm::vec3 distances(const Frame& frame) {
  // Nearer than this no drop is drawn singly: a handful, out of focus in any real camera, and each as large as
  // thousands of far ones.
  const float nearest = std::max(frame.camera.near_m, 0.3f);
  return {nearest, frame.rain->fade_start_m, frame.rain->drawn_distance_m};
}

void bind(GLuint binding, const Buffer& buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.id);
}

void list_cells(RainGpu& gpu, PassContext& context) {
  const Frame& frame = context.frame;
  if (!gpu.device_known) gpu.software_device = is_software_gl();
  gpu.device_known = true;
  const float path = context.parameter("path");
  gpu.software = gpu.sums->software = path == 0.0f ? gpu.software_device : path == 2.0f;
  gpu.least_radiance = context.parameter("least_radiance");
  const RainLayers view = view_layers(*frame.rain, frame.camera, context.width, context.height);
  gpu.layer_count = static_cast<std::uint32_t>(view.layers.size());
  gpu.frame_number = frame.number;
  bind_rain_optics(*gpu.optics, frame);
  const RainCommand start;
  upload(gpu.command, &start, sizeof start);
  if (view.layers.empty()) return;
  upload(gpu.layers, std::span<const RainLayerGpu>(view.layers));
  // A pyramid fills a third of its box; far more than two thirds of a large box is never seen.
  const double candidates = static_cast<double>(view.candidates);
  gpu.capacity = static_cast<std::uint32_t>(std::min(candidates, 2e6 + 0.6 * std::max(0.0, candidates - 2e6)));
  if (gpu.cells.bytes < gpu.capacity * sizeof(RainCellGpu)) {
    gpu.cells = make_buffer(std::size_t(gpu.capacity + gpu.capacity / 4) * sizeof(RainCellGpu));
  }
  bind(RAIN_LAYERS_BINDING, gpu.layers);
  bind(RAIN_CELLS_BINDING, gpu.cells);
  bind(RAIN_COMMAND_BINDING, gpu.command);
  const Program& program = context.program(gpu.software ? "cells_software" : "cells");
  program.use();
  program.set("layer_count", unsigned(gpu.layer_count));
  program.set("seed", unsigned(frame.rain->seed));
  program.set("candidates", static_cast<unsigned>(view.candidates));
  program.set("capacity", unsigned(gpu.capacity));
  program.set("distances", distances(frame));
  program.set("camera_moves", int(frame.uniforms.view_projection != frame.uniforms.shutter_view_projection));
  program.set("least_radiance", gpu.least_radiance);
  const std::uint64_t groups = (view.candidates + 63) / 64;
  const std::uint64_t wide = std::min<std::uint64_t>(groups, 16384);
  glDispatchCompute(static_cast<GLuint>(wide), static_cast<GLuint>((groups + wide - 1) / wide), 1);
}

// Uniforms and bindings that drawing drops needs, whichever way.
void prepare(const RainGpu& gpu, PassContext& context, const Program& program) {
  program.use();
  program.set("layer_count", unsigned(gpu.layer_count));
  program.set("seed", unsigned(context.frame.rain->seed));
  program.set("capacity", unsigned(gpu.capacity));
  program.set("distances", distances(context.frame));
  program.set("least_radiance", gpu.least_radiance);
  program.set("use_occlusion", int(context.has("occlusion_map")));
  bind_streak_table(*gpu.optics, context.frame, program);
  program.set("near_choice", context.has("near") ? near_uniform(near_choice(context.frame)) : glm::vec4(0.0f));
}

void draw_on_gpu(RainGpu& gpu, PassContext& context, bool scene, bool lamps) {
  bind_streak_lists(*gpu.sums, false);
  for (const char* lines : {"long_lines", "long_capsules"})
    bind_streak_table(*gpu.optics, context.frame, context.program(drop_shader(lines, scene, lamps)));
  prepare(gpu, context, context.program(drop_shader("splat", scene, lamps)));
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, gpu.command.id);
  glDispatchComputeIndirect(0);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
  draw_long_streaks(gpu.command, context, scene, lamps);
}

void draw_in_software(RainGpu& gpu, PassContext& context, bool scene, bool lamps) {
  bind_streak_lists(*gpu.sums, true);
  for (const char* lines : {"lines", "capsules"})
    bind_streak_table(*gpu.optics, context.frame, context.program(drop_shader(lines, scene, lamps)));
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
  RainCommand command;
  read_buffer(gpu.command, &command, sizeof command);
  const std::uint32_t cells = std::min(command.cell_count, gpu.capacity);
  // As many cells at a time as surely fit a list: even if all their drops came into one, it would take a mean that is
  // eighteen deviations too high.
  constexpr std::uint32_t slice = RAIN_STREAK_CAPACITY / 58;
  for (std::uint32_t first = 0; first < cells; first += slice) {
    const Program& drops = context.program(drop_shader("drops", scene, lamps));
    prepare(gpu, context, drops);
    drops.set("first_cell", unsigned(first));
    drops.set("end_cell", unsigned(std::min(cells, first + slice)));
    drops.dispatch(static_cast<int>(std::min(cells - first, slice)));
    draw_sorted_streaks(gpu.command, context, scene, lamps);
  }
}

void splat(RainGpu& gpu, PassContext& context) {
  const Frame& frame = context.frame;
  bind_rain_sums(*gpu.sums, context.width, context.height);
  if (gpu.layer_count == 0) return;
  bind(RAIN_LAYERS_BINDING, gpu.layers);
  bind(RAIN_CELLS_BINDING, gpu.cells);
  bind(RAIN_COMMAND_BINDING, gpu.command);
  bind_rain_optics(*gpu.optics, frame);
  const bool scene = context.has("depth"), lamps = lamps_on_rain(frame);
  if (scene) context.bind_texture(0, "depth");
  if (scene && context.has("occlusion_map")) context.bind_texture(OCCLUSION_UNIT, "occlusion_map");
  if (gpu.software)
    draw_in_software(gpu, context, scene, lamps);
  else
    draw_on_gpu(gpu, context, scene, lamps);
}

void composite(RainGpu& gpu, PassContext& context) {
  const Frame& frame = context.frame;
  const bool has_sprites = draws_sprites(frame);
  const FrameSprites sprites = has_sprites ? frame.rain->sprites : FrameSprites{};
  if (has_sprites && sprites.hide_background) clear_texture(context.texture("colour"), {0.0f, 0.0f, 0.0f, 1.0f});
  // Of what is too near to be drawn singly. Without falling rain there may still be drips.
  float near_extinction = 0.0f;
  if (frame.rain) {
    const float share =
        frame.rain->field_share() + (has_sprites ? frame.rain->share(RainRung::sprites) * sprites.drawn_share() : 0.0f);
    near_extinction = share * frame.rain->drawn_extinction_per_m * distances(frame).x;
  }
  bind_rain_optics(*gpu.optics, frame);
  lay_over(*gpu.sums, context, *gpu.optics, near_extinction);
}

}  // namespace

std::vector<PassOffer> rainfall_passes(const DropPainting& painting) {
  auto gpu = std::make_shared<RainGpu>();
  gpu->optics = painting.optics;
  gpu->sums = painting.sums;
  newest = gpu;
  std::vector<PassOffer> offers(3);
  offers[0].name = "rain_cells";
  offers[0].meaning = "cells of the drop field that the view can see, with the lamps that light them";
  // path: 0 by the device, 1 all in one dispatch (GPUs), 2 sorted by length first (software OpenGL).
  offers[0].parameters = {{"least_radiance", 0.004}, {"path", 0.0}};
  offers[0].shaders = {{"cells", {{"systems/rainfall/rain_cells.comp.glsl"}, {}}},
                       {"cells_software", {{"systems/rainfall/rain_cells.comp.glsl"}, {"SOFTWARE"}}}};
  offers[0].wanted = rains;
  offers[0].execute = [gpu](PassContext& context) { list_cells(*gpu, context); };
  offers[1].name = "rain_splat";
  offers[1].meaning = "falling drops as streaks, into sums of optical depth and radiance";
  // near: whoever reads it draws the drops near the eye, which are left out then.
  offers[1].slots = {{"depth", SlotAccess::read, true},
                     {"occlusion_map", SlotAccess::read, true},
                     {"near", SlotAccess::write, true}};
  offers[1].side_effect = true;
  add_drop_shaders(offers[1], "splat", "systems/rainfall/rain_splat.comp.glsl", "drops",
                   "systems/rainfall/rain_drops.comp.glsl");
  offers[1].wanted = rains;
  offers[1].execute = [gpu](PassContext& context) { splat(*gpu, context); };
  offers[2].name = "rain_composite";
  offers[2].meaning = "lays the drops over the picture";
  offer_composite(offers[2], false);
  offers[2].wanted = [](const Frame& frame) {
    return rains(frame) || draws_sprites(frame) || frame.splashes || frame.drips;
  };
  offers[2].execute = [gpu](PassContext& context) { composite(*gpu, context); };
  offers.push_back(rain_light_pass(gpu->optics));
  for (PassOffer& offer : cone_passes(gpu->optics)) offers.push_back(std::move(offer));
  for (PassOffer& offer : layered_passes(gpu->optics)) offers.push_back(std::move(offer));
  for (PassOffer& offer : near_drops_passes()) offers.push_back(std::move(offer));
  for (PassOffer& offer : sprites_passes(gpu->optics, gpu->sums)) offers.push_back(std::move(offer));
  for (PassOffer& offer : snow_passes()) offers.push_back(std::move(offer));
  return offers;
}

RainStats rain_stats(const Frame& frame) {
  const std::uint32_t sprites = sprites_drawn(frame);
  const auto gpu = newest.lock();
  if (!gpu || gpu->frame_number != frame.number || gpu->layer_count == 0 || gpu->command.bytes < sizeof(RainCommand))
    return {sprites, 0};
  // By way of a copy: a driver may move a buffer that is read into the computer's memory, where atomics are slow.
  RainCommand command;
  if (gpu->read_back.bytes == 0) gpu->read_back = make_buffer(sizeof command);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glCopyNamedBufferSubData(gpu->command.id, gpu->read_back.id, 0, 0, sizeof command);
  read_buffer(gpu->read_back, &command, sizeof command);
  return {command.drops_drawn + sprites, std::min(command.cell_count, gpu->capacity)};
}

}  // namespace petrichor
