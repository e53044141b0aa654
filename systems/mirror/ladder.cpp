#include <algorithm>

#include "systems/mirror/mirror.hpp"
#include "systems/mirror_frame.hpp"

namespace petrichor {

Ladder probes_ladder() {
  Ladder l;
  l.effect = Effect::probes;
  l.name = "probes";
  l.meaning = "what moving objects mirror";
  l.truth = "a ray from every point of a car-sized body, in the same street";
  l.error_measure =
      "relative mean square error of the mirrored radiance, over four bodies 3 to 28 m from the eye; "
      "the shared surroundings: 1";
  l.rungs = {{"shared", "the surroundings of the camera", {}, 0.0, 1.0},
             {"moving", "a cube map about each moving object", {"probes"}, 2.6, 0.19}};
  l.coverage = [](const Frame& frame) {
    double sum = 0.0;
    if (frame.mirrors)
      for (const FrameMirrors::Probe& p : frame.mirrors->probes) sum += static_cast<double>(p.coverage);
    return std::min(sum, 1.0);
  };
  return l;
}

}  // namespace petrichor
