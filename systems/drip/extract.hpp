#pragma once
// From the ledger to the drops of a frame.

#include <vector>

#include "systems/drip/motion.hpp"
#include "systems/drip_frame.hpp"
#include "systems/frame.hpp"

namespace petrichor {

constexpr double drip_reach_m = 40.0, drip_landing_reach_m = 25.0;
constexpr std::size_t most_drips = 16384;  // in a frame; of more the nearest

// What a camera sees of all edges, and what has landed near it. Null where there is nothing.
std::shared_ptr<const FrameDrips> make_frame_drips(const DripMotion&, const FrameCamera&, int width, int height,
                                                   double time_s, std::size_t most = most_drips);

}  // namespace petrichor
