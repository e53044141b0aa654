#include "systems/rainfall/snow/passes.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <string_view>

#include "systems/drops/composite.hpp"
#include "systems/rainfall/light_volume.hpp"
#include "systems/rainfall/snow/extract.hpp"
#include "systems/rainfall/snow/flake_optics.hpp"
#include "systems/rainfall/snow/snow_shared.h"

namespace petrichor {
namespace {

// SnowCommand of the shaders.
struct Command {
  std::uint32_t groups_x = RAIN_COMMAND_WIDTH, groups_y = 0, groups_z = 1, cell_count = 0, flakes_drawn = 0;
  std::uint32_t disc_count = 0;
  std::uint32_t disc_groups[3] = {RAIN_COMMAND_WIDTH, 0, 1};
};

// What the passes share between them and from frame to frame. The sums are the snow's own: its composite knows what
// flakes show of the surroundings, the rain's what drops do.
struct SnowGpu {
  Buffer layers, cells, command, discs, read_back;
  RainSums sums;
  ParticleOptics optics;
  std::uint32_t layer_count = 0, capacity = 0;
  std::uint64_t frame_number = std::numeric_limits<std::uint64_t>::max();
};

std::weak_ptr<SnowGpu> newest;

bool snows(const Frame& frame) {
  return frame.snow && frame.snow->snow_mm_per_hour > 0.0f;
}

bool draws_field(const Frame& frame) {
  return snows(frame) && frame.snow->drawn_distance_m > 0.0f && frame.snow->share(SnowRung::field) > 0.0f;
}

bool lamps_on_snow(const Frame& frame) {
  return frame.uniforms.counts.x > 0;
}

glm::vec3 distances(const Frame& frame) {
  // Nearer than this no flake is drawn singly: a handful, out of focus in any real camera, and each as large as
  // thousands of far ones.
  const float nearest = std::max(frame.camera.near_m, 0.4f);
  return {nearest, frame.snow->fade_start_m, frame.snow->drawn_distance_m};
}

void bind(GLuint binding, const Buffer& buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.id);
}

std::string variant(std::string_view name, bool scene, bool lamps) {
  return std::string(name) + (scene ? "_scene" : "") + (lamps ? "_lamps" : "");
}

void list_cells(SnowGpu& gpu, PassContext& context) {
  const Frame& frame = context.frame;
  const FrameSnow& snow = *frame.snow;
  const RainLayers view = view_flakes(snow, frame.camera, context.width, context.height);
  gpu.layer_count = static_cast<std::uint32_t>(view.layers.size());
  gpu.frame_number = frame.number;
  bind_flake_optics(gpu.optics, frame);
  const Command start;
  upload(gpu.command, &start, sizeof start);
  if (view.layers.empty()) return;
  upload(gpu.layers, std::span<const RainLayerGpu>(view.layers));
  gpu.capacity = static_cast<std::uint32_t>(std::min<std::uint64_t>(view.candidates, 2'000'000));
  if (gpu.cells.bytes < gpu.capacity * sizeof(RainCellGpu))
    gpu.cells = make_buffer(std::size_t(gpu.capacity + gpu.capacity / 4) * sizeof(RainCellGpu));
  bind(RAIN_LAYERS_BINDING, gpu.layers);
  bind(RAIN_CELLS_BINDING, gpu.cells);
  bind(RAIN_COMMAND_BINDING, gpu.command);
  const Program& program = context.program("cells");
  program.use();
  program.set("layer_count", unsigned(gpu.layer_count));
  program.set("seed", unsigned(snow.seed));
  program.set("candidates", static_cast<unsigned>(view.candidates));
  program.set("capacity", unsigned(gpu.capacity));
  program.set("distances", distances(frame));
  program.set("camera_moves", int(frame.uniforms.view_projection != frame.uniforms.shutter_view_projection));
  program.set("least_radiance", context.parameter("least_radiance"));
  program.set("sway_diameters", most_sway_diameters * snow.sway);
  const std::uint64_t groups = (view.candidates + 63) / 64, wide = std::min<std::uint64_t>(groups, 16384);
  glDispatchCompute(static_cast<GLuint>(wide), static_cast<GLuint>((groups + wide - 1) / wide), 1);
}

void draw_flakes(SnowGpu& gpu, PassContext& context) {
  const Frame& frame = context.frame;
  bind_rain_sums(gpu.sums, context.width, context.height);
  if (gpu.layer_count == 0) return;
  constexpr std::size_t disc_bytes = std::size_t(SNOW_DISC_CAPACITY) * sizeof(RainStreakGpu);
  if (gpu.discs.bytes < disc_bytes) gpu.discs = make_buffer(disc_bytes);
  bind(RAIN_LAYERS_BINDING, gpu.layers);
  bind(RAIN_CELLS_BINDING, gpu.cells);
  bind(RAIN_COMMAND_BINDING, gpu.command);
  bind(RAIN_STREAKS_BINDING, gpu.discs);
  bind_flake_optics(gpu.optics, frame);
  const bool scene = context.has("depth"), lamps = lamps_on_snow(frame), map = context.has("occlusion_map");
  if (scene) context.bind_texture(0, "depth");
  if (scene && map) context.bind_texture(OCCLUSION_UNIT, "occlusion_map");
  const Program& flakes = context.program(variant("flakes", scene, lamps));
  flakes.use();
  flakes.set("seed", unsigned(frame.snow->seed));
  flakes.set("capacity", unsigned(gpu.capacity));
  flakes.set("distances", distances(frame));
  flakes.set("use_occlusion", int(map));
  flakes.set("sway", frame.snow->sway);
  flakes.set("clock_s", frame.snow->clock_s);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, gpu.command.id);
  glDispatchComputeIndirect(0);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
  context.program(variant("discs", scene, lamps)).use();
  glDispatchComputeIndirect(offsetof(Command, disc_groups));
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, 0);
}

void composite(SnowGpu& gpu, PassContext& context) {
  const FrameSnow& snow = *context.frame.snow;
  gpu.sums.software = is_software_gl();
  lay_over(gpu.sums, context, gpu.optics,
           snow.share(SnowRung::field) * snow.extinction_per_m * distances(context.frame).x);
}

}  // namespace

std::vector<PassOffer> snow_passes() {
  auto gpu = std::make_shared<SnowGpu>();
  newest = gpu;
  std::vector<PassOffer> offers(4);
  PassOffer& light = offers[0];
  light.name = "snow_light";
  light.meaning = "what lamps give to falling flakes, in a coarse volume of the view";
  light.slots = {{"snow_light", SlotAccess::write}};
  light.parameters = {{"least_radiance", 0.002}};
  light.shaders = {{"fill", {{"systems/rainfall/rain_light.comp.glsl"}, {}}}};
  light.wanted = [](const Frame& frame) {
    return snows(frame) && frame.snow->share(SnowRung::double_cone) > 0.0f && lamps_on_snow(frame);
  };
  light.execute = [gpu](PassContext& context) {
    bind_flake_optics(gpu->optics, context.frame);
    fill_light_volume(context, "snow_light");
  };

  PassOffer& cells = offers[1];
  cells.name = "snow_cells";
  cells.meaning = "cells of the field of flakes that the view can see, with the lamps that light them";
  cells.parameters = {{"least_radiance", 0.004}};
  cells.shaders = {{"cells", {{"systems/rainfall/rain_cells.comp.glsl"}, {}}}};
  cells.wanted = draws_field;
  cells.execute = [gpu](PassContext& context) { list_cells(*gpu, context); };

  PassOffer& field = offers[2];
  field.name = "snow_field";
  field.meaning = "falling flakes, into sums of optical depth and radiance";
  field.slots = {{"depth", SlotAccess::read, true}, {"occlusion_map", SlotAccess::read, true}};
  for (const bool scene : {false, true})
    for (const bool lamps : {false, true}) {
      std::vector<std::string> defines;
      if (scene) defines.push_back("SCENE");
      if (lamps) defines.push_back("LAMPS");
      field.shaders[variant("flakes", scene, lamps)] = {{"systems/rainfall/snow/snow_flakes.comp.glsl"}, defines};
      field.shaders[variant("discs", scene, lamps)] = {{"systems/rainfall/snow/snow_discs.comp.glsl"}, defines};
    }
  field.wanted = draws_field;
  field.execute = [gpu](PassContext& context) { draw_flakes(*gpu, context); };

  PassOffer& over = offers[3];
  over.name = "snow_composite";
  over.meaning = "lays the flakes over the picture";
  offer_composite(over, true);
  over.wanted = draws_field;
  over.execute = [gpu](PassContext& context) { composite(*gpu, context); };
  return offers;
}

SnowStats snow_stats(const Frame& frame) {
  const auto gpu = newest.lock();
  if (!gpu || gpu->frame_number != frame.number || gpu->layer_count == 0 || gpu->command.bytes < sizeof(Command))
    return {};
  // By way of a copy: a driver may move a buffer that is read into the computer's memory, where atomics are slow.
  Command command;
  if (gpu->read_back.bytes == 0) gpu->read_back = make_buffer(sizeof command);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glCopyNamedBufferSubData(gpu->command.id, gpu->read_back.id, 0, 0, sizeof command);
  read_buffer(gpu->read_back, &command, sizeof command);
  return {command.flakes_drawn, command.disc_count, std::min(command.cell_count, gpu->capacity)};
}

}  // namespace petrichor
