#pragma once
#include "components/transform.hpp"
#include "components/view.hpp"
#include "systems/system_context.hpp"

namespace petrichor {

// One fixed step of the person: head, gravity, walls, stairs; or flying through everything. `eye` is the
// walker's Transform: its position is the eyes. Without a collision scene there is no ground to stand on,
// so a walker flies.
void step_walker(Walker&, Transform& eye, const PlayerInput&, const CollisionScene*, double step_s);

// Steps every Walker with a Transform.
void walk(SystemContext&);

}  // namespace petrichor
