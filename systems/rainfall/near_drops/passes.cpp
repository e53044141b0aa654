#include "systems/rainfall/near_drops/passes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <string>
#include <string_view>

#include "systems/gpu_scene.hpp"
#include "systems/rainfall/near_drops/near.hpp"
#include "systems/rainfall/near_drops/near_world.hpp"
#include "systems/drops/sums.hpp"

namespace petrichor {
namespace {

// NearCommand of the shaders.
struct Command {
  std::uint32_t draw[3] = {NEAR_ROW, 0, 1}, light[3] = {NEAR_ROW, 0, 1}, cells[3] = {NEAR_ROW, 0, 1};
  std::uint32_t count = 0, cells_wanted = 0;
};

struct NearGpu {
  NearWorld world;
  Buffer layers, list, command, sums, profiles, curve, maps, images, cells;
  VertexArray no_vertices;
  int width = 0, height = 0;
  std::uint32_t capacity = 0;
  bool software = false, device_known = false;
  // Maps, and what the images of their cells were made for.
  int map_cells = 0, map_pixels = 0;
  bool maps_on_cube = false;
  std::uint32_t stamp = 0;
  std::uint64_t relit = 0;
  glm::dvec3 seen_from{0.0};
  int world_is = -1;
};

std::weak_ptr<NearGpu> newest;

void bind(GLuint binding, const Buffer& buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.id);
}

bool wanted(const Frame& frame) {
  return frame.rain && frame.rain->rain_mm_per_hour > 0.0f && near_choice(frame).share > 0.0f;
}

void hold(Buffer& buffer, std::size_t bytes) {
  if (buffer.bytes < bytes) buffer = make_buffer(bytes);
}

// The pre-processing step: all maps, once.
void bake_maps(NearGpu& gpu, PassContext& context, const FrameNearDrops& set) {
  const bool same = gpu.map_cells == set.map_cells && gpu.map_pixels == set.map_pixels &&
                    gpu.maps_on_cube == set.published && gpu.maps.bytes > 0;
  if (same) return;
  gpu.map_cells = set.map_cells;
  gpu.map_pixels = set.map_pixels;
  gpu.maps_on_cube = set.published;
  const std::size_t cells = std::size_t(set.map_cells) * set.map_cells * set.map_cells;
  const std::size_t area = std::size_t(set.map_pixels) * set.map_pixels, texels = cells * area;
  gpu.maps = make_buffer(texels * NEAR_MAP_WORDS * 4);
  gpu.images = make_buffer(cells * (area + set.map_pixels) * 8);
  gpu.cells = make_buffer(2 * cells * 4);
  clear_buffer(gpu.cells);
  gpu.stamp = 0;
  bind(NEAR_MAPS_BINDING, gpu.maps);
  const Program& bake = context.program("bake");
  bake.use();
  bake.set("cells_aside", set.map_cells);
  bake.set("map_pixels", set.map_pixels);
  bake.set("on_cube", int(set.published));
  bake.set("texels", static_cast<unsigned>(texels));
  const std::size_t groups = (texels + 63) / 64, wide = std::min<std::size_t>(groups, 16384);
  glDispatchCompute(static_cast<GLuint>(wide), static_cast<GLuint>((groups + wide - 1) / wide), 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

// What lights drops: the world, and where the drops are in it.
void set_world(const NearGpu& gpu, const Frame& frame, int world_is, const Program& program) {
  const float texels = 6.0f * static_cast<float>(gpu.world.face_texels) * static_cast<float>(gpu.world.face_texels);
  program.set("texel_sr", 12.5663706f / texels);
  program.set("coarsest", static_cast<float>(gpu.world.cube.levels - 1));
  program.set("world_is", world_is);
  // Printed: the huge cube moves with the camera.
  program.set("captured_from",
              world_is == 1 ? glm::vec3(gpu.world.place_m - frame.camera.position_m) : glm::vec3(0.0f));
  program.set("capacity", unsigned(gpu.capacity));
  program.set("cells_aside", gpu.map_cells);
  program.set("map_pixels", gpu.map_pixels);
}

void list_drops(NearGpu& gpu, PassContext& context, const NearChoice& choice, bool scene) {
  const Frame& frame = context.frame;
  const RainLayers layers = near_layers(frame, choice);
  // Eight deviations above what is expected: the field leaves these drops out, so the list must hold them all.
  const auto capacity = static_cast<std::uint32_t>(1.1 * choice.expected + 8.0 * std::sqrt(choice.expected) + 256.0);
  if (gpu.capacity < capacity) gpu.capacity = capacity;
  hold(gpu.list, gpu.capacity * sizeof(NearDropGpu));
  hold(gpu.profiles, std::size_t(gpu.capacity) * NEAR_COLUMNS * 8);
  const Command start;
  upload(gpu.command, &start, sizeof start);
  bind(NEAR_LIST_BINDING, gpu.list);
  bind(NEAR_COMMAND_BINDING, gpu.command);
  bind(NEAR_PROFILES_BINDING, gpu.profiles);
  if (layers.layers.empty()) return;
  upload(gpu.layers, std::span<const RainLayerGpu>(layers.layers));
  bind(RAIN_LAYERS_BINDING, gpu.layers);
  if (choice.maps_share > 0.0f) bind(NEAR_CELLS_BINDING, gpu.cells);
  const Program& list = context.program(scene ? "list_scene" : "list");
  list.use();
  list.set("layer_count", static_cast<unsigned>(layers.layers.size()));
  list.set("seed", unsigned(frame.rain->seed));
  list.set("distances", glm::vec3(std::max(frame.camera.near_m, 0.3f), frame.rain->fade_start_m,
                                  frame.rain->drawn_distance_m));  // as passes.cpp
  list.set("near_choice", near_uniform(choice));
  list.set("candidates", static_cast<unsigned>(layers.candidates));
  list.set("capacity", unsigned(gpu.capacity));
  list.set("stamp", unsigned(gpu.stamp));
  list.set("cells_aside", gpu.map_cells);
  list.set("maps_share", choice.maps_share);
  list.set("use_occlusion", int(context.has("occlusion_map")));
  if (scene && context.has("occlusion_map")) context.bind_texture(OCCLUSION_UNIT, "occlusion_map");
  const std::uint64_t wide = std::min<std::uint64_t>(layers.candidates, 16384);
  glDispatchCompute(static_cast<GLuint>(wide), static_cast<GLuint>((layers.candidates + wide - 1) / wide), 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
}

void lay_over(NearGpu& gpu, PassContext& context) {
  if (!gpu.software) {
    const Program& over = context.program("over");
    over.use();
    context.bind_image(0, "colour", GL_READ_WRITE);
    over.dispatch(context.width, context.height);
    return;
  }
  if (!gpu.no_vertices) {
    GLuint id = 0;
    glCreateVertexArrays(1, &id);
    gpu.no_vertices = VertexArray(id);
  }
  static constexpr std::array<std::string_view, 1> colours{"colour"};
  context.bind_framebuffer(colours, "");
  context.program("over_raster").use();
  glBindVertexArray(gpu.no_vertices);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_ONE, GL_SRC_ALPHA, GL_ZERO, GL_ONE);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_BLEND);
  glBindVertexArray(0);
  clear_buffer(gpu.sums);
}

void draw_near_drops(NearGpu& gpu, PassContext& context) {
  const Frame& frame = context.frame;
  if (!gpu.device_known) gpu.software = is_software_gl();
  gpu.device_known = true;
  if (gpu.width != context.width || gpu.height != context.height) {
    gpu.width = context.width;
    gpu.height = context.height;
    gpu.sums = make_buffer(std::size_t(context.width) * context.height * 16);
    clear_buffer(gpu.sums);
  }
  if (gpu.curve.bytes == 0) upload(gpu.curve, std::span<const glm::vec4>(make_near_curve()));
  const NearChoice choice = near_choice(frame);
  const FrameNearDrops& set = frame.rain->near_drops;
  const bool scene = context.has("depth"), by_maps = choice.maps_share > 0.0f;
  const int world_is = set.published ? 2 : set.parallax ? 1 : 0;
  if (by_maps) {
    bake_maps(gpu, context, set);
    // Images are kept while they show the same world from the same place.
    const bool moved = world_is == 1 && gpu.seen_from != frame.camera.position_m;
    if (gpu.stamp == 0 || gpu.relit != gpu.world.relights || moved || gpu.world_is != world_is) ++gpu.stamp;
    gpu.relit = gpu.world.relights;
    gpu.seen_from = frame.camera.position_m;
    gpu.world_is = world_is;
  }
  if (scene) context.bind_texture(0, "depth");
  list_drops(gpu, context, choice, scene);
  bind(NEAR_CURVE_BINDING, gpu.curve);
  bind(NEAR_SUMS_BINDING, gpu.sums);
  glBindTextureUnit(1, gpu.world.cube.id);
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, gpu.command.id);
  if (by_maps) {
    bind(NEAR_MAPS_BINDING, gpu.maps);
    bind(NEAR_IMAGES_BINDING, gpu.images);
    const Program& relight = context.program("relight");
    relight.use();
    // Printed: the maps hold places on the huge cube already.
    set_world(gpu, frame, world_is == 1 ? 1 : 0, relight);
    glDispatchComputeIndirect(offsetof(Command, cells));
  }
  const Program& light = context.program("light");
  light.use();
  set_world(gpu, frame, world_is, light);
  glDispatchComputeIndirect(offsetof(Command, light));
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  const Program& draw = context.program(scene ? "draw_scene" : "draw");
  draw.use();
  set_world(gpu, frame, world_is, draw);
  glDispatchComputeIndirect(offsetof(Command, draw));
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, 0);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
  lay_over(gpu, context);
}

}  // namespace

std::vector<PassOffer> near_drops_passes() {
  auto gpu = std::make_shared<NearGpu>();
  newest = gpu;
  const std::string folder = "systems/rainfall/near_drops/";
  std::vector<PassOffer> offers(2);
  offers[0].name = "near_environment";
  offers[0].meaning = "the world captured in six faces at the camera, for drops near the eye";
  offers[0].slots = {{"near_environment", SlotAccess::write}, {"shadow_atlas", SlotAccess::read, true}};
  offers[0].parameters = {{"face", 128.0}, {"face_software", 64.0}};  // texels a side
  const std::string variant = "MATERIAL_VARIANT " + std::to_string(static_cast<unsigned>(variant_general));
  offers[0].shaders = {
      {"surfaces", {{"systems/geometry/gbuffer.vert.glsl", "systems/geometry/gbuffer.frag.glsl"}, {variant}}},
      {"light", {{folder + "near_world.comp.glsl"}, {}}},
      {"light_shadows", {{folder + "near_world.comp.glsl"}, {"SHADOWS"}}}};
  offers[0].wanted = wanted;
  offers[0].execute = [gpu](PassContext& context) {
    const bool shadows = context.has("shadow_atlas");
    if (!gpu->device_known) gpu->software = is_software_gl();
    gpu->device_known = true;
    update_near_world(gpu->world, context.frame,
                      static_cast<int>(context.parameter(gpu->software ? "face_software" : "face")),
                      context.frame.rain->near_drops.step_m, shadows ? &context.texture("shadow_atlas") : nullptr,
                      {context.program("surfaces"), context.program(shadows ? "light_shadows" : "light")});
  };
  offers[1].name = "near_drops";
  offers[1].meaning = "drops near the eye, showing the world refracted and reflected";
  offers[1].slots = {{"colour", SlotAccess::modify},
                     {"near", SlotAccess::read},
                     {"near_environment", SlotAccess::read},
                     {"depth", SlotAccess::read, true},
                     {"occlusion_map", SlotAccess::read, true}};
  offers[1].shaders = {
      {"list", {{folder + "near_list.comp.glsl"}, {}}},
      {"list_scene", {{folder + "near_list.comp.glsl"}, {"SCENE"}}},
      {"light", {{folder + "near_light.comp.glsl"}, {}}},
      {"bake", {{folder + "near_bake.comp.glsl"}, {}}},
      {"relight", {{folder + "near_relight.comp.glsl"}, {}}},
      {"draw", {{folder + "near_draw.comp.glsl"}, {}}},
      {"draw_scene", {{folder + "near_draw.comp.glsl"}, {"SCENE"}}},
      {"over", {{folder + "near_over.comp.glsl"}, {}}},
      {"over_raster", {{"systems/drops/rain_composite.vert.glsl", folder + "near_over.frag.glsl"}, {}}}};
  offers[1].wanted = wanted;
  offers[1].execute = [gpu](PassContext& context) { draw_near_drops(*gpu, context); };
  return offers;
}

namespace {

// By way of a copy: a driver may move a buffer that is read into the computer's memory, where atomics are slow.
void read_copy(const Buffer& buffer, void* data, std::size_t bytes, std::size_t offset = 0) {
  const Buffer copy = make_buffer(bytes);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glCopyNamedBufferSubData(buffer.id, copy.id, static_cast<GLintptr>(offset), 0, static_cast<GLsizeiptr>(bytes));
  read_buffer(copy, data, bytes);
}

}  // namespace

NearStats near_stats() {
  const auto gpu = newest.lock();
  if (!gpu) return {};
  Command command;
  if (gpu->command.bytes >= sizeof command) read_copy(gpu->command, &command, sizeof command);
  return {gpu->world.captures, gpu->world.relights, std::min(command.count, gpu->capacity), command.cells_wanted,
          command.count};
}

NearListed read_near_list() {
  NearListed listed;
  const auto gpu = newest.lock();
  const NearStats stats = near_stats();
  if (!gpu || stats.drops == 0) return listed;
  listed.drops.resize(stats.drops);
  read_copy(gpu->list, listed.drops.data(), listed.drops.size() * sizeof(NearDropGpu));
  std::vector<glm::uvec2> packed(std::size_t(stats.drops) * NEAR_COLUMNS);
  read_copy(gpu->profiles, packed.data(), packed.size() * sizeof(glm::uvec2));
  const auto colour = [](const glm::uvec2& p) {
    return glm::vec3(glm::unpackHalf2x16(p.x), glm::unpackHalf2x16(p.y).x);
  };
  for (const glm::uvec2& p : packed) listed.columns.push_back(colour(p));
  // Those by maps have their columns in the images of cells: means over the drop's own columns of what is drawn.
  std::vector<glm::uvec2> row(static_cast<std::size_t>(std::max(gpu->map_pixels, 1)));
  for (std::size_t i = 0; i < listed.drops.size(); ++i) {
    const NearDropGpu& drop = listed.drops[i];
    if (drop.bits.y == 0) continue;
    const std::size_t area = row.size() * row.size();
    read_copy(gpu->images, row.data(), row.size() * 8, ((drop.bits.y - 1) * (area + row.size()) + area) * 8);
    const int n = static_cast<int>(drop.place.w), fine = 64 / n;
    for (int c = 0; c < n; ++c) {
      glm::vec3 sum(0.0f);
      for (int k = 0; k < fine; ++k) {
        const float last = static_cast<float>(row.size() - 1);
        const float x = (static_cast<float>(c * fine + k) + 0.5f) / static_cast<float>(n * fine);
        const float at = std::clamp(x * static_cast<float>(row.size()) - 0.5f, 0.0f, last), low = std::floor(at);
        const auto left = static_cast<std::size_t>(low);
        sum += glm::mix(colour(row[left]), colour(row[std::min(left + 1, row.size() - 1)]), at - low);
      }
      listed.columns[i * NEAR_COLUMNS + c] = sum / static_cast<float>(fine);
    }
  }
  return listed;
}

}  // namespace petrichor
