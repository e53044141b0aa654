#include "systems/drip/passes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>

#include "systems/drip/drip.hpp"
#include "systems/drip/drip_shared.h"
#include "systems/drip/normal_map.hpp"
#include "systems/drip_frame.hpp"
#include "systems/drops/lists.hpp"
#include "systems/drops/rain_shared.h"

namespace petrichor {
namespace {

struct DripGpuState {
  Buffer drips, clusters, lamps, looks;
  Texture normals;
  VertexArray no_vertices;
  bool software = false, device_known = false;
  std::vector<DripGpu> picked;  // kept for their memory
  std::vector<std::pair<float, std::uint32_t>> order;
  std::shared_ptr<RainOptics> optics;
  std::shared_ptr<RainSums> sums;
};

void bind(GLuint binding, const Buffer& buffer) {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, binding, buffer.id);
}

float share(const Frame& frame, DripRung rung) {
  return frame.techniques.share(Effect::drips, rung);
}

bool has_drops(const Frame& frame) {
  return frame.drips && !frame.drips->drops.empty();
}

float pixels_per_radian(const Frame& frame) {
  return 0.5f * static_cast<float>(frame.height) / std::tan(0.5f * frame.camera.vertical_fov_rad);
}

// Its way while the shutter is open, with what it is higher than wide; what stands still is drawn as high as it is.
DripGpu to_gpu(const Frame& frame, const FrameDrip& d, bool billboard) {
  const float wide = 1e-3f * d.diameter_mm * std::pow(d.stretch, -1.0f / 3.0f), high = wide * d.stretch;
  glm::vec3 place(d.place_m - frame.camera.position_m), velocity = d.velocity_mps;
  const float speed = glm::length(velocity), exposure = frame.camera.exposure_s;
  if (high > wide && speed > 1e-3f && exposure > 1e-6f) {
    const glm::vec3 way = velocity / speed;
    place += way * (0.5f * (high - wide));
    velocity += way * ((high - wide) / exposure);
  }
  return {{place, wide}, {velocity, d.stretch}, {d.seed, d.cluster, d.source, billboard ? 1u : 0u}};
}

// Uploads the drops that `drawn` picks, in their order or from far to near. Returns how many.
template <class Drawn>
std::uint32_t pick(DripGpuState& gpu, const Frame& frame, bool far_to_near, Drawn drawn) {
  const FrameDrips& f = *frame.drips;
  gpu.picked.clear();
  gpu.order.clear();
  for (std::uint32_t i = 0; i < f.drops.size(); ++i) {
    const DripDrawing how = drawn(f.drops[i]);
    if (how == DripDrawing::none) continue;
    if (far_to_near) {
      const glm::dvec3 d = f.drops[i].place_m - frame.camera.position_m;
      gpu.order.emplace_back(-static_cast<float>(glm::dot(d, d)), static_cast<std::uint32_t>(gpu.picked.size()));
    }
    gpu.picked.push_back(to_gpu(frame, f.drops[i], how == DripDrawing::billboard));
  }
  if (gpu.picked.empty()) return 0;
  if (far_to_near) {
    std::sort(gpu.order.begin(), gpu.order.end());
    std::vector<DripGpu> sorted;
    sorted.reserve(gpu.picked.size());
    for (const auto& [distance, i] : gpu.order) sorted.push_back(gpu.picked[i]);
    gpu.picked.swap(sorted);
  }
  upload(gpu.drips, std::span<const DripGpu>(gpu.picked));
  bind(DRIPS_BINDING, gpu.drips);
  return static_cast<std::uint32_t>(gpu.picked.size());
}

void light_clusters(DripGpuState& gpu, PassContext& context) {
  const Frame& frame = context.frame;
  std::vector<glm::vec4> clusters;
  for (const DripCluster& c : frame.drips->clusters)
    clusters.emplace_back(glm::vec3(c.centre_m - frame.camera.position_m), c.radius_m);
  if (clusters.empty()) clusters.emplace_back(0.0f);
  upload(gpu.clusters, std::span<const glm::vec4>(clusters));
  if (gpu.lamps.bytes < clusters.size() * sizeof(DripLampsGpu))
    gpu.lamps = make_buffer(2 * clusters.size() * sizeof(DripLampsGpu));
  bind(DRIP_CLUSTERS_BINDING, gpu.clusters);
  bind(DRIP_LAMPS_BINDING, gpu.lamps);
  const Program& program = context.program(gpu.software ? "lamps_software" : "lamps");
  program.use();
  program.set("cluster_count", static_cast<unsigned>(clusters.size()));
  program.set("least_radiance", context.parameter("least_radiance"));
  program.dispatch(static_cast<int>(clusters.size()));
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

glm::vec3 distances(const Frame& frame) {
  return {std::max(frame.camera.near_m, 0.1f), 1e4f, 1e4f};  // which drops there are was decided before
}

void begin(DripGpuState& gpu, PassContext& context) {
  if (!gpu.device_known) gpu.software = is_software_gl();
  gpu.device_known = true;
  bind_rain_optics(*gpu.optics, context.frame);
}

void draw_streaks(DripGpuState& gpu, PassContext& context) {
  const Frame& frame = context.frame;
  begin(gpu, context);
  bind_rain_sums(*gpu.sums, context.width, context.height);
  const std::uint32_t count = pick(gpu, frame, false, [&](const FrameDrip& d) {
    const DripDrawing how = drawing_of(frame, d);
    return how == DripDrawing::streak ? how : DripDrawing::none;
  });
  if (count == 0) return;
  const bool scene = context.has("depth"), lamps = frame.uniforms.counts.x > 0;
  if (lamps) light_clusters(gpu, context);
  if (scene) context.bind_texture(0, "depth");
  const Program& program = context.program(drop_shader(gpu.software ? "streaks_software" : "streaks", scene, lamps));
  program.use();
  program.set("drip_count", unsigned(count));
  program.set("distances", distances(frame));
  // program.dispatch goes by invocations.
  program.dispatch(static_cast<int>(count) * (gpu.software ? 1 : 16));
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
}

void draw_pictures(DripGpuState& gpu, PassContext& context) {
  const Frame& frame = context.frame;
  begin(gpu, context);
  // Refracting drops are few and cover each other rightly. Of billboards, thousands, only drops of a pixel overlap.
  const bool few = share(frame, DripRung::billboards) == 0.0f;
  const std::uint32_t count = pick(gpu, frame, few, [&](const FrameDrip& d) {
    const DripDrawing how = drawing_of(frame, d);
    return how == DripDrawing::streak ? DripDrawing::none : how;
  });
  if (count == 0) return;
  if (!gpu.normals.id) gpu.normals = make_droplet_normals();
  std::vector<DripLooksGpu> looks;
  for (const DripLooks& l : frame.drips->sources)
    looks.push_back({{l.opacity, l.edge_strength, l.edge_bias, l.elongation}, {l.published ? 1.0f : 0.0f, 0, 0, 0}});
  upload(gpu.looks, std::span<const DripLooksGpu>(looks));
  const bool scene = context.has("depth"), lamps = frame.uniforms.counts.x > 0;
  if (lamps) light_clusters(gpu, context);
  bind(DRIP_LOOKS_BINDING, gpu.looks);
  if (scene) context.bind_texture(0, "depth");
  if (context.has("environment")) context.bind_texture(7, "environment");
  glBindTextureUnit(DRIP_NORMALS_UNIT, gpu.normals.id);
  if (!gpu.no_vertices) {
    GLuint id = 0;
    glCreateVertexArrays(1, &id);
    gpu.no_vertices = VertexArray(id);
  }
  static constexpr std::array<std::string_view, 1> colours{"colour"};
  context.bind_framebuffer(colours, "");
  std::string name = drop_shader("pictures", scene, lamps);
  if (context.has("environment")) name += "_environment";
  const Program& program = context.program(name);
  program.use();
  program.set("first_drip", 0u);
  program.set("distances", distances(frame));
  program.set("reach_m", std::max(frame.drips->reach_m, 1.0f));
  program.set("lightning", frame.rain ? frame.rain->layered.lightning : 0.0f);
  glBindVertexArray(gpu.no_vertices);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_ONE, GL_SRC_ALPHA, GL_ZERO, GL_ONE);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(count));
  glDisable(GL_BLEND);
  glBindVertexArray(0);
}

constexpr const char* folder = "systems/drip/";

void add_lamp_shaders(PassOffer& offer) {
  offer.parameters = {{"least_radiance", 0.004}};
  offer.shaders["lamps"] = {{std::string(folder) + "drip_lamps.comp.glsl"}, {}};
  offer.shaders["lamps_software"] = {{std::string(folder) + "drip_lamps.comp.glsl"}, {"SOFTWARE"}};
}

}  // namespace

DripDrawing drawing_of(const Frame& frame, const FrameDrip& d) {
  const float u = static_cast<float>((d.seed * 0x9e3779b1u) >> 8u) * 5.9604644775390625e-8f;
  const float billboards = share(frame, DripRung::billboards), streaks = share(frame, DripRung::streaks);
  if (u < billboards) return DripDrawing::billboard;
  if (u < billboards + streaks) return DripDrawing::streak;
  if (u >= billboards + streaks + share(frame, DripRung::refracting)) return DripDrawing::none;
  const float away = static_cast<float>(glm::length(d.place_m - frame.camera.position_m));
  return 0.5e-3f * d.diameter_mm * pixels_per_radian(frame) >= frame.drips->shows_world_px * away
             ? DripDrawing::refracting
             : DripDrawing::streak;
}

bool draws_drip_streaks(const Frame& frame) {
  return has_drops(frame) && share(frame, DripRung::streaks) + share(frame, DripRung::refracting) > 0.0f;
}

bool draws_drip_pictures(const Frame& frame) {
  if (!has_drops(frame)) return false;
  if (share(frame, DripRung::billboards) > 0.0f) return true;
  if (!(share(frame, DripRung::refracting) > 0.0f)) return false;
  return std::any_of(frame.drips->drops.begin(), frame.drips->drops.end(),
                     [&](const FrameDrip& d) { return drawing_of(frame, d) == DripDrawing::refracting; });
}

std::vector<PassOffer> drip_passes(const DropPainting& painting) {
  auto gpu = std::make_shared<DripGpuState>();
  gpu->optics = painting.optics;
  gpu->sums = painting.sums;
  std::vector<PassOffer> offers(2);
  PassOffer& streaks = offers[0];
  streaks.name = "drips";
  streaks.meaning = "drops that hang from edges and fall, as streaks, into the sums that rain_composite lays over";
  streaks.slots = {{"depth", SlotAccess::read, true}};
  streaks.side_effect = true;
  add_lamp_shaders(streaks);
  for (const bool scene : {false, true})
    for (const bool lamps : {false, true})
      for (const bool software : {false, true}) {
        std::vector<std::string> defines;
        if (scene) defines.emplace_back("SCENE");
        if (lamps) defines.emplace_back("LAMPS");
        if (software) defines.emplace_back("SOFTWARE");
        streaks.shaders[drop_shader(software ? "streaks_software" : "streaks", scene, lamps)] = {
            {std::string(folder) + "drips.comp.glsl"}, defines};
      }
  streaks.wanted = draws_drip_streaks;
  streaks.execute = [gpu](PassContext& context) { draw_streaks(*gpu, context); };

  PassOffer& pictures = offers[1];
  pictures.name = "drips_over";
  pictures.meaning = "drips as pictures of drops: billboards, and near ones that show the world";
  pictures.slots = {
      {"colour", SlotAccess::modify}, {"depth", SlotAccess::read, true}, {"environment", SlotAccess::read, true}};
  add_lamp_shaders(pictures);
  for (const bool scene : {false, true})
    for (const bool lamps : {false, true})
      for (const bool environment : {false, true}) {
        std::vector<std::string> defines;
        if (scene) defines.emplace_back("SCENE");
        if (lamps) defines.emplace_back("LAMPS");
        if (environment) defines.emplace_back("ENVIRONMENT");
        pictures.shaders[drop_shader("pictures", scene, lamps) + (environment ? "_environment" : "")] = {
            {std::string(folder) + "drips_over.vert.glsl", std::string(folder) + "drips_over.frag.glsl"}, defines};
      }
  pictures.wanted = draws_drip_pictures;
  pictures.execute = [gpu](PassContext& context) { draw_pictures(*gpu, context); };
  return offers;
}

}  // namespace petrichor
