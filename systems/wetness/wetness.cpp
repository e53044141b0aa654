#include "systems/wetness/wetness.hpp"

#include "systems/wetness_frame.hpp"

namespace petrichor {

std::vector<PassOffer> wetness_passes() {
  return {};
}

void simulate_wetness(Registry&, double time_s, double step_s) {}
void extract_wetness(const Registry&, Frame&, double time_s) {}
Result<void> chart_wetness(const ChartRun&) {
  return {};
}

Ladder wetness_ladder() {
  Ladder l;
  l.effect = Effect::wetness;
  l.name = "wetness";
  l.meaning = "films of water on surfaces";
  l.truth = "TODO";
  l.error_measure = "TODO";
  l.rungs = {{"none", "dry", {}},
             {"everywhere", "one film on everything", {"wet_surfaces"}},
             {"sheltered", "films by how much rain arrives", {"wet_surfaces"}},
             {"flowing", "sheltered, with films that run down slopes", {"wet_surfaces"}}};
  l.coverage = [](const Frame&) { return 0.0; };
  return l;
}

}  // namespace petrichor
