#pragma once
// Where things are in the world.

#include <glm/glm.hpp>

#include "components/transform.hpp"
#include "engine/ecs/registry.hpp"

namespace petrichor {

// translation x rotation x scale.
glm::mat4 transform_matrix(const Transform&);

// Writes the WorldTransform of every entity that has a Transform, and takes it from those that lost theirs.
// An entity without Transform between two others counts as unmoved; a dead parent as none. Where Parents
// form a ring, one of its links is removed and an error is logged. O(entities), no recursion.
void propagate_transforms(Registry&);

}  // namespace petrichor
