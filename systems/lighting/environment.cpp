#include "systems/lighting/environment.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "systems/frame_gpu.hpp"
#include "systems/gpu_scene.hpp"
#include "systems/lighting/chosen_lights.hpp"

namespace petrichor {
namespace {

constexpr float eye_level_m = 2.0f;  // of the lowest storey of the grid
constexpr std::size_t most_probes = 12;

EnvironmentProbe& find_probe(Environment& environment, const glm::ivec3& cell) {
  auto& probes = environment.probes;
  auto found = std::find_if(probes.begin(), probes.end(), [&](const auto& p) { return p.cell == cell; });
  if (found == probes.end()) {
    if (probes.size() < most_probes) {
      probes.emplace_back();
      make_probe_targets(probes.back());
      found = probes.end() - 1;
    } else {
      found = std::min_element(probes.begin(), probes.end(),
                               [](const auto& a, const auto& b) { return a.last_used < b.last_used; });
    }
    found->cell = cell;
    found->captured = found->lit = false;
  }
  found->last_used = ++environment.clock;
  return *found;
}

}  // namespace

std::vector<EnvironmentCorner> environment_corners(const glm::dvec3& camera_m, float spacing_m) {
  const double x = camera_m.x / spacing_m, z = camera_m.z / spacing_m;
  const int x0 = static_cast<int>(std::floor(x)), z0 = static_cast<int>(std::floor(z));
  const int y = static_cast<int>(std::round((camera_m.y - eye_level_m) / spacing_m));
  // A plateau round each place, so that standing near one costs one capture.
  const auto share = [](double f) { return static_cast<float>(std::clamp((f - 0.25) / 0.5, 0.0, 1.0)); };
  const float fx = share(x - x0), fz = share(z - z0);
  std::vector<EnvironmentCorner> corners;
  for (int i = 0; i < 4; ++i) {
    const float weight = (i & 1 ? fx : 1.0f - fx) * (i & 2 ? fz : 1.0f - fz);
    if (weight > 0.0f) corners.push_back({{x0 + (i & 1), y, z0 + (i >> 1)}, weight});
  }
  return corners;
}

glm::dvec3 environment_place_m(const glm::ivec3& cell, float spacing_m) {
  return glm::dvec3(cell) * static_cast<double>(spacing_m) + glm::dvec3(0.0, eye_level_m, 0.0);
}

void update_environment(Environment& environment, const Frame& frame, float spacing_m, const Texture* shadow_atlas,
                        std::span<const int> shadow_slots, const EnvironmentPrograms& programs, const Texture& target) {
  if (environment.geometry_version != frame.geometry_version || environment.scene != frame.scene) {
    for (EnvironmentProbe& probe : environment.probes) probe.captured = false;
    environment.geometry_version = frame.geometry_version;
    environment.scene = frame.scene;
  }
  if (environment.shadows != (shadow_atlas != nullptr)) {
    for (EnvironmentProbe& probe : environment.probes) probe.lit = false;
    environment.shadows = shadow_atlas != nullptr;
  }
  const std::uint64_t lighting = lighting_hash(frame);

  const std::vector<EnvironmentCorner> corners = environment_corners(frame.camera.position_m, spacing_m);
  Frame around;
  bool moved_instances = false;
  std::array<GLuint, 8> textures{};  // four captures, and their own light
  glm::vec4 weights(0.0f);
  for (std::size_t i = 0; i < corners.size(); ++i) {
    EnvironmentProbe& probe = find_probe(environment, corners[i].cell);
    if (!probe.captured || !probe.lit || probe.lighting != lighting) {
      if (around.width == 0) {
        around = frame_around(frame);
        around.instances = frame.instances;
      }
      around.camera.position_m = environment_place_m(corners[i].cell, spacing_m);
      if (!probe.captured) {
        capture_faces(probe, around, programs.surfaces);
        ++environment.captures;
        moved_instances = true;
      }
      light_faces(probe, around, shadow_slots, shadow_atlas, programs.light, environment.lights);
      filter_faces(probe, programs);
      probe.lighting = lighting;
    }
    textures[i] = probe.environment.id;
    textures[4 + i] = probe.own_environment.id;
    weights[static_cast<int>(i)] = corners[i].weight;
  }
  for (std::size_t i = corners.size(); i < 4; ++i) textures[i] = textures[0], textures[4 + i] = textures[4];
  if (moved_instances && frame.scene) upload_instances(*frame.scene, frame);

  glBindTextures(0, 8, textures.data());
  glBindImageTexture(0, target.id, 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RGBA16F);
  programs.blend.use();
  programs.blend.set("weights", weights);
  programs.blend.dispatch(ENVIRONMENT_WIDTH, ENVIRONMENT_HEIGHT);
}

}  // namespace petrichor
