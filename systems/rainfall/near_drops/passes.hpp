#pragma once
// The passes of near drops: near_environment (the world captured in six faces) and near_drops (lists the drops of the
// field that are wide enough, lights and draws them). After rain_composite; rain_splat leaves those drops out where its
// slot `near` is read.

#include <cstdint>
#include <vector>

#include "engine/graph/graph.hpp"
#include "systems/frame.hpp"
#include "systems/rainfall/near_drops/near_shared.h"

namespace petrichor {

std::vector<PassOffer> near_drops_passes();

struct NearStats {
  std::uint64_t captures = 0, relights = 0;  // of the world, since start
  std::uint32_t drops = 0, cells_made = 0;   // of the last frame
  std::uint32_t found = 0;                   // more than `drops`: the list could not hold them
};
NearStats near_stats();  // of the graph made last; waits for the GPU

// What the last frame listed, and the column means of those that are streaks (for charts and tests).
struct NearListed {
  std::vector<NearDropGpu> drops;
  std::vector<glm::vec3> columns;  // NEAR_COLUMNS a drop, of which place.w are used
};
NearListed read_near_list();

}  // namespace petrichor
