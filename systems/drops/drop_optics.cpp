#include "systems/drops/drop_optics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace petrichor {
namespace {

constexpr double pi = std::numbers::pi;

// Folds a deviation of any number of turns to [0, pi].
double fold(double angle) {
  angle = std::fmod(std::abs(angle), 2.0 * pi);
  return angle > pi ? 2.0 * pi - angle : angle;
}

}  // namespace

Fresnel fresnel(double c) {
  constexpr double n = water_refractive_index;
  c = std::clamp(c, 0.0, 1.0);
  const double s = std::sqrt(1.0 - (1.0 - c * c) / (n * n));
  const double rs = (c - n * s) / (c + n * s), rp = (n * c - s) / (n * c + s);
  return {rs * rs, rp * rp};
}

std::array<DropRay, drop_ray_orders> trace_sphere(double offset) {
  offset = std::clamp(offset, 0.0, 1.0);
  const double in = std::asin(offset), inside = std::asin(offset / water_refractive_index);
  // The ray stays in one plane, so each polarisation keeps its own reflectance at every surface.
  const Fresnel f = fresnel(std::cos(in));
  std::array<DropRay, drop_ray_orders> rays;
  rays[0] = {pi - 2.0 * in, 0.5 * (f.across + f.within)};
  double across = 0.5 * (1.0 - f.across) * (1.0 - f.across), within = 0.5 * (1.0 - f.within) * (1.0 - f.within);
  for (int order = 1; order < drop_ray_orders; ++order) {
    rays[order] = {fold(2.0 * (in - inside) + (order - 1) * (pi - 2.0 * inside)), across + within};
    across *= f.across;
    within *= f.within;
  }
  return rays;
}

std::vector<float> make_drop_phase() {
  std::vector<double> power(drop_phase_bins, 0.0);
  // Equal areas of the disc, so equal powers; enough of them that a bin's own graininess is below 1%.
  constexpr int rings = 1 << 17;
  for (int i = 0; i < rings; ++i) {
    for (const DropRay& ray : trace_sphere(std::sqrt((i + 0.5) / rings))) {
      const int bin = std::min(drop_phase_bins - 1, static_cast<int>(std::sin(0.5 * ray.turn_rad) * drop_phase_bins));
      power[bin] += ray.share / rings;
    }
  }
  std::vector<float> phase(drop_phase_bins);
  for (int i = 0; i < drop_phase_bins; ++i) {
    // Solid angle between sin(turn/2) = a and b: 2 pi (cos A - cos B) = 4 pi (b^2 - a^2).
    const double a = double(i) / drop_phase_bins, b = double(i + 1) / drop_phase_bins;
    phase[i] = static_cast<float>(power[i] / (4.0 * pi * (b * b - a * a)));
  }
  return phase;
}

glm::dvec3 drop_radiance(const glm::dvec3& direction,
                         const std::function<glm::dvec3(const glm::dvec3&)>& surroundings) {
  const glm::dvec3 helper = std::abs(direction.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  const glm::dvec3 side = glm::normalize(glm::cross(direction, helper));
  const glm::dvec3 up = glm::cross(side, direction);
  // Midpoints of equal-area rings of the disc, and round each ring; by reversibility a ray leaving the eye
  // meets what sends light to it.
  constexpr int rings = 24, spokes = 12;
  glm::dvec3 sum(0.0);
  for (int i = 0; i < rings; ++i) {
    const auto rays = trace_sphere(std::sqrt((i + 0.5) / rings));
    for (int order = 0; order < drop_ray_orders; ++order) {
      if (rays[order].share < 1e-3) continue;
      for (int j = 0; j < spokes; ++j) {
        const double turn = 2.0 * pi * (j + 0.5 * (i & 1)) / spokes;
        const glm::dvec3 outward = std::cos(turn) * side + std::sin(turn) * up;
        // The outer reflection turns away from the axis on the ray's own side, the refracted ray across it; the
        // ring is symmetric, so the side does not matter to the sum.
        sum += rays[order].share *
               surroundings(std::cos(rays[order].turn_rad) * direction + std::sin(rays[order].turn_rad) * outward);
      }
    }
  }
  return sum / double(rings * spokes);
}

std::array<glm::vec3, 4> fit_drop_radiance(const std::function<glm::dvec3(const glm::dvec3&)>& surroundings) {
  return fit_by_elevation([&](const glm::dvec3& ray) { return drop_radiance(ray, surroundings); });
}

std::array<glm::vec3, 4> fit_by_elevation(const std::function<glm::dvec3(const glm::dvec3&)>& seen_along) {
  // Legendre polynomials are orthogonal on [-1, 1], so each coefficient is one integral; Gauss-Legendre, 8 points.
  constexpr std::array<double, 4> nodes{0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
  constexpr std::array<double, 4> weights{0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                          0.1012285362903763};
  std::array<glm::dvec3, 4> c{};
  for (int i = 0; i < 8; ++i) {
    const double x = (i & 1 ? -1.0 : 1.0) * nodes[i / 2];
    const glm::dvec3 seen = seen_along(glm::dvec3(0.0, x, -std::sqrt(1.0 - x * x)));
    const double p[4] = {1.0, x, 0.5 * (3.0 * x * x - 1.0), 0.5 * (5.0 * x * x * x - 3.0 * x)};
    for (int n = 0; n < 4; ++n) c[n] += seen * (weights[i / 2] * p[n] * (2.0 * n + 1.0) / 2.0);
  }
  return {glm::vec3(c[0] - 0.5 * c[2]), glm::vec3(c[1] - 1.5 * c[3]), glm::vec3(1.5 * c[2]), glm::vec3(2.5 * c[3])};
}

}  // namespace petrichor
