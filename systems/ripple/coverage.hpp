#pragma once
// How much of the picture is standing water.

#include "systems/frame.hpp"

namespace petrichor {

// About the share of the picture that puddles with water in them cover, those near enough to show rings; 0 exactly
// where none is in view.
double water_coverage(const Frame&);

}  // namespace petrichor
