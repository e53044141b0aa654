#pragma once
// Which reflectors a frame can afford, and what they shine with.

#include <vector>

#include "systems/frame.hpp"
#include "systems/reflection/reflection_shared.h"
#include "systems/reflector_frame.hpp"

namespace petrichor {

// Nearest first, at most MAXIMUM_REFLECTORS, of which a quarter posts. The dimmest fade before they are left out, so
// that nothing pops while the camera moves. What a frame's light stands for already (a lamp's glass) is taken off its
// panel; posts shine as the lamps light them. with_lamps: lamps, too (the published rung draws them alike).
ReflectorsGpu choose_reflectors(const Frame&, const std::vector<Reflector>&, bool with_lamps);

}  // namespace petrichor
