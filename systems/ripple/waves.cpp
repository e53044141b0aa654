#include "systems/ripple/waves.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "systems/drops/drop_physics.hpp"

namespace petrichor {
namespace {

// Integrals of the seed over the plane, for R = 1: of z^2, and of its squared slope (which R does not change).
struct SeedIntegrals {
  double square = 0.0, slope = 0.0;
  SeedIntegrals() {
    constexpr int steps = 4096;
    for (int i = 0; i < steps; ++i) {
      const double r = (i + 0.5) / steps, h = 1e-5, ring = 2.0 * std::numbers::pi * r / steps;
      const double z = seed_shape(r * r);
      const double dz = (seed_shape((r + h) * (r + h)) - seed_shape((r - h) * (r - h))) / (2.0 * h);
      square += z * z * ring;
      slope += dz * dz * ring;
    }
  }
};

const SeedIntegrals& integrals() {
  static const SeedIntegrals all;
  return all;
}

}  // namespace

double wave_frequency(double k, double depth_m) {
  return std::sqrt((gravity_mps2 * k + surface_tension_npm / water_density_kgpm3 * k * k * k) * std::tanh(k * depth_m));
}

double seed_shape(double q) {
  return q < 1.0 ? std::pow(1.0 - q, 4) * (1.0 - 6.0 * q) : 0.0;
}

double seed_amplitude_m(double diameter_mm, double speed_mps, double deviation_m) {
  const double mass_kg = water_density_kgpm3 * std::numbers::pi / 6.0 * std::pow(diameter_mm * 1e-3, 3);
  const double energy = ring_energy_share * 0.5 * mass_kg * speed_mps * speed_mps;
  const double reach_m = seed_reach * deviation_m;
  const double of_one_metre = 0.5 * water_density_kgpm3 * gravity_mps2 * integrals().square * reach_m * reach_m +
                              0.5 * surface_tension_npm * integrals().slope;
  return std::sqrt(energy / of_one_metre);
}

double seed_squared_slope() {
  return integrals().slope;
}

int substeps(double speed_mps, double span_s, double cell_m, double most) {
  const double courant = speed_mps * span_s / cell_m;
  return std::clamp(static_cast<int>(std::ceil(courant / most - 1e-9)), 1, 1 << 20);
}

}  // namespace petrichor
