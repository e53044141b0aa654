#pragma once
// The ladders of everything that falls, and of what is drawn of it.

#include "systems/ladder.hpp"

namespace petrichor {

Ladder rainfall_ladder();
Ladder snow_ladder();
Ladder streaks_ladder();
Ladder near_drops_ladder();

}  // namespace petrichor
