#pragma once
// The two lists of the engine: its systems in frame order, and the passes they offer to the render scripts.

#include <string_view>
#include <vector>

#include "engine/ecs/schedule.hpp"
#include "engine/graph/graph.hpp"
#include "systems/chart.hpp"
#include "systems/ladder.hpp"
#include "systems/system_context.hpp"

namespace petrichor {

std::vector<SystemEntry<SystemContext>> all_systems();
// Things a system may read that no system writes: "time", "input".
std::vector<std::string_view> outside_resources();

std::vector<PassOffer> all_passes();

// Here too: all_ladders() of systems/ladder.hpp, and all_charts() of systems/chart.hpp.

}  // namespace petrichor
