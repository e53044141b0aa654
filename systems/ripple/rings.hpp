#pragma once
// Rings in closed form, stamped into a layer of `ripples`: each from the exact solution for its age, nothing kept from
// frame to frame.

#include <vector>

#include "engine/gpu/objects.hpp"
#include "engine/gpu/shader.hpp"
#include "systems/ripple_frame.hpp"

namespace petrichor {

constexpr double ring_life_s = 1.5;  // then what is left of it has faded
constexpr double ring_radius_step_m = 0.002, ring_time_step_s = 0.008;

struct RingLayer {
  double cell_m;
  double edge_m;  // of a tile that repeats; 0: it does not
  double decay_per_s;
};

class RippleRings {
 public:
  // Places in metres from the layer's corner.
  void draw(const Program&, const Texture&, int level, int layer, const std::vector<RippleRing>&, const RingLayer&,
            float share);

 private:
  Buffer table_, rings_, lists_;
  double decay_ = -1.0;
};

}  // namespace petrichor
