#pragma once
// Which rings begin in a tick: of the shared tile by chance, of the near tile where the field's own drops land.

#include <cstdint>
#include <span>
#include <vector>

#include "systems/ripple/ripple_shared.h"
#include "systems/ripple_frame.hpp"

namespace petrichor {

// A drop that met the water.
struct RippleImpact {
  glm::dvec2 place_m;  // x and z: world, or in the shared tile
  float diameter_mm, speed_mps;
  std::int64_t tick;  // during which
};

// Published: stochastic in space and time. As many of each class as of this rain fall on the tile's area, in the mean,
// each tick for itself: a function of (seed, tick).
std::vector<RippleImpact> shared_impacts(const RippleTick&, std::int64_t tick, double step_s, float tile_m);

// The drops of the field (systems/drops/field.glsl) that meet the water of the near tile. It finds those that are still
// above it for some ticks ahead, so that most frames look through a short list alone.
class FieldDrops {
 public:
  // Those that cross the level of the water between the ticks before `first` and `last`, both of the frame's history,
  // within reach of the near tile as it lies at each of them; `cells` per side. By tick, class, cell and drop. The
  // answer for a tick does not depend on what else was asked. Below `since` the tile lies where it does at `since`.
  std::vector<RippleImpact> impacts(const FrameRipples&, std::int64_t first, std::int64_t last, std::int64_t since,
                                    int cells);

 private:
  struct Ahead {  // of a class: drops of a box in its own frame
    glm::dvec3 low{0.0}, high{0.0};
    std::vector<glm::dvec3> drops;
  };
  std::shared_ptr<const RippleRain> rain_;
  std::vector<Ahead> ahead_;
};
std::vector<RippleImpact> field_impacts(const FrameRipples&, std::int64_t first, std::int64_t last, std::int64_t since,
                                        int cells);

// The seed of an impact on a lattice of such cells; place in cells.
RippleSeedGpu seed_of(const RippleImpact&, glm::dvec2 place_cells, double cell_m, const RippleSettings&);
RippleSeedGpu seed_of(const RippleWake&, glm::dvec2 place_cells, double cell_m, bool published);

// The rings that are strongest now of those of the shared tile, at most so many: place, age, amplitude.
std::vector<RippleRing> strongest_rings(const FrameRipples&, int most, double life_s);

}  // namespace petrichor
