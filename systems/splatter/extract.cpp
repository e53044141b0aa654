#include <unordered_map>

#include "components/transform.hpp"
#include "components/view.hpp"
#include "components/water.hpp"
#include "engine/assets/model.hpp"
#include "systems/splatter/mist.hpp"
#include "systems/splatter/splatter.hpp"
#include "systems/splatter_frame.hpp"

namespace petrichor {
namespace {

// The mark that an entity stands under: its own, or that of the nearest above it.
const RainCatcher* mark_of(const Registry& registry, Entity entity) {
  for (int depth = 0; depth < 64; ++depth) {
    if (const RainCatcher* mark = registry.find<RainCatcher>(entity)) return mark;
    const Parent* parent = registry.find<Parent>(entity);
    if (!parent || !registry.alive(parent->entity)) return nullptr;
    entity = parent->entity;
  }
  return nullptr;
}

}  // namespace

void extract_splatter(const Registry& registry, const std::vector<std::shared_ptr<const Model>>& models, Frame& frame) {
  frame.splatter = nullptr;
  if (!frame.rain || !(frame.rain->rain_mm_per_hour > 0.0f)) return;
  std::unordered_map<std::uint32_t, const RainCatcher*> marked;  // by entity index
  registry.view<MeshInstance>().each([&](Entity entity, const MeshInstance&) {
    if (const RainCatcher* mark = mark_of(registry, entity)) marked[entity_index(entity)] = mark;
  });
  if (marked.empty()) return;
  auto out = std::make_shared<FrameSplatter>();
  for (std::size_t i = 0; i < frame.instances.size(); ++i) {
    const FrameInstance& in = frame.instances[i];
    const auto found = marked.find(in.entity);
    if (found == marked.end() || in.model >= models.size() || in.mesh >= models[in.model]->meshes.size()) continue;
    const RainCatcher& mark = *found->second;
    // The mesh shares its model's life.
    out->catchers.push_back({static_cast<std::uint32_t>(i),
                             std::shared_ptr<const Mesh>(models[in.model], &models[in.model]->meshes[in.mesh]),
                             in.entity, mark.splatter, mark.halo, mark.halo_height, mark.shells,
                             1e-3f * mark.shell_height_mm, mark.published});
  }
  if (out->catchers.empty()) return;
  out->mist = splash_mist(*frame.rain);
  frame.splatter = std::move(out);
}

}  // namespace petrichor
