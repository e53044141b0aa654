#include "systems/scene/propagate.hpp"

#include <algorithm>
#include <cstdint>
#include <glm/gtc/quaternion.hpp>
#include <vector>

#include "engine/core/log.hpp"

namespace petrichor {
namespace {

enum class State : std::uint8_t { unknown, pending, known };

struct Slot {
  State state = State::unknown;
  glm::mat4 world{1.0f};
};

void match_storages(Registry& registry) {
  std::vector<Entity> gained, lost;
  registry.view<Transform>().without<WorldTransform>().each([&](Entity e, Transform&) { gained.push_back(e); });
  registry.view<WorldTransform>().without<Transform>().each([&](Entity e, WorldTransform&) { lost.push_back(e); });
  for (Entity e : gained) registry.emplace<WorldTransform>(e);
  for (Entity e : lost) registry.remove<WorldTransform>(e);
}

Slot& slot_of(std::vector<Slot>& slots, Entity e) {
  const std::size_t index = entity_index(e);
  if (index >= slots.size()) slots.resize(std::max(index + 1, slots.size() * 2));
  return slots[index];
}

}  // namespace

glm::mat4 transform_matrix(const Transform& t) {
  glm::mat4 m = glm::mat4_cast(t.orientation);
  for (int c = 0; c < 3; ++c) m[c] *= t.scale[c];
  m[3] = glm::vec4(t.position_m, 1.0f);
  return m;
}

void propagate_transforms(Registry& registry) {
  match_storages(registry);
  std::vector<Slot> slots;
  std::vector<Entity> chain;      // from an entity up to the first ancestor whose place is known
  std::vector<Entity> ring_ends;  // whose Parent closes a ring
  registry.view<const Transform, WorldTransform>().each([&](Entity e, const Transform&, WorldTransform& out) {
    glm::mat4 world(1.0f);
    for (Entity at = e;;) {
      Slot& slot = slot_of(slots, at);
      if (slot.state == State::known) {
        world = slot.world;
        break;
      }
      if (slot.state == State::pending) {
        ring_ends.push_back(chain.back());
        break;
      }
      slot.state = State::pending;
      chain.push_back(at);
      const Parent* parent = registry.find<Parent>(at);
      if (parent == nullptr || !registry.alive(parent->entity)) break;
      at = parent->entity;
    }
    for (; !chain.empty(); chain.pop_back()) {
      if (const Transform* t = registry.find<Transform>(chain.back())) world = world * transform_matrix(*t);
      slot_of(slots, chain.back()) = {State::known, world};
    }
    out.matrix = slot_of(slots, e).world;
  });
  for (Entity e : ring_ends) {
    const Name* name = registry.find<Name>(e);
    log_error("entity {} (\"{}\") is its own ancestor: its Parent is removed", entity_index(e), name ? name->text : "");
    registry.remove<Parent>(e);
  }
}

}  // namespace petrichor
