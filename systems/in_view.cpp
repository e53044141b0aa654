#include "systems/in_view.hpp"

#include <algorithm>

#include "systems/frustum.hpp"
#include "systems/gpu_scene.hpp"
#include "systems/gpu_scene_impl.hpp"

namespace petrichor {

bool any_surface_in_view(const Frame& frame, float reach_m) {
  if (!frame.scene || frame.instances.empty()) return !frame.instances.empty();
  const GpuScene::Impl& scene = *frame.scene->impl;
  const Frustum frustum = frustum_of(frame.uniforms.view_projection);
  constexpr float stands_up_m = 0.1f;
  return std::any_of(scene.items.begin(), scene.items.end(), [&](const SceneItem& item) {
    if (scene.materials[scene.chunks[item.chunk].material].alpha_mode == AlphaMode::blend) return false;
    const glm::vec3 half = item.half_extent_m + stands_up_m;
    const glm::vec3 away = glm::max(glm::abs(item.centre_m) - half, glm::vec3(0.0f));
    return glm::length(away) <= reach_m && box_touches(frustum, item.centre_m, half);
  });
}

}  // namespace petrichor
