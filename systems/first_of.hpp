#pragma once
// Of several entities with a component, the one of the lowest index: an answer that does not depend on the order in
// which components lie in storage.

#include "engine/ecs/registry.hpp"

namespace petrichor {

template <class Component>
struct First {
  Entity entity = null_entity;
  const Component* component = nullptr;  // null: there is none; until that storage changes
  explicit operator bool() const { return component != nullptr; }
  const Component* operator->() const { return component; }
  const Component& operator*() const { return *component; }
};

// fits(const Component&): whether it counts.
template <class Component>
First<Component> first_of(const Registry& registry, auto&& fits) {
  First<Component> first;
  registry.view<Component>().each([&](Entity entity, const Component& found) {
    if ((!first || entity_index(entity) < entity_index(first.entity)) && fits(found)) first = {entity, &found};
  });
  return first;
}
template <class Component>
First<Component> first_of(const Registry& registry) {
  return first_of<Component>(registry, [](const Component&) { return true; });
}

}  // namespace petrichor
