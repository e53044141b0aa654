#include "systems/drip/drip.hpp"

#include "systems/drip_frame.hpp"

namespace petrichor {

std::vector<PassOffer> drip_passes(const DropPainting&) {
  return {};
}

void simulate_drips(Registry&, const std::vector<std::shared_ptr<const Model>>&, double time_s, double step_s) {}
void extract_drips(const Registry&, Frame&, double time_s) {}
Result<void> chart_drips(const ChartRun&) {
  return {};
}

Ladder drips_ladder() {
  Ladder l;
  l.effect = Effect::drips;
  l.name = "drips";
  l.meaning = "drops that fall from edges";
  l.truth = "TODO";
  l.error_measure = "TODO";
  l.rungs = {{"none", "no drips", {}},
             {"billboards", "billboards with a normal map (as printed)", {"drips"}},
             {"streaks", "streaks as long as the exposure", {"drips"}},
             {"refracting", "streaks, and near ones show the world refracted", {"drips"}}};
  l.coverage = [](const Frame&) { return 0.0; };
  return l;
}

}  // namespace petrichor
