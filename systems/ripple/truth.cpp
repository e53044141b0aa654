#include "systems/ripple/truth.hpp"

#include <fftw3.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace petrichor {
namespace {

constexpr double pi = std::numbers::pi;
using Complex = std::complex<double>;

}  // namespace

Dispersion real_water(double depth_m) {
  return [depth_m](double k) { return wave_frequency(k, depth_m); };
}

Dispersion membrane(double speed_mps) {
  return [speed_mps](double k) { return speed_mps * k; };
}

double seed_transform(double k, double reach_m) {
  // (1-q)^n has 2^n n! 2 pi R^2 / 2 J_{n+1}(x) / x^{n+1}, and (1-q)^4 (1-6q) = 6 (1-q)^5 - 5 (1-q)^4.
  const double x = k * reach_m;
  if (x < 0.3) {  // the series' first terms, where the two cancel: x^2/4 (1/7 ...) of pi R^2
    const double y = 0.25 * x * x;
    const auto one = [&](int n) {  // pi R^2 / (n+1) 0F1(n+2, -y)
      double term = 1.0 / (n + 1), sum = 0.0;
      for (int m = 0; m < 8; ++m) {
        if (m > 0) sum += term;  // their constants 1/(n+1) cancel exactly in the sum
        term *= -y / ((m + 1.0) * (n + 2.0 + m));
      }
      return sum;
    };
    return pi * reach_m * reach_m * (6.0 * one(5) - 5.0 * one(4));
  }
  const auto one = [&](int n) {
    return 2.0 * pi * reach_m * reach_m * std::pow(2.0, n) * std::tgamma(n + 1.0) * jn(n + 1, x) / std::pow(x, n + 1);
  };
  return 6.0 * one(5) - 5.0 * one(4);
}

double gaussian_transform(double k, double deviation_m) {
  return 2.0 * pi * deviation_m * deviation_m * std::exp(-0.5 * k * k * deviation_m * deviation_m);
}

RingTable make_ring_table(int radii, int times, double radius_step_m, double time_step_s, double decay_per_s) {
  constexpr int waves = 400;
  const double most = 7.0 / natural_seed_m, dk = most / waves;
  RingTable table{radii, times, radius_step_m, time_step_s, {}};
  table.slope.resize(static_cast<std::size_t>(radii) * times);
  // d/dr J0(kr) = -k J1(kr).
  std::vector<double> radial(static_cast<std::size_t>(radii) * waves), frequency(waves);
  for (int j = 0; j < waves; ++j) {
    const double k = (j + 0.5) * dk;
    frequency[j] = wave_frequency(k);
    const double weight = -k * k * seed_transform(k, seed_reach * natural_seed_m) * dk / (2.0 * pi);
    for (int i = 0; i < radii; ++i)
      radial[static_cast<std::size_t>(i) * waves + j] = weight * j1(k * i * radius_step_m);
  }
  std::vector<double> phase(waves);
  for (int t = 0; t < times; ++t) {
    const double time = t * time_step_s, left = std::exp(-decay_per_s * time);
    for (int j = 0; j < waves; ++j) phase[j] = std::cos(frequency[j] * time) * left;
    for (int i = 0; i < radii; ++i) {
      double sum = 0.0;
      const double* row = &radial[static_cast<std::size_t>(i) * waves];
      for (int j = 0; j < waves; ++j) sum += row[j] * phase[j];
      table.slope[static_cast<std::size_t>(t) * radii + i] = static_cast<float>(sum);
    }
  }
  return table;
}

double ring_height(const std::function<double(double)>& transform, const Dispersion& dispersion, double radius_m,
                   double time_s, double largest_k) {
  constexpr int waves = 4000;
  const double dk = largest_k / waves;
  double sum = 0.0;
  for (int j = 0; j < waves; ++j) {
    const double k = (j + 0.5) * dk;
    sum += transform(k) * j0(k * radius_m) * std::cos(dispersion(k) * time_s) * k * dk;
  }
  return sum / (2.0 * pi);
}

struct SpectralWater::Plans {
  fftw_complex* modes = nullptr;
  double* cells = nullptr;
  fftw_plan back = nullptr;
  ~Plans() {
    if (back) fftw_destroy_plan(back);
    fftw_free(modes);
    fftw_free(cells);
  }
};

SpectralWater::SpectralWater(int cells, double edge_m, const Dispersion& dispersion, double decay_per_s)
    : cells_(cells), edge_m_(edge_m), decay_(decay_per_s), plans_(std::make_unique<Plans>()) {
  const std::size_t half = static_cast<std::size_t>(cells / 2 + 1), all = half * static_cast<std::size_t>(cells);
  height_.resize(all);
  speed_.resize(all);
  for (int j = 0; j < cells; ++j)
    for (std::size_t i = 0; i < half; ++i) {
      const double kx = 2.0 * pi / edge_m * static_cast<double>(i);
      const double ky = 2.0 * pi / edge_m * (j <= cells / 2 ? j : j - cells);
      number_.push_back(std::hypot(kx, ky));
      frequency_.push_back(dispersion(number_.back()));
    }
  plans_->modes = fftw_alloc_complex(all);
  plans_->cells = fftw_alloc_real(static_cast<std::size_t>(cells) * cells);
  plans_->back = fftw_plan_dft_c2r_2d(cells, cells, plans_->modes, plans_->cells, FFTW_ESTIMATE);
}

SpectralWater::~SpectralWater() = default;

void SpectralWater::advance(double step_s) {
  // z'' + 2 b z' + w^2 z = 0, exactly.
  for (std::size_t i = 0; i < height_.size(); ++i) {
    const double w = frequency_[i], b = decay_, left = std::exp(-b * step_s);
    const double d = w * w - b * b, root = std::sqrt(std::abs(d));
    double c, s;  // cos and sin(root t) / root, or their hyperbolic kin
    if (root * step_s < 1e-9)
      c = 1.0, s = step_s;
    else if (d > 0.0)
      c = std::cos(root * step_s), s = std::sin(root * step_s) / root;
    else
      c = std::cosh(root * step_s), s = std::sinh(root * step_s) / root;
    const Complex z = height_[i], v = speed_[i];
    height_[i] = left * (z * c + (v + b * z) * s);
    speed_[i] = left * (v * c - (b * v + w * w * z) * s);
  }
}

std::vector<double> SpectralWater::shape(const std::function<double(double)>& transform) const {
  std::vector<double> shape;
  for (const double k : number_) shape.push_back(transform(k) / (edge_m_ * edge_m_));
  return shape;
}

void SpectralWater::add(glm::dvec2 place_m, double amplitude_m, const std::function<double(double)>& transform) {
  add({{place_m, amplitude_m}}, shape(transform));
}

void SpectralWater::add(const std::vector<glm::dvec3>& seeds, const std::vector<double>& shape) {
  const int half = cells_ / 2 + 1;
  const double unit = 2.0 * pi / edge_m_;
  std::vector<Complex> across(static_cast<std::size_t>(half));
  for (const glm::dvec3& seed : seeds) {
    for (int i = 0; i < half; ++i) across[static_cast<std::size_t>(i)] = std::polar(seed.z, -unit * i * seed.x);
    for (int j = 0; j < cells_; ++j) {
      const Complex along = std::polar(1.0, -unit * (j <= cells_ / 2 ? j : j - cells_) * seed.y);
      for (int i = 0; i < half; ++i) {
        const std::size_t at = static_cast<std::size_t>(j) * half + i;
        if (shape[at] != 0.0) height_[at] += shape[at] * across[static_cast<std::size_t>(i)] * along;
      }
    }
  }
}

std::vector<double> SpectralWater::heights() const {
  for (std::size_t i = 0; i < height_.size(); ++i)
    plans_->modes[i][0] = height_[i].real(), plans_->modes[i][1] = height_[i].imag();
  fftw_execute(plans_->back);
  return {plans_->cells, plans_->cells + static_cast<std::size_t>(cells_) * cells_};
}

std::vector<glm::dvec2> SpectralWater::slopes() const {
  const int half = cells_ / 2 + 1;
  const double unit = 2.0 * pi / edge_m_;
  std::vector<glm::dvec2> result(static_cast<std::size_t>(cells_) * cells_);
  for (int axis = 0; axis < 2; ++axis) {
    for (int j = 0; j < cells_; ++j)
      for (int i = 0; i < half; ++i) {
        const int signed_j = j < cells_ / 2 ? j : j == cells_ / 2 ? 0 : j - cells_;
        const double k = unit * (axis == 0 ? (i == cells_ / 2 ? 0 : i) : signed_j);
        const Complex d = Complex(0.0, k) * height_[static_cast<std::size_t>(j) * half + i];
        auto& mode = plans_->modes[static_cast<std::size_t>(j) * half + i];
        mode[0] = d.real(), mode[1] = d.imag();
      }
    fftw_execute(plans_->back);
    for (std::size_t i = 0; i < result.size(); ++i) result[i][axis] = plans_->cells[i];
  }
  return result;
}

}  // namespace petrichor
