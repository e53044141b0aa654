#include "systems/rainfall/snow/flake_optics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>

#include "systems/rainfall/drop_optics.hpp"
#include "systems/rainfall/rain_shared.h"

namespace petrichor {
namespace {

constexpr double pi = std::numbers::pi;

double henyey_greenstein(double g, double cosine) {
  return (1.0 - g * g) / (4.0 * pi * std::pow(1.0 + g * g - 2.0 * g * cosine, 1.5));
}

glm::dvec3 sky_radiance(const FrameSky& sky, const glm::dvec3& direction) {  // as systems/sky.glsl
  const double glow = std::exp(-std::max(direction.y, 0.0) / std::max(double(sky.glow_height), 1e-3));
  return glm::mix(glm::dvec3(sky.zenith_cd_m2), glm::dvec3(sky.horizon_cd_m2), glow);
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

void bind_flake_optics(FlakeOptics& optics, const Frame& frame) {
  if (optics.phase.bytes == 0) upload(optics.phase, std::span<const float>(make_flake_phase()));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, RAIN_OPTICS_BINDING, optics.phase.id);
  const FrameSky& sky = frame.sky;
  if (optics.known && sky.zenith_cd_m2 == optics.sky.zenith_cd_m2 && sky.horizon_cd_m2 == optics.sky.horizon_cd_m2 &&
      sky.glow_height == optics.sky.glow_height)
    return;
  optics.ambient = fit_by_elevation([&](const glm::dvec3& ray) { return flake_radiance(ray, sky); });
  optics.sky = sky;
  optics.known = true;
}

void set_flake_ambient(const FlakeOptics& optics, const Program& program) {
  for (int i = 0; i < 4; ++i) program.set("ambient[" + std::to_string(i) + "]", optics.ambient[i]);
}

}  // namespace petrichor
