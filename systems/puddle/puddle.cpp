#include "systems/puddle/puddle.hpp"

#include "systems/puddle_frame.hpp"

namespace petrichor {

std::vector<PassOffer> puddle_passes() {
  return {};
}

void simulate_puddles(Registry&, double time_s, double step_s) {}
void extract_puddles(const Registry&, Frame&) {}
Result<void> chart_puddles(const ChartRun&) {
  return {};
}

Ladder puddles_ladder() {
  Ladder l;
  l.effect = Effect::puddles;
  l.name = "puddles";
  l.meaning = "standing water";
  l.truth = "TODO";
  l.error_measure = "TODO";
  l.rungs = {{"none", "no standing water", {}},
             {"masks", "as deep as the masks say (as printed)", {"puddles"}},
             {"filled", "by a balance of rain, drain and evaporation", {"puddles"}}};
  l.coverage = [](const Frame&) { return 0.0; };
  return l;
}

}  // namespace petrichor
