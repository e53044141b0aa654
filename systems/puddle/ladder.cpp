#include <algorithm>
#include <cmath>

#include "systems/puddle/puddle.hpp"
#include "systems/puddle_frame.hpp"

namespace petrichor {

Ladder puddles_ladder() {
  Ladder l;
  l.effect = Effect::puddles;
  l.name = "puddles";
  l.meaning = "standing water";
  l.truth = "the street's height field, filled cell by cell, in double precision, over an hour of showers";
  l.error_measure = "root mean square error of the water's depth over area and time (no water: 1)";
  // Milliseconds at 640x360, llvmpipe: what pass wet_surfaces takes longer, by the ratio to `antialias`.
  l.rungs = {{"none", "no standing water", {}, 0.0, 1.0},
             {"masks", "always as deep as the masks say (as printed)", {"puddles", "wet_surfaces"}, 5.0, 0.69},
             {"filled", "by a balance of rain, drain and evaporation", {"puddles", "wet_surfaces"}, 5.0, 0.13}};
  // A guess: as much of the ground in view as their rectangles cover, each by the solid angle that it may take.
  l.coverage = [](const Frame& frame) {
    if (!frame.puddles || !frame.puddles->any_water) return 0.0;
    double sum = 0.0;
    for (const FramePuddles::Puddle& p : frame.puddles->puddles) {
      if (p.level_m <= 0.0f) continue;
      const glm::dvec3 away = glm::dvec3(glm::vec3(p.world_from_puddle[3])) - frame.camera.position_m;
      const double height = std::abs(away.y), square = std::max(glm::dot(away, away), height * height + 0.01);
      sum += 4.0 * double(p.half_size_m.x) * double(p.half_size_m.y) * height / (square * std::sqrt(square));
    }
    return std::min(1.0, 0.5 * sum);
  };
  return l;
}

}  // namespace petrichor
