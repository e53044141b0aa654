#include "systems/rainfall/passes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <string_view>

#include "systems/rainfall/layers.hpp"
#include "systems/rainfall/light_volume.hpp"
#include "systems/rainfall/optics.hpp"

namespace petrichor {
namespace {

// RainCommand of the shaders.
struct Command {
  std::uint32_t groups_x = RAIN_COMMAND_WIDTH, groups_y = 0, groups_z = 1, cell_count = 0, drops_drawn = 0;
  std::uint32_t list_count[RAIN_LISTS] = {};
  std::uint32_t list_groups[6] = {RAIN_COMMAND_WIDTH, 0, 1, RAIN_COMMAND_WIDTH, 0, 1};
};

// What the three passes share between them and from frame to frame.
struct RainGpu {
  Buffer layers, cells, command, optical_depth, radiance, streaks, read_back;
  VertexArray no_vertices;
  bool software = false;  // draw sorted by length
  bool software_device = false, device_known = false;
  int width = 0, height = 0;
  std::uint32_t layer_count = 0, capacity = 0;
  float least_radiance = 0.0f;
  std::uint64_t frame_number = std::numeric_limits<std::uint64_t>::max();
  std::shared_ptr<RainOptics> optics;
};

std::weak_ptr<RainGpu> newest;

bool rains(const Frame& frame) {
  return frame.rain && frame.rain->rain_mm_per_hour > 0.0f && frame.rain->drawn_distance_m > 0.0f &&
         frame.rain->field_share() > 0.0f;
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

bool is_software_gl() {
  const char* name = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const std::string_view renderer = name ? name : "";
  return renderer.find("llvmpipe") != renderer.npos || renderer.find("softpipe") != renderer.npos ||
         renderer.find("SwiftShader") != renderer.npos;
}

void list_cells(RainGpu& gpu, PassContext& context) {
  const Frame& frame = context.frame;
  if (!gpu.device_known) gpu.software_device = is_software_gl();
  gpu.device_known = true;
  const float path = context.parameter("path");
  gpu.software = path == 0.0f ? gpu.software_device : path == 2.0f;
  gpu.least_radiance = context.parameter("least_radiance");
  const RainLayers view = view_layers(*frame.rain, frame.camera, context.width, context.height);
  gpu.layer_count = static_cast<std::uint32_t>(view.layers.size());
  gpu.frame_number = frame.number;
  bind_rain_optics(*gpu.optics, frame);
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

std::string variant(std::string_view name, bool scene, bool lamps) {
  return std::string(name) + (scene ? "_scene" : "") + (lamps ? "_lamps" : "");
}

void hold_streaks(RainGpu& gpu, std::size_t count) {
  if (gpu.streaks.bytes < count * sizeof(RainStreakGpu)) gpu.streaks = make_buffer(count * sizeof(RainStreakGpu));
  bind(RAIN_STREAKS_BINDING, gpu.streaks);
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
}

void draw_on_gpu(RainGpu& gpu, PassContext& context, bool scene, bool lamps) {
  hold_streaks(gpu, std::size_t(RAIN_LONG_CAPACITY) * 2);
  prepare(gpu, context, context.program(variant("splat", scene, lamps)));
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, gpu.command.id);
  glDispatchComputeIndirect(0);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
  const GLintptr groups = offsetof(Command, list_groups);
  context.program(variant("long_lines", scene, lamps)).use();
  glDispatchComputeIndirect(groups);
  context.program(variant("long_capsules", scene, lamps)).use();
  glDispatchComputeIndirect(groups + 12);
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, 0);
}

// On a CPU reading counts back costs nothing, and exact sizes save empty dispatches.
void draw_in_software(RainGpu& gpu, PassContext& context, bool scene, bool lamps) {
  hold_streaks(gpu, std::size_t(RAIN_STREAK_CAPACITY) * RAIN_LISTS);
  glMemoryBarrier(GL_ALL_BARRIER_BITS);
  Command command;
  read_buffer(gpu.command, &command, sizeof command);
  const std::uint32_t cells = std::min(command.cell_count, gpu.capacity);
  // As many cells at a time as surely fit a list: even if all their drops came into one, it would take a mean that is
  // eighteen deviations too high.
  constexpr std::uint32_t slice = RAIN_STREAK_CAPACITY / 58;
  for (std::uint32_t first = 0; first < cells; first += slice) {
    const Program& drops = context.program(variant("drops", scene, lamps));
    prepare(gpu, context, drops);
    drops.set("first_cell", unsigned(first));
    drops.set("end_cell", unsigned(std::min(cells, first + slice)));
    drops.dispatch(static_cast<int>(std::min(cells - first, slice)));
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    read_buffer(gpu.command, &command, sizeof command);
    for (unsigned list = 0; list < RAIN_LISTS; ++list) {
      if (command.list_count[list] == 0) continue;
      const bool capsules = list == RAIN_LISTS - 1;
      const Program& lines = context.program(variant(capsules ? "capsules" : "lines", scene, lamps));
      lines.use();
      lines.set("list", list);
      lines.set("list_size", unsigned(std::min<std::uint32_t>(command.list_count[list], RAIN_STREAK_CAPACITY)));
      lines.set("taps", list < RAIN_LENGTHS ? 1 : 2);
      lines.dispatch(static_cast<int>(command.list_count[list]));
    }
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
    Command next;
    next.cell_count = command.cell_count;
    next.drops_drawn = command.drops_drawn;
    upload(gpu.command, &next, sizeof next);
  }
}

void splat(RainGpu& gpu, PassContext& context) {
  const Frame& frame = context.frame;
  if (gpu.width != context.width || gpu.height != context.height) {
    gpu.width = context.width;
    gpu.height = context.height;
    const std::size_t pixels = std::size_t(context.width) * context.height;
    gpu.optical_depth = make_buffer(std::size_t(context.width) * ((context.height + 1) / 2) * 4);
    gpu.radiance = make_buffer(pixels * 16);
    clear_buffer(gpu.optical_depth);
    clear_buffer(gpu.radiance);
  }
  if (gpu.layer_count == 0) return;
  bind(RAIN_LAYERS_BINDING, gpu.layers);
  bind(RAIN_CELLS_BINDING, gpu.cells);
  bind(RAIN_COMMAND_BINDING, gpu.command);
  bind(RAIN_OPTICAL_DEPTH_BINDING, gpu.optical_depth);
  bind(RAIN_RADIANCE_BINDING, gpu.radiance);
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
  if (gpu.width != context.width || gpu.height != context.height) return;  // the table has no splat
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  bind(RAIN_OPTICAL_DEPTH_BINDING, gpu.optical_depth);
  bind(RAIN_RADIANCE_BINDING, gpu.radiance);
  const bool lamps = lamps_on_rain(frame);
  std::string name = gpu.software ? "raster" : "composite";
  if (context.has("environment")) name += "_environment";
  if (gpu.software && lamps) name += "_lamps";
  const Program& program = context.program(name);
  program.use();
  if (context.has("environment")) context.bind_texture(7, "environment");
  program.set("near_extinction",
              frame.rain->field_share() * frame.rain->drawn_extinction_per_m * distances(frame).x);
  set_rain_ambient(*gpu.optics, program);
  program.set("lamps", int(lamps));
  // The ray through a pixel, one metre deep along the axis.
  const float tall = frame.uniforms.lens.x, wide = tall * frame.uniforms.lens.y;
  const glm::mat3 to_world = glm::transpose(glm::mat3(frame.uniforms.view));
  program.set("ray_corner", to_world * glm::vec3(-wide, -tall, -1.0f));
  program.set("ray_x", to_world * glm::vec3(2.0f * wide / static_cast<float>(context.width), 0.0f, 0.0f));
  program.set("ray_y", to_world * glm::vec3(0.0f, 2.0f * tall / static_cast<float>(context.height), 0.0f));
  if (!gpu.software) {
    context.bind_image(0, "colour", GL_READ_WRITE);
    program.dispatch(context.width, (context.height + 1) / 2);
    return;
  }
  if (!gpu.no_vertices) {
    GLuint id = 0;
    glCreateVertexArrays(1, &id);
    gpu.no_vertices = VertexArray(id);
  }
  static constexpr std::array<std::string_view, 1> colours{"colour"};
  context.bind_framebuffer(colours, "");
  glBindVertexArray(gpu.no_vertices);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_ONE, GL_SRC_ALPHA, GL_ZERO, GL_ONE);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_BLEND);
  glBindVertexArray(0);
  clear_buffer(gpu.optical_depth);
  if (lamps) clear_buffer(gpu.radiance);
}

}  // namespace

std::vector<PassOffer> rainfall_passes() {
  auto gpu = std::make_shared<RainGpu>();
  gpu->optics = std::make_shared<RainOptics>();
  newest = gpu;
  const std::vector<std::string> composite_file{"systems/rainfall/rain_composite.comp.glsl"};
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
  offers[1].slots = {{"depth", SlotAccess::read, true}, {"occlusion_map", SlotAccess::read, true}};
  for (const bool scene : {false, true}) {
    for (const bool lamps : {false, true}) {
      std::vector<std::string> defines;
      if (scene) defines.push_back("SCENE");
      if (lamps) defines.push_back("LAMPS");
      const auto add = [&](std::string_view name, std::string_view file) {
        offers[1].shaders[variant(name, scene, lamps)] = {{std::string(file)}, defines};
      };
      add("splat", "systems/rainfall/rain_splat.comp.glsl");
      add("long_lines", "systems/rainfall/rain_lines.comp.glsl");
      defines.push_back("CAPSULES");
      add("long_capsules", "systems/rainfall/rain_lines.comp.glsl");
      defines.back() = "SOFTWARE";
      add("drops", "systems/rainfall/rain_drops.comp.glsl");
      add("lines", "systems/rainfall/rain_lines.comp.glsl");
      defines.push_back("CAPSULES");
      add("capsules", "systems/rainfall/rain_lines.comp.glsl");
    }
  }
  offers[1].wanted = rains;
  offers[1].execute = [gpu](PassContext& context) { splat(*gpu, context); };
  offers[2].name = "rain_composite";
  offers[2].meaning = "lays the drops over the picture";
  offers[2].slots = {{"colour", SlotAccess::modify}, {"environment", SlotAccess::read, true}};
  offers[2].shaders = {{"composite", {composite_file, {}}},
                       {"composite_environment", {composite_file, {"ENVIRONMENT"}}}};
  const std::vector<std::string> raster_files{"systems/rainfall/rain_composite.vert.glsl",
                                              "systems/rainfall/rain_composite.frag.glsl"};
  offers[2].shaders["raster"] = {raster_files, {"SOFTWARE"}};
  offers[2].shaders["raster_lamps"] = {raster_files, {"LAMPS", "SOFTWARE"}};
  offers[2].shaders["raster_environment"] = {raster_files, {"ENVIRONMENT", "SOFTWARE"}};
  offers[2].shaders["raster_environment_lamps"] = {raster_files, {"ENVIRONMENT", "LAMPS", "SOFTWARE"}};
  offers[2].wanted = rains;
  offers[2].execute = [gpu](PassContext& context) { composite(*gpu, context); };
  offers.push_back(rain_light_pass(gpu->optics));
  return offers;
}

RainStats rain_stats(const Frame& frame) {
  const auto gpu = newest.lock();
  if (!gpu || gpu->frame_number != frame.number || gpu->layer_count == 0 || gpu->command.bytes < sizeof(Command))
    return {};
  // By way of a copy: a driver may move a buffer that is read into the computer's memory, where atomics are slow.
  Command command;
  if (gpu->read_back.bytes == 0) gpu->read_back = make_buffer(sizeof command);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glCopyNamedBufferSubData(gpu->command.id, gpu->read_back.id, 0, 0, sizeof command);
  read_buffer(gpu->read_back, &command, sizeof command);
  return {command.drops_drawn, std::min(command.cell_count, gpu->capacity)};
}

}  // namespace petrichor
