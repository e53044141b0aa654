#pragma once
// The director chooses for each effect the rung of its ladder, so that what is visibly wrong is least and the frame
// stays within its budget (design, section 6). It only decides: it draws nothing, reads no clock and keeps all it knows
// in a plain struct, so the same inputs give the same choices.
//
// Once a frame: direct(director, input) with what the last frame cost, then draw by its techniques.

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "systems/director/costs.hpp"
#include "systems/director_note.hpp"
#include "systems/ladder.hpp"
#include "systems/techniques.hpp"

namespace petrichor {

struct DirectorInput {
  double budget_ms = 0.0;                       // 0: the director rests, and what is asked for is drawn
  double step_s = 0.0;                          // since the frame before, as the viewer sees time
  double frame_ms = 0.0;                        // the whole work of the last frame; 0 or not finite: not known
  bool profiled = false;                        // that frame was slowed by timing its passes
  std::span<const PassTime> passes;             // where the times of passes are known: of a recent frame
  bool gpu_times = false;                       // they are a GPU's own; else wall time, and sum to the frame
  std::array<double, effect_count> coverage{};  // of the frame to be drawn: Ladder::coverage
  Techniques asked;                             // of effects that are pinned, and of those that are not directed
  std::array<bool, effect_count> pinned{};      // by the user
};

struct DirectorOutput {
  Techniques techniques;      // of the next frame
  bool profile_next = false;  // time the passes of the next frame
};

// One change of a rung, as it was decided.
struct DirectorSwitch {
  std::int64_t frame = 0;
  double time_s = 0.0;
  Effect effect{};
  int from = 0, to = 0;
  double level_ms = 0.0, expected_ms = 0.0;  // of a whole frame: measured before, thought of after
  const char* reason = "";                   // "over budget", "room to spare", "appeared"
};

struct DirectedEffect {
  Choice choice;
  bool free = false;  // directed, not pinned
  double since_switch_s = 1e9;
  double fade_s = 0.0;         // of the cross-fade that runs or ran last
  double since_climb_s = 1e9;  // since it last went to a truer rung
  int switches = 0;
  // A climb that failed is not tried again for a while, twice as long each time: of each rung, how long it is barred
  // still, how long it was barred last, and how heavy the rest of the frame was when it failed.
  std::vector<double> barred_s, bar_s, failed_rest_ms;
};

struct Director {
  DirectorCosts costs;
  std::array<DirectedEffect, effect_count> effects;
  std::array<double, effect_count> coverage{};
  double budget_ms = 0.0;
  double time_s = 0.0;
  std::int64_t frame = 0;
  int settling = 2;                // frames that still show the last change (textures made anew, caches cold)
  std::vector<double> recent_ms;   // frames since the last change, newest last
  double regime_s = 0.0;           // since the last change
  std::vector<double> unevenness;  // frames over the median of those before, newest last
  double level_ms = 0.0;           // the median frame as last known; 0: nothing is known
  double wish_s = 0.0;             // how long the same climb has been wanted
  int wish_frames = 0;
  std::array<int, effect_count> wish{};
  // After a climb that failed nothing is tried for a while, longer each time, unless frames are much shorter than was
  // expected then: the load that made it fail has gone.
  double rest_s = 0.0, rested_s = 0.0, since_failure_s = 1e9, rest_from_ms = 0.0;
  std::int64_t profiled_at = -1000;
  bool new_rungs = true;  // no profile since the last change
  bool learning = false;  // the last change is not yet checked against the frames
  double learn_from_ms = 0.0, learn_expected_ms = 0.0;
  std::array<int, effect_count> learn_from{}, learn_to{};
  std::vector<DirectorSwitch> history;
};

constexpr double director_fade_s = 0.5;
constexpr double director_hold_s = 2.0;  // at most one switch per effect in that time

// ladders: one for each Effect, in its order; `start`: what is drawn before the first decision.
Director make_director(std::vector<Ladder> ladders, const Techniques& start);
DirectorOutput direct(Director&, const DirectorInput&);
// One note for each directed effect, as of the last direct().
std::vector<DirectorNote> explain(const Director&);

// p95 over median of the frames, as far as known.
double director_spread(const Director&);

}  // namespace petrichor
