#include "systems/splatter/splatter.hpp"

#include "systems/splatter_frame.hpp"

namespace petrichor {

std::vector<PassOffer> splatter_passes(const DropPainting&) {
  return {};
}

void extract_splatter(const Registry&, Frame&) {}
Result<void> chart_halos(const ChartRun&) {
  return {};
}

Ladder splatter_ladder() {
  Ladder l;
  l.effect = Effect::splatter;
  l.name = "splatter";
  l.meaning = "rings of splatter on marked objects";
  l.truth = "TODO";
  l.error_measure = "TODO";
  l.rungs = {{"none", "no splatter", {}}, {"shells", "shells of spreading rings (as printed)", {"splatter"}}};
  l.coverage = [](const Frame&) { return 0.0; };
  return l;
}

Ladder halos_ladder() {
  Ladder l;
  l.effect = Effect::halos;
  l.name = "halos";
  l.meaning = "mist of splashes along outlines";
  l.truth = "TODO";
  l.error_measure = "TODO";
  l.rungs = {{"none", "no mist", {}},
             {"layer", "a thin layer of mist in closed form", {"halos"}},
             {"fins", "fins along silhouettes (as printed)", {"halos"}}};
  l.coverage = [](const Frame&) { return 0.0; };
  return l;
}

}  // namespace petrichor
