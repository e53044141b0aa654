#include "systems/mirror/mirror.hpp"

#include "systems/mirror_frame.hpp"

namespace petrichor {

std::vector<PassOffer> mirror_passes() {
  return {};
}

void extract_mirrors(const Registry&, Frame&) {}

Ladder probes_ladder() {
  Ladder l;
  l.effect = Effect::probes;
  l.name = "probes";
  l.meaning = "what moving objects mirror";
  l.truth = "TODO";
  l.error_measure = "TODO";
  l.rungs = {{"shared", "the surroundings of the camera", {}},
             {"moving", "a cube map about each moving object", {"probes"}}};
  l.coverage = [](const Frame&) { return 0.0; };
  return l;
}

}  // namespace petrichor
