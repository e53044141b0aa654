#include "systems/ripple/ripple.hpp"

#include "systems/ripple_frame.hpp"

namespace petrichor {

std::vector<PassOffer> ripple_passes() {
  return {};
}

void simulate_ripples(Registry&, double time_s, double step_s) {}
void extract_ripples(const Registry&, Frame&, double time_s) {}
Result<void> chart_ripples(const ChartRun&) {
  return {};
}

Ladder ripples_ladder() {
  Ladder l;
  l.effect = Effect::ripples;
  l.name = "ripples";
  l.meaning = "rings on standing water";
  l.truth = "TODO";
  l.error_measure = "TODO";
  l.rungs = {{"none", "still water", {}},
             {"rings", "rings stamped in closed form", {"ripples"}},
             {"euler", "forward Euler, a warning", {"ripples"}},
             {"verlet5", "Verlet, five points", {"ripples"}},
             {"verlet9", "Verlet, nine points", {"ripples"}},
             {"near_tile", "verlet9, with a tile of the world near the eye", {"ripples"}}};
  l.coverage = [](const Frame&) { return 0.0; };
  return l;
}

}  // namespace petrichor
