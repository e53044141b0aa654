#include "systems/rainfall/snow/flake_optics.hpp"

#include <cmath>
#include <numbers>

#include "systems/drops/drop_optics.hpp"

namespace petrichor {
namespace {

constexpr double pi = std::numbers::pi;

double henyey_greenstein(double g, double cosine) {
  return (1.0 - g * g) / (4.0 * pi * std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
}

}  // namespace

double flake_phase(double cosine) {
  return flake_forward_share * henyey_greenstein(flake_forward_cosine, cosine) +
         (1.0 - flake_forward_share) * henyey_greenstein(flake_backward_cosine, cosine);
}

std::vector<float> make_flake_phase() {
  std::vector<float> phase(drop_phase_bins);
  constexpr int points = 8;
  for (int i = 0; i < drop_phase_bins; ++i) {
    // Solid angle goes with the square of sin(turn / 2): equal steps of that are equal solid angles.
    const double a = double(i) / drop_phase_bins, b = double(i + 1) / drop_phase_bins;
    double sum = 0.0;
    for (int j = 0; j < points; ++j) sum += flake_phase(1.0 - 2.0 * (a * a + (b * b - a * a) * (j + 0.5) / points));
    phase[i] = static_cast<float>(sum / points);
  }
  return phase;
}

glm::dvec3 flake_radiance(const glm::dvec3& direction, const FrameSky& sky) {
  const glm::dvec3 helper = std::abs(direction.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 side = glm::normalize(glm::cross(direction, helper)), up = glm::cross(side, direction);
  constexpr int rings = 48, spokes = 16;
  glm::dvec3 sum(0.0);
  double weights = 0.0;
  for (int i = 0; i < rings; ++i) {
    const double cosine = 1.0 - 2.0 * (i + 0.5) / rings, sine = std::sqrt(1.0 - cosine * cosine);
    const double weight = flake_phase(cosine);
    for (int j = 0; j < spokes; ++j) {
      const double turn = 2.0 * pi * (j + 0.5 * (i & 1)) / spokes;
      // Light that arrives along -d has turned by the angle between d and the view.
      sum += weight * sky_radiance(sky, cosine * direction + sine * (std::cos(turn) * side + std::sin(turn) * up));
      weights += weight;
    }
  }
  return sum / weights;
}

void bind_flake_optics(ParticleOptics& optics, const Frame& frame) {
  bind_optics(optics, frame, make_flake_phase, [](const FrameSky& sky) {
    return fit_by_elevation([&](const glm::dvec3& ray) { return flake_radiance(ray, sky); });
  });
}

}  // namespace petrichor
