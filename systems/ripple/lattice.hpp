#pragma once
// The lattices of waves on the GPU, and how they are brought to a frame's time.

#include <array>
#include <cstdint>
#include <vector>

#include "engine/gpu/objects.hpp"
#include "engine/gpu/shader.hpp"
#include "systems/ripple/ripple_shared.h"
#include "systems/ripple/seeds.hpp"
#include "systems/ripple_frame.hpp"

namespace petrichor {

// How a lattice steps.
struct RippleScheme {
  float nine_share = 1.0f;  // of the nine-point Laplacian, the rest five-point
  bool euler = false;       // forward, as a warning
  bool quantised = false;   // 16 bits, as published
  int steps = 0;            // a tick; 0: as many as the Courant number demands
  friend bool operator==(const RippleScheme&, const RippleScheme&) = default;
};

// Least deviation of a seed in cells: what the setting says of 256 cells and more. A coarser lattice is not given wider
// rings, whose waves would all be too slow, but fewer cells to a ring: at 128, of 3 cells they are worse than still water,
// of 1.5 better (chart ripples: 1.03, 0.92).
float seed_cells(const RippleSettings&, int cells);

// The programs of pass `ripples`.
struct RipplePrograms {
  const Program *stamp, *step, *step_near;
};

// One lattice from rest on. Bytes are given out when it first steps.
struct RippleLattice {
  int cells = 0;      // per side, a power of two
  bool near = false;  // not repeated, with the age of its cells; else it goes round
  Buffer state, next, stamps;
  double last_step_s = 0.0;  // that w is the increment of
  void rest(int cells, bool near);
  // Adds the seeds to the stamps, steps and shifts.
  void step(const RipplePrograms&, const RippleScheme&, double speed_mps, double cell_m, double decay_per_s,
            double step_s, glm::ivec2 shift, const Buffer& seeds, int first_seed, int seed_count);
};

// A run: the lattice as of a tick of a history, and since when.
struct RippleRun {
  RippleLattice lattice;
  std::uint64_t history = 0;
  std::int64_t start = 0, since = 0, tick = -1;
  bool begun = false;
  bool euler = false;
};

class RippleWaves {
 public:
  // Brings the shared tile (near false) or the near tile to the frame's newest tick; the run of the coming epoch too
  // where that has begun. Null where there is nothing (the near tile has no place).
  const RippleRun* bring(const RipplePrograms&, const FrameRipples&, const RippleScheme&, int cells, bool near);
  std::size_t bytes() const;
  std::int64_t steps() const { return steps_; }  // made so far, for tests and benches

 private:
  void advance(const RipplePrograms&, const FrameRipples&, const RippleScheme&, int cells, RippleRun&, bool near,
               std::int64_t start, std::int64_t since, std::int64_t until);
  std::array<RippleRun, 2> shared_, near_;
  FieldDrops drops_;
  Buffer seeds_;
  std::int64_t steps_ = 0;
};

}  // namespace petrichor
