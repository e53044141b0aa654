#pragma once
// Along which directions the precipitation of a frame falls: drops of different sizes fall at different tilts in one
// wind, and the wind itself spreads them.

#include <glm/glm.hpp>
#include <vector>

#include "systems/frame.hpp"

namespace petrichor {

// Some of the precipitation, by the way it falls.
struct FallShare {
  glm::vec3 velocity_mps{0.0f, -1.0f, 0.0f};  // downwards
  float share = 1.0f;                         // of the water that comes down, 0 to 1
};

// What falls at all: rain, snow or both, weighted by their water. Straight down where nothing falls. In frame.wind's
// mean, where it is known: a map that followed every gust was redrawn six times a second (75 ms each in the town,
// software OpenGL) and judged no more drops rightly.
glm::vec3 mean_fall(const Frame&);
bool precipitates(const Frame&);

// At most `count` falls that stand for all: groups by tilt along the wind, equal in the mean of the water and the
// number of drops they bring (water alone would leave the small drops, which carry little but are many, to a tilt far
// too steep), each at its median tilt, the tilts across the wind dealt out over the groups evenly (a Latin hypercube).
// Of classes and frame.wind with its gusts over time, not of the gust of the moment: gusts redraw no map. Without
// frame.wind: of the classes as they fall now. Shares sum to 1; sorted by tilt.
std::vector<FallShare> chosen_falls(const Frame&, int count);

}  // namespace petrichor
