#pragma once
// Wet surfaces: films of water on everything that rain reaches (shared physics, section 9).

#include <memory>
#include <vector>

#include "engine/ecs/registry.hpp"
#include "engine/graph/graph.hpp"
#include "systems/frame.hpp"
#include "systems/ladder.hpp"

namespace petrichor {

struct WetGround;
struct WetnessHistory;

// Pass wet_surfaces: films of water over the G-buffer, in place. Runs where something is wet and the rung asks for it.
// Slots: depth; albedo, normal (modified); optional: water_mask (kinds of material), occlusion_map,
// ripples, puddle_list; water (written where somebody reads it: mm of standing water, mm of film).
std::vector<PassOffer> wetness_passes();

// Every tick: WetnessHistory (history.hpp) on the emitter's entity follows rain and wind.
void simulate_wetness(Registry&, double time_s, double step_s);
// Fills frame.wetness, or leaves it empty: no emitter, never any rain, dried up, or the rung is none.
void extract_wetness(const Registry&, Frame&, double time_s);
std::shared_ptr<const FrameWetness> make_frame_wetness(const WetnessHistory&, const WetGround&, double time_s);

Ladder wetness_ladder();

}  // namespace petrichor
