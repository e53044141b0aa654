#include "systems/ripple/ripple.hpp"

#include "systems/ripple/coverage.hpp"
#include "systems/ripple_frame.hpp"

namespace petrichor {

Ladder ripples_ladder() {
  Ladder l;
  l.effect = Effect::ripples;
  l.name = "ripples";
  l.meaning = "rings on standing water";
  l.truth = "each wave of real water by itself, with its own speed (FFTW), from the same drops";
  l.error_measure =
      "root mean square of two parts: slopes against the truth's over a second of rain, and how much of what lies a "
      "tile's edge apart is the same again";
  // Figures of `petrichor chart ripples` for software OpenGL's 128 cells, where closed-form rings are both cheaper and
  // truer than the repeated lattices; on 256 cells those have 0.79 and 0.76 and cost six times as much in software.
  l.rungs = {
      {"none", "still water", {}, 0.0, 1.0, true},
      {"rings", "the strongest rings, stamped in closed form", {"ripples"}, 0.7, 0.87, true},
      {"euler", "a lattice by forward Euler as published: it blows up at any step", {"ripples"}, 1.1, 20.0, false},
      {"verlet5", "a lattice by Verlet's scheme, five points", {"ripples"}, 1.3, 0.92, true},
      {"verlet9", "the same with nine points, round rings", {"ripples"}, 1.3, 0.96, true},
      {"near_tile", "and a tile of the world near the eye with the field's own drops", {"ripples"}, 3.0, 0.73, true}};
  l.coverage = [](const Frame& frame) { return frame.ripples && frame.ripples->seen ? water_coverage(frame) : 0.0; };
  return l;
}

}  // namespace petrichor
