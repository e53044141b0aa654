#pragma once
#include "engine/ecs/registry.hpp"
#include "systems/frame.hpp"

namespace petrichor {

// The first Sky and the first Fog; without one the night is black and the air clear.
void extract_atmosphere(const Registry&, Frame&);

}  // namespace petrichor
