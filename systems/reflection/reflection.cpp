#include "systems/reflection/reflection.hpp"

namespace petrichor {

std::vector<PassOffer> reflection_passes() {
  return {};
}

Result<void> chart_reflections(const ChartRun&) {
  return {};
}

Ladder reflections_ladder() {
  Ladder l;
  l.effect = Effect::reflections;
  l.name = "reflections";
  l.meaning = "what wet ground and glossy surfaces mirror";
  l.truth = "TODO";
  l.error_measure = "TODO";
  l.rungs = {{"environment", "the captured surroundings alone", {}},
             {"toyshop", "impostors stretched and streaked (as printed)", {"reflections", "reflections_over"}},
             {"impostors", "impostors with shifted peak, clip and tail", {"reflections", "reflections_over"}},
             {"screen_space", "rays through the picture", {"reflections", "reflections_over"}},
             {"planar", "screen_space, with planar mirrors", {"mirrors", "reflections", "reflections_over"}}};
  l.coverage = [](const Frame&) { return 0.0; };
  return l;
}

}  // namespace petrichor
