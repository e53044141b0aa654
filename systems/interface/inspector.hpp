#pragma once
#include <span>
#include <string>

#include "engine/ecs/registry.hpp"
#include "engine/ecs/schema.hpp"

namespace petrichor {

// What the inspector remembers between frames.
struct InspectorState {
  Entity selected = null_entity;
  char filter[64] = "";
};

// A window made of schemas alone: the entities, and widgets for every field of the selected one's components.
// Returns how many widgets were drawn. Call between ImGui's NewFrame and Render.
int draw_inspector(Registry&, std::span<const Schema>, InspectorState&);

// One field's widget; true where the person changed it. Values stay within the field's range.
bool edit_field(const Field&, void* component);

// "toyshop_sign", or the first component's name and the entity's number.
std::string entity_label(Registry&, std::span<const Schema>, Entity);

}  // namespace petrichor
