#pragma once
// How a flake shows light. An aggregate of thin, rough ice crystals absorbs nothing and scatters mostly ahead: two
// Henyey-Greenstein lobes whose mean cosine is that of severely roughened aggregates without diffraction (0.5: Yang et
// al. 2013 have 0.75 with it, and diffraction is half of that, at an angle of 0), with a flat back.

#include <glm/glm.hpp>
#include <vector>

#include "systems/drops/optics.hpp"

namespace petrichor {

constexpr double flake_forward_cosine = 0.65, flake_backward_cosine = -0.1, flake_forward_share = 0.8;

// Radiance of the flake's image per irradiance on it, 1/sr, for light that turns by the angle of that cosine.
double flake_phase(double cosine);
// Binned as make_drop_phase (drop_optics.hpp), so that everything that lights drops can light flakes.
std::vector<float> make_flake_phase();
// Mean radiance of a flake that is seen along a unit direction under a sky (no ground: it is mirrored), cd/m2.
glm::dvec3 flake_radiance(const glm::dvec3& direction, const FrameSky&);

// As bind_rain_optics, where that of drops goes.
void bind_flake_optics(ParticleOptics&, const Frame&);

}  // namespace petrichor
