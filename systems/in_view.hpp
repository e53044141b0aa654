#pragma once
// Whether a frame shows any surface at all: passes that change surfaces, or draw on them, have nothing to do otherwise.

#include "systems/frame.hpp"

namespace petrichor {

// Of the frame's instances, whether the box about any opaque part, widened by what stands up from it (crowns of
// splashes), may touch the camera's frustum within reach_m, metres from the eye. After FrameGpu::upload and before
// passes run, as PassOffer::wanted is asked. Without frame.scene: whether there are instances.
bool any_surface_in_view(const Frame&, float reach_m = 1e30f);

}  // namespace petrichor
