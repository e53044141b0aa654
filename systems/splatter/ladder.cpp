#include <algorithm>
#include <cmath>

#include "systems/splatter/mist.hpp"
#include "systems/splatter/splatter.hpp"
#include "systems/splatter_frame.hpp"

namespace petrichor {
namespace {

// How much of the picture the outlines or surfaces of marked things may take: by the boxes' sizes from the camera,
// those that are in front of it. Generous: nothing tells here what hides them.
double covered(const Frame& frame, float reach_m, float band_m) {
  if (!frame.splatter || !(frame.splatter->mist.column() > 0.0f)) return 0.0;
  const glm::vec3 forward = frame.camera.orientation * glm::vec3(0.0f, 0.0f, -1.0f);
  const double tangent = std::tan(0.5 * double(frame.camera.vertical_fov_rad));
  double sum = 0.0;
  for (const Catcher& c : frame.splatter->catchers) {
    const glm::vec3 to(glm::dvec3(frame.instances[c.instance].matrix[3]) - frame.camera.position_m);
    const float away = std::max(glm::length(to), 0.5f);
    if (away > reach_m || (glm::dot(to, forward) < -2.5f)) continue;
    // A thing two metres across; of it a band as wide as the effect.
    const double half = 1.0 / (away * tangent);
    sum += std::min(half, 1.0) * std::min(double(band_m) / (away * tangent), 1.0);
  }
  return std::min(sum, 1.0);
}

// Faint under light rain: a scale by rate, of the mist's column at 50 mm/h.
double strength(const Frame& frame) {
  return frame.splatter ? 1.0 - std::exp(-frame.splatter->mist.column() / 2e-4) : 0.0;
}

}  // namespace

Ladder splatter_ladder() {
  Ladder l;
  l.effect = Effect::splatter;
  l.name = "splatter";
  l.meaning = "rings of splatter on marked objects";
  l.truth = "the same impacts' crowns, not baked, integrated through four rays a pixel at 40 heights and 24 moments";
  l.error_measure = "root mean square difference of the rings' picture; no rings at all: 1";
  // Figures of `petrichor chart halos` (splatter.csv), six shells; software has them on near things alone.
  l.rungs = {{"none", "no splatter", {}, 0.0, 1.0},
             {"shells", "shells of spreading rings (Tatarchuk and Isidoro 2006)", {"splatter"}, 4.0, 0.47}};
  l.coverage = [](const Frame& frame) { return 0.5 * strength(frame) * covered(frame, 6.0f, 1.0f); };
  return l;
}

Ladder halos_ladder() {
  Ladder l;
  l.effect = Effect::halos;
  l.name = "halos";
  l.meaning = "mist of splashes along outlines";
  l.truth =
      "the flights, with drag, of the droplets of every class's splashes, seen through each pixel (Monte Carlo, CPU)";
  l.error_measure = "root mean square difference of the mist's picture; no mist at all: 1";
  l.rungs = {{"none", "no mist", {}, 0.0, 1.0},
             {"layer", "a thin layer of mist in closed form over each object's heights", {"halos"}, 3.0, 0.24},
             {"fins", "fins along silhouettes (Tatarchuk and Isidoro 2006)", {"halos"}, 2.5, 0.80}};
  l.coverage = [](const Frame& frame) {
    return frame.splatter ? 0.5 * strength(frame) * covered(frame, 30.0f, 4.0f * frame.splatter->mist.height_m) : 0.0;
  };
  return l;
}

}  // namespace petrichor
