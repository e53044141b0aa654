#include "systems/rainfall/passes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "systems/rainfall/drop_optics.hpp"
#include "systems/rainfall/layers.hpp"

namespace petrichor {
namespace {

// The first of the struct that rain_cells and rain_splat call RainCommand.
struct Command {
  std::uint32_t groups_x = RAIN_COMMAND_WIDTH, groups_y = 0, groups_z = 1, cell_count = 0, drops_drawn = 0;
};

// What the three passes share between them and from frame to frame.
struct RainGpu {
  Buffer layers, cells, command, optical_depth, radiance, optics;
  int width = 0, height = 0;
  std::uint32_t layer_count = 0, capacity = 0;
  std::uint64_t frame_number = std::numeric_limits<std::uint64_t>::max();
  FrameSky ambient_sky;
  bool ambient_known = false;
};

std::weak_ptr<RainGpu> newest;
bool counting = false;

bool rains(const Frame& frame) {
  return frame.rain && frame.rain->rain_mm_per_hour > 0.0f && frame.rain->drawn_distance_m > 0.0f;
}

bool lamps_on_rain(const Frame& frame) { return frame.uniforms.counts.x > 0; }

glm::vec3 distances(const Frame& frame) {
  // Nearer than this no drop is drawn singly: a handful, out of focus in any real camera, and each as large as
  // thousands of far ones.
  const float nearest = std::max(frame.camera.near_m, 0.3f);
  return {nearest, frame.rain->fade_start_m, frame.rain->drawn_distance_m};
}

glm::dvec3 sky_radiance(const FrameSky& sky, const glm::dvec3& direction) {  // as systems/sky.glsl
  const double glow = std::exp(-std::max(direction.y, 0.0) / std::max(double(sky.glow_height), 1e-3));
  return glm::mix(glm::dvec3(sky.zenith_cd_m2), glm::dvec3(sky.horizon_cd_m2), glow);
}

void update_optics(RainGpu& gpu, const FrameSky& sky) {
  static const std::vector<float> phase = make_drop_phase();
  static_assert(drop_phase_bins == RAIN_PHASE_BINS);
  const bool same = gpu.ambient_known && sky.zenith_cd_m2 == gpu.ambient_sky.zenith_cd_m2 &&
                    sky.horizon_cd_m2 == gpu.ambient_sky.horizon_cd_m2 && sky.glow_height == gpu.ambient_sky.glow_height;
  if (same) return;
  std::vector<float> data(phase);
  for (int i = 0; i < RAIN_AMBIENT_BINS; ++i) {
    const double sine = 2.0 * i / (RAIN_AMBIENT_BINS - 1) - 1.0;
    const glm::dvec3 direction(0.0, sine, -std::sqrt(std::max(0.0, 1.0 - sine * sine)));
    const glm::dvec3 seen = drop_radiance(direction, [&](const glm::dvec3& d) { return sky_radiance(sky, d); });
    data.insert(data.end(), {float(seen.r), float(seen.g), float(seen.b), 0.0f});
  }
  upload(gpu.optics, std::span<const float>(data));
  gpu.ambient_sky = sky;
  gpu.ambient_known = true;
}

void bind(GLuint binding, const Buffer& buffer) { glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.id); }

void list_cells(RainGpu& gpu, PassContext& context) {
  const Frame& frame = context.frame;
  const RainLayers view = view_layers(*frame.rain, frame.camera, context.width, context.height);
  gpu.layer_count = static_cast<std::uint32_t>(view.layers.size());
  gpu.frame_number = frame.number;
  const Command start;
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
  const Program& program = context.program("cells");
  program.use();
  program.set("layer_count", unsigned(gpu.layer_count));
  program.set("seed", unsigned(frame.rain->seed));
  program.set("candidates", static_cast<unsigned>(view.candidates));
  program.set("capacity", unsigned(gpu.capacity));
  program.set("distances", distances(frame));
  program.set("camera_moves", int(frame.uniforms.view_projection != frame.uniforms.shutter_view_projection));
  program.set("least_radiance", context.parameter("least_radiance"));
  const std::uint64_t groups = (view.candidates + 63) / 64;
  const std::uint64_t wide = std::min<std::uint64_t>(groups, 16384);
  glDispatchCompute(static_cast<GLuint>(wide), static_cast<GLuint>((groups + wide - 1) / wide), 1);
}

void splat(RainGpu& gpu, PassContext& context) {
  const Frame& frame = context.frame;
  if (gpu.width != context.width || gpu.height != context.height) {
    gpu.width = context.width;
    gpu.height = context.height;
    const std::size_t pixels = std::size_t(context.width) * context.height;
    gpu.optical_depth = make_buffer(pixels * 4);
    gpu.radiance = make_buffer(pixels * 16);
    clear_buffer(gpu.optical_depth);
    clear_buffer(gpu.radiance);
  }
  update_optics(gpu, frame.sky);
  if (gpu.layer_count == 0) return;
  bind(RAIN_LAYERS_BINDING, gpu.layers);
  bind(RAIN_CELLS_BINDING, gpu.cells);
  bind(RAIN_COMMAND_BINDING, gpu.command);
  bind(RAIN_OPTICAL_DEPTH_BINDING, gpu.optical_depth);
  bind(RAIN_RADIANCE_BINDING, gpu.radiance);
  bind(RAIN_OPTICS_BINDING, gpu.optics);
  const Program& program = context.program(counting ? "splat_counting" : "splat");
  program.use();
  program.set("layer_count", unsigned(gpu.layer_count));
  program.set("seed", unsigned(frame.rain->seed));
  program.set("capacity", unsigned(gpu.capacity));
  program.set("distances", distances(frame));
  program.set("use_depth", int(context.has("depth")));
  program.set("use_occlusion", int(context.has("occlusion_map")));
  if (context.has("depth")) context.bind_texture(0, "depth");
  if (context.has("occlusion_map")) context.bind_texture(OCCLUSION_UNIT, "occlusion_map");
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, gpu.command.id);
  glDispatchComputeIndirect(0);
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, 0);
}

void composite(RainGpu& gpu, PassContext& context) {
  const Frame& frame = context.frame;
  if (gpu.width != context.width || gpu.height != context.height) return;  // the table has no splat
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  bind(RAIN_OPTICAL_DEPTH_BINDING, gpu.optical_depth);
  bind(RAIN_RADIANCE_BINDING, gpu.radiance);
  bind(RAIN_OPTICS_BINDING, gpu.optics);
  const bool environment = context.has("environment");
  const Program& program = context.program(environment ? "composite_environment" : "composite");
  program.use();
  if (environment) context.bind_texture(7, "environment");
  program.set("near_extinction", frame.rain->drawn_extinction_per_m * distances(frame).x);
  program.set("lamps", int(lamps_on_rain(frame)));
  // The ray through a pixel, one metre deep along the axis.
  const float tall = frame.uniforms.lens.x, wide = tall * frame.uniforms.lens.y;
  const glm::mat3 to_world = glm::transpose(glm::mat3(frame.uniforms.view));
  program.set("ray_corner", to_world * glm::vec3(-wide, -tall, -1.0f));
  program.set("ray_x", to_world * glm::vec3(2.0f * wide / static_cast<float>(context.width), 0.0f, 0.0f));
  program.set("ray_y", to_world * glm::vec3(0.0f, 2.0f * tall / static_cast<float>(context.height), 0.0f));
  context.bind_image(0, "colour", GL_READ_WRITE);
  program.dispatch(context.width, context.height);
}

}  // namespace

std::vector<PassOffer> rainfall_passes() {
  auto gpu = std::make_shared<RainGpu>();
  newest = gpu;
  const std::vector<std::string> splat_file{"systems/rainfall/rain_splat.comp.glsl"};
  const std::vector<std::string> composite_file{"systems/rainfall/rain_composite.comp.glsl"};
  std::vector<PassOffer> offers(3);
  offers[0].name = "rain_cells";
  offers[0].meaning = "cells of the drop field that the view can see, with the lamps that light them";
  offers[0].parameters = {{"least_radiance", 0.004}};
  offers[0].shaders = {{"cells", {{"systems/rainfall/rain_cells.comp.glsl"}, {}}}};
  offers[0].wanted = rains;
  offers[0].execute = [gpu](PassContext& context) { list_cells(*gpu, context); };
  offers[1].name = "rain_splat";
  offers[1].meaning = "falling drops as streaks, into sums of optical depth and radiance";
  offers[1].slots = {{"depth", SlotAccess::read, true}, {"occlusion_map", SlotAccess::read, true}};
  offers[1].shaders = {{"splat", {splat_file, {"SMOOTH_LINES"}}},
                       {"splat_counting", {splat_file, {"SMOOTH_LINES", "COUNT_DROPS"}}}};
  offers[1].wanted = rains;
  offers[1].execute = [gpu](PassContext& context) { splat(*gpu, context); };
  offers[2].name = "rain_composite";
  offers[2].meaning = "lays the drops over the picture";
  offers[2].slots = {{"colour", SlotAccess::modify}, {"environment", SlotAccess::read, true}};
  offers[2].shaders = {{"composite", {composite_file, {}}}, {"composite_environment", {composite_file, {"ENVIRONMENT"}}}};
  offers[2].wanted = rains;
  offers[2].execute = [gpu](PassContext& context) { composite(*gpu, context); };
  return offers;
}

void count_rain_drops(bool on) { counting = on; }

RainStats rain_stats(const Frame& frame) {
  const auto gpu = newest.lock();
  if (!gpu || gpu->frame_number != frame.number || gpu->layer_count == 0 || gpu->command.bytes < sizeof(Command)) return {};
  Command command;
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  read_buffer(gpu->command, &command, sizeof command);
  return {command.drops_drawn, std::min(command.cell_count, gpu->capacity)};
}

}  // namespace petrichor
