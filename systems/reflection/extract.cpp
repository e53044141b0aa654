#include "systems/reflection/extract.hpp"

#include "systems/reflection/reflectors.hpp"

namespace petrichor {

void extract_reflectors(ReflectorFinder& finder, const std::vector<std::shared_ptr<const Model>>& models,
                        Frame& frame) {
  if (frame.techniques.share(Effect::reflections, ReflectionRung::environment) >= 1.0f) return;
  if (finder.models != models.size()) finder = {.models = models.size()};
  if (!finder.placed || finder.geometry_version != frame.geometry_version) {
    auto placed = std::make_shared<FrameReflectors>();
    finder.any_mirrors = false;
    for (const FrameInstance& instance : frame.instances) {
      if (instance.model >= models.size() || !models[instance.model]) continue;
      const Model& model = *models[instance.model];
      if (instance.mesh >= model.meshes.size()) continue;
      const auto [found, fresh] = finder.of_mesh.try_emplace({instance.model, instance.mesh});
      if (fresh) found->second = find_reflectors(model, model.meshes[instance.mesh]);
      const auto [mirrors, new_mesh] = finder.mirrors.try_emplace({instance.model, instance.mesh});
      if (new_mesh) mirrors->second = mirrors_things(model, model.meshes[instance.mesh]);
      finder.any_mirrors = finder.any_mirrors || mirrors->second;
      for (const Reflector& r : found->second) placed->all.push_back(moved(r, instance.matrix));
    }
    finder.geometry_version = frame.geometry_version;
    finder.placed = std::move(placed);
  }
  const bool wet = frame.wetness || frame.puddles || (frame.rain && frame.rain->rain_mm_per_hour > 0.0f);
  if (!frame.instances.empty() && (finder.any_mirrors || wet)) frame.reflectors = finder.placed;
}

}  // namespace petrichor
