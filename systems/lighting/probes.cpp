#include "systems/lighting/probes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>

#include "systems/gpu_scene.hpp"
#include "systems/lighting/chosen_lights.hpp"
#include "systems/mirror_frame.hpp"
#include "systems/mirror_shared.h"

namespace petrichor {
namespace {

constexpr std::size_t most_captures = 4 * PROBES + 8;
constexpr double height_step_m = 1.0 / 16.0;

std::uint64_t mixed(std::uint64_t state) {  // the finaliser of splitmix64
  state = (state ^ (state >> 30)) * 0xbf58476d1ce4e5b9ull;
  state = (state ^ (state >> 27)) * 0x94d049bb133111ebull;
  return state ^ (state >> 31);
}

std::uint64_t hash_of(const FrameInstance& instance) {
  std::uint64_t words[8], hash = mixed((std::uint64_t{instance.model} << 32 | instance.mesh) + 0x9e3779b97f4a7c15ull);
  static_assert(sizeof words == sizeof instance.matrix);
  std::memcpy(words, &instance.matrix, sizeof words);
  for (const std::uint64_t word : words) hash = mixed(hash ^ word);
  return hash;
}

bool belongs(const FrameMirrors::Probe& probe, const FrameInstance& instance) {
  return std::binary_search(probe.own.begin(), probe.own.end(), instance.entity);
}

ProbeCapture& find_capture(Probes& probes, const FrameMirrors::Probe& probe, const glm::i64vec3& cell,
                           std::uint64_t others) {
  auto& all = probes.captures;
  auto found = std::find_if(all.begin(), all.end(), [&](const ProbeCapture& c) {
    return c.entity == probe.entity && c.cell == cell && c.others == others && c.faces.captured;
  });
  if (found == all.end()) {
    if (all.size() < most_captures) {
      all.emplace_back();
      make_probe_targets(all.back().faces);
      found = all.end() - 1;
    } else {
      found = std::min_element(all.begin(), all.end(),
                               [](const auto& a, const auto& b) { return a.last_used < b.last_used; });
    }
    found->entity = probe.entity;
    found->cell = cell;
    found->others = others;
    found->faces.captured = found->faces.lit = false;
  }
  found->last_used = ++probes.clock;
  return *found;
}

}  // namespace

std::vector<ProbeCorner> probe_corners(const glm::dvec3& place_m, float step_m) {
  const double x = place_m.x / double(step_m), z = place_m.z / double(step_m);
  const auto x0 = static_cast<std::int64_t>(std::floor(x)), z0 = static_cast<std::int64_t>(std::floor(z));
  const auto y = static_cast<std::int64_t>(std::llround(place_m.y / height_step_m));
  const auto share = [](double f) { return static_cast<float>(std::clamp((f - 0.25) / 0.5, 0.0, 1.0)); };
  const float fx = share(x - static_cast<double>(x0)), fz = share(z - static_cast<double>(z0));
  std::vector<ProbeCorner> corners;
  for (int i = 0; i < 4; ++i) {
    const float weight = (i & 1 ? fx : 1.0f - fx) * (i & 2 ? fz : 1.0f - fz);
    if (weight > 0.0f) corners.push_back({{x0 + (i & 1), y, z0 + (i >> 1)}, weight});
  }
  return corners;
}

glm::dvec3 probe_corner_m(const glm::i64vec3& cell, float step_m) {
  return {static_cast<double>(cell.x) * double(step_m), static_cast<double>(cell.y) * height_step_m,
          static_cast<double>(cell.z) * double(step_m)};
}

void update_probes(Probes& probes, const Frame& frame, float step_m, const Texture* shadow_atlas,
                   std::span<const int> shadow_slots, const ProbePrograms& programs, const Texture& target) {
  if (probes.scene != frame.scene || probes.step_m != step_m) probes.captures.clear();
  probes.scene = frame.scene;
  probes.step_m = step_m;
  // Which lamps have shadow maps follows the camera, on its own coarse grid.
  std::uint64_t lighting = mixed(lighting_hash(frame) + (shadow_atlas ? 1u : 0u));
  // The object throws shadows, too: where it moves, its surroundings are lit anew, not captured.
  if (shadow_atlas) lighting = mixed(mixed(lighting ^ frame.geometry_version) ^ frame.lights_version);
  for (std::size_t i = 0; shadow_atlas && i < shadow_slots.size(); ++i)
    lighting = mixed(lighting ^ static_cast<std::uint64_t>(shadow_slots[i] >= 0 ? i + 1 : 0));

  ProbesGpu gpu{};
  const auto& all = frame.mirrors->probes;
  gpu.counts.x = static_cast<unsigned>(std::min<std::size_t>(all.size(), PROBES));
  std::uint64_t everything = 0;
  for (const FrameInstance& instance : frame.instances) everything += hash_of(instance);
  Frame around = frame_around(frame);
  const float share = frame.techniques.share(Effect::probes, ProbeRung::moving);
  bool moved_instances = false;
  for (unsigned i = 0; i < gpu.counts.x; ++i) {
    const FrameMirrors::Probe& probe = all[i];
    const glm::dvec3 relative = probe.place_m - frame.camera.position_m;
    gpu.place_radius[i] = {glm::vec3(relative), probe.radius_m};
    gpu.more[i] = {probe.coverage > 0.0f ? probe.share * share : 0.0f, 0.0f, 0.0f, 0.0f};
    if (probe.coverage <= 0.0f) continue;
    std::uint64_t others = everything;
    for (const FrameInstance& instance : frame.instances)
      if (belongs(probe, instance)) others -= hash_of(instance);

    std::array<GLuint, 4> textures{};
    std::array<glm::vec4, 4> offset_weight{};
    const std::vector<ProbeCorner> corners = probe_corners(probe.place_m, step_m);
    for (std::size_t k = 0; k < corners.size(); ++k) {
      ProbeCapture& capture = find_capture(probes, probe, corners[k].cell, others);
      around.camera.position_m = probe_corner_m(corners[k].cell, step_m);
      if (!capture.faces.captured) {
        around.instances.clear();
        for (const FrameInstance& instance : frame.instances)
          if (!belongs(probe, instance)) around.instances.push_back(instance);
        capture_faces(capture.faces, around, programs.surfaces);
        ++probes.captured;
        moved_instances = true;
      }
      if (!capture.faces.lit || capture.faces.lighting != lighting) {
        light_faces(capture.faces, around, shadow_slots, shadow_atlas, programs.light, probes.lights);
        filter_mirrored(capture.faces, programs.filter);
        capture.faces.lighting = lighting;
        ++probes.lit;
      }
      textures[k] = capture.faces.environment.id;
      offset_weight[k] = {glm::vec3(probe.place_m - around.camera.position_m), corners[k].weight};
    }
    for (std::size_t k = corners.size(); k < 4; ++k) textures[k] = textures[0];
    glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
    glBindTextures(0, 4, textures.data());
    glBindImageTexture(0, target.id, 0, GL_FALSE, static_cast<GLint>(i), GL_WRITE_ONLY, GL_RGBA16F);
    programs.blend.use();
    for (int k = 0; k < 4; ++k)
      programs.blend.set("offset_weight[" + std::to_string(k) + "]", offset_weight[static_cast<std::size_t>(k)]);
    programs.blend.dispatch(ENVIRONMENT_LEVELS * ENVIRONMENT_TILE, ENVIRONMENT_TILE);
  }
  if (moved_instances && frame.scene) upload_instances(*frame.scene, frame);
  upload(probes.block, &gpu, sizeof gpu);
  glBindBufferRange(GL_UNIFORM_BUFFER, PROBES_BINDING, probes.block.id, 0, sizeof gpu);
}

}  // namespace petrichor
