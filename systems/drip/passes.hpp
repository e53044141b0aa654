#pragma once
// Drawing drips, for charts and benchmarks beside the passes themselves.

#include <cstdint>

#include "systems/frame.hpp"

namespace petrichor {

// Of these drops, how each is drawn in this frame: by its own random bits, so that none changes over while the shares
// of the rungs stand still.
enum class DripDrawing : std::uint8_t { none, streak, billboard, refracting };
struct FrameDrip;
DripDrawing drawing_of(const Frame&, const FrameDrip&);

bool draws_drip_streaks(const Frame&);
bool draws_drip_pictures(const Frame&);

}  // namespace petrichor
