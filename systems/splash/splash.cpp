#include "systems/splash/splash.hpp"

#include "systems/splash_frame.hpp"

namespace petrichor {

std::vector<PassOffer> splash_passes(const DropPainting&) {
  return {};
}

void extract_splashes(const Registry&, Frame&, double time_s) {}
Result<void> chart_splashes(const ChartRun&) {
  return {};
}

Ladder splashes_ladder() {
  Ladder l;
  l.effect = Effect::splashes;
  l.name = "splashes";
  l.meaning = "splashes where drops land";
  l.truth = "TODO";
  l.error_measure = "TODO";
  l.rungs = {{"none", "no splashes", {}},
             {"random", "sprites at random places (as printed)", {"splash_list", "splash_draw"}},
             {"field", "a splash where each drop of the field lands", {"splash_list", "splash_draw"}},
             {"secondary", "field, with secondary droplets near the eye", {"splash_list", "splash_draw"}}};
  l.coverage = [](const Frame&) { return 0.0; };
  return l;
}

}  // namespace petrichor
