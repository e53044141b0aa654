#pragma once
// What a frame asks of pass `ripples`, apart from OpenGL.

#include "systems/frame.hpp"
#include "systems/ripple/lattice.hpp"

namespace petrichor {

struct RippleShares {
  float rings = 0.0f, lattice = 0.0f, near = 0.0f;  // of slopes; lattice: of all rungs that have one
  RippleScheme scheme;
};
RippleShares ripple_shares(const Techniques&, bool published);

// Wave number at which the slopes' variance of rings of this seed lies, 1/m.
double peak_wave_number(double deviation_m);

}  // namespace petrichor
