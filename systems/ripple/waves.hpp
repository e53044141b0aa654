#pragma once
// The physics of ripples (shared physics, section 5): real water's dispersion, how large a ring a drop makes, and what
// a lattice may step.

namespace petrichor {

constexpr double water_density_kgpm3 = 998.0, surface_tension_npm = 0.0728;
constexpr double puddle_depth_m = 0.008;  // of the water that rings run over

// Angular frequency of a wave of wave number k, 1/m, on water of this depth: gravity, tension and a bottom,
// w^2 = (g k + sigma/rho k^3) tanh(k h). rad/s.
double wave_frequency(double k, double depth_m = puddle_depth_m);

// The seed of a ring: z(r) = A (1 - q)^4 (1 - 6 q), q = (r/R)^2 up to 1, 0 beyond: a crater with its rim, of no volume
// (integral 0, so that the mean level stays), smooth at its edge. It is close to the Laplacian of a Gaussian of
// deviation s = R / sqrt(8).
constexpr double seed_reach = 2.8284271247461903;  // R / s
double seed_shape(double q);
// The deviation at which a seed's waves peak at k = 0.2/mm, as measured for drops of 2.2 and 2.8 mm: sqrt(3) / s = k.
constexpr double natural_seed_m = 0.0085;

// Amplitude of the seed of a drop, m: so that its energy, of gravity and tension, is the hundredth of the drop's
// kinetic energy that goes into ring waves. Seeds wider than natural are as much lower.
double seed_amplitude_m(double diameter_mm, double speed_mps, double deviation_m);
constexpr double ring_energy_share = 0.01;

// Integral of the squared slope over a seed of amplitude 1 m, in m^2 of area; half of it is left once it runs.
double seed_squared_slope();

// Greatest Courant number c dt / dx at which Verlet's scheme is stable on the five-point Laplacian, 1/sqrt(2), and on
// the nine-point one, sqrt(3)/2, each less a hundredth.
constexpr double courant_5 = 0.70, courant_9 = 0.857;
// Steps that a span of time is cut into so that none exceeds `most`: never a change of the waves' speed. >= 1.
int substeps(double speed_mps, double span_s, double cell_m, double most);

}  // namespace petrichor
