#pragma once
// A loaded Model becomes entities.

#include <cstdint>
#include <vector>

#include "components/components.hpp"
#include "engine/assets/model.hpp"
#include "engine/core/result.hpp"
#include "engine/ecs/registry.hpp"

namespace petrichor {

// One entity per node, in the order of Model::nodes: Name, Transform, Parent (roots: `parent`, if any),
// MeshInstance{model_index, mesh}, Light (KHR_lights_punctual; casts no shadow unless extras say so) and
// Camera (not active unless extras say so) where the node has them.
//
// Components ride in a node's extras: {"drip_source": {"length_m": 3}}. Every key that names a component and
// holds an object is applied through its schema, on top of what the node gave; other keys belong to others
// and are left alone. Inside an object "petrichor" every key must name a component.
//
// Errors name file, JSON path and what the schema says; then nothing was spawned.
Result<std::vector<Entity>> spawn_model(Registry&, const Model&, std::uint32_t model_index,
                                        Entity parent = null_entity);

}  // namespace petrichor
