#pragma once
// Ripples solved exactly: each wave of real water by itself, with its own speed (shared physics, 5b).

#include <complex>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "systems/ripple/waves.hpp"

namespace petrichor {

// Angular frequency by wave number. Of real water, or of a membrane on which all waves run alike.
using Dispersion = std::function<double(double k)>;
Dispersion real_water(double depth_m = puddle_depth_m);
Dispersion membrane(double speed_mps);

// The Hankel transform of the seed of amplitude 1 and reach R: 2 pi INT z(r) J0(k r) r dr, m^2, by its k R.
double seed_transform(double k, double reach_m);
// Of a Gaussian exp(-r^2 / 2 s^2).
double gaussian_transform(double k, double deviation_m);

// Slopes dz/dr of a ring of amplitude 1 m and natural seed, a row for each time: radii `radius_step_m` apart from 0,
// times `time_step_s` apart from 0; decay included. Exact but for the integral over k (400 points to k s = 7).
struct RingTable {
  int radii, times;
  double radius_step_m, time_step_s;
  std::vector<float> slope;
};
RingTable make_ring_table(int radii, int times, double radius_step_m, double time_step_s, double decay_per_s);

// z(r, t) = 1/(2 pi) INT F(k) J0(k r) cos(w t) k dk of a seed with transform F.
double ring_height(const std::function<double(double)>& transform, const Dispersion&, double radius_m, double time_s,
                   double largest_k);

// A periodic square of water in waves, each advanced exactly by any step: no Courant number, no error in time. FFTW,
// double precision.
class SpectralWater {
 public:
  SpectralWater(int cells, double edge_m, const Dispersion&, double decay_per_s);
  ~SpectralWater();
  SpectralWater(const SpectralWater&) = delete;
  SpectralWater& operator=(const SpectralWater&) = delete;
  void advance(double step_s);
  // Of a transform as of seed_transform, for add().
  std::vector<double> shape(const std::function<double(double)>& transform) const;
  // Seeds at rest: places in metres and amplitudes.
  void add(const std::vector<glm::dvec3>& place_amplitude, const std::vector<double>& shape);
  void add(glm::dvec2 place_m, double amplitude_m, const std::function<double(double)>& transform);
  // Heights, row by row (z outer), and slopes dz/dx, dz/dz.
  std::vector<double> heights() const;
  std::vector<glm::dvec2> slopes() const;
  int cells() const { return cells_; }
  double edge_m() const { return edge_m_; }

 private:
  struct Plans;
  int cells_;
  double edge_m_, decay_;
  std::vector<double> frequency_, number_;
  std::vector<std::complex<double>> height_, speed_;  // of modes, half of the plane
  std::unique_ptr<Plans> plans_;
};

}  // namespace petrichor
