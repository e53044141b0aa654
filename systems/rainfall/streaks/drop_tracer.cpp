#include "systems/rainfall/streaks/drop_tracer.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "systems/drops/drop_optics.hpp"

namespace petrichor {
namespace {

constexpr double n_water = water_refractive_index;
constexpr double exact = 1e-9;        // radii
constexpr int most_surfaces = 160;    // total reflections can go round and round
constexpr double left_inside = 5e-4;  // of the ray's power, given up

// Stokes vector about a direction of travel, with the axis of positive q.
struct Polarised {
  double i = 1.0, q = 0.0, u = 0.0, v = 0.0;
};

Polarised turned(const Polarised& s, double cosine, double sine) {  // axis turned about the ray
  const double c2 = cosine * cosine - sine * sine, s2 = 2.0 * sine * cosine;
  return {s.i, s.q * c2 + s.u * s2, s.u * c2 - s.q * s2, s.v};
}

// across, within: the shares of power; coupling: of u and v, by the product of the amplitudes.
Polarised dimmed(const Polarised& s, double across, double within, std::complex<double> coupling) {
  const double mean = 0.5 * (across + within), half = 0.5 * (across - within);
  return {mean * s.i + half * s.q, half * s.i + mean * s.q, coupling.real() * s.u - coupling.imag() * s.v,
          coupling.imag() * s.u + coupling.real() * s.v};
}

// First place on the surface from outside, by Newton's method, which comes to a convex body from outside without
// passing it; negative: none.
double entry(const DropShape& shape, const glm::dvec3& origin, const glm::dvec3& direction) {
  const double middle = -glm::dot(origin, direction);
  const glm::dvec3 nearest = origin + middle * direction;
  const double room = largest_radius * largest_radius - glm::dot(nearest, nearest);
  if (room <= 0.0) return -1.0;
  double t = middle - std::sqrt(room);
  glm::dvec3 gradient;
  for (int i = 0; i < 60; ++i) {
    const double f = surface(shape, origin + t * direction, gradient);
    if (f < exact) return t;
    const double slope = glm::dot(gradient, direction);
    if (slope >= -1e-9) return -1.0;
    t -= f / slope;
  }
  return -1.0;
}

// From a place on the surface through the drop to the next, by Newton's method between two bounds; the start's own root
// is divided out. Negative: not found.
double crossing(const DropShape& shape, const glm::dvec3& from, const glm::dvec3& direction) {
  double low = 0.0, high = 2.0 * largest_radius;
  double t = -2.0 * glm::dot(from, direction);
  if (!(t > 0.02)) t = 0.02;
  glm::dvec3 gradient;
  for (int i = 0; i < 60; ++i) {
    const double f = surface(shape, from + t * direction, gradient);
    if (std::abs(f) < exact && t > 1e-5) return t;
    (f < 0.0 ? low : high) = t;
    if (high < 1e-6) return -1.0;
    const double next = t - t * f / (glm::dot(gradient, direction) * t - f);
    t = next > low && next < high ? next : 0.5 * (low + high);
  }
  return -1.0;
}

}  // namespace

DropPaths trace_drop(const DropShape& shape, const glm::dvec3& origin, const glm::dvec3& direction) {
  DropPaths result;
  const auto leave = [&](const glm::dvec3& d, double share) { result.paths[result.count++] = {d, share}; };
  const double hit = entry(shape, origin, direction);
  if (hit < 0.0) return result;
  glm::dvec3 place = origin + hit * direction, gradient;
  surface(shape, place, gradient);
  glm::dvec3 normal = glm::normalize(gradient);
  const double cosine = std::clamp(-glm::dot(direction, normal), 0.0, 1.0);
  const Fresnel f = fresnel(cosine);
  leave(direction + 2.0 * cosine * normal, 0.5 * (f.across + f.within));
  // Axis across the plane of incidence; any where the ray stands on the surface, for there both shares are the same.
  const auto across_axis = [](const glm::dvec3& d, const glm::dvec3& n) {
    glm::dvec3 axis = glm::cross(d, n);
    if (glm::dot(axis, axis) < 1e-20)
      axis = glm::cross(d, std::abs(d.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0));
    return glm::normalize(axis);
  };
  glm::dvec3 axis = across_axis(direction, normal);
  Polarised light = dimmed({}, 1.0 - f.across, 1.0 - f.within, std::sqrt((1.0 - f.across) * (1.0 - f.within)));
  const double sine_inside2 = (1.0 - cosine * cosine) / (n_water * n_water);
  glm::dvec3 d = direction / n_water + (cosine / n_water - std::sqrt(1.0 - sine_inside2)) * normal;
  d = glm::normalize(d);
  for (int met = 0; met < most_surfaces && result.count < drop_paths; ++met) {
    const double chord = crossing(shape, place, d);
    if (chord < 0.0) return result;
    place += chord * d;
    surface(shape, place, gradient);
    normal = glm::normalize(gradient);
    const glm::dvec3 next_axis = across_axis(d, normal);
    light = turned(light, glm::dot(axis, next_axis), glm::dot(glm::cross(axis, next_axis), d));
    axis = next_axis;
    const double c = std::clamp(glm::dot(d, normal), 0.0, 1.0);  // inside
    const double sine_air2 = n_water * n_water * (1.0 - c * c);
    const glm::dvec3 reflected = d - 2.0 * glm::dot(d, normal) * normal;
    if (sine_air2 >= 1.0) {  // total: all of it, with a shift between the polarisations
      const std::complex<double> q(0.0, std::sqrt(sine_air2 - 1.0));  // times the cosine in air
      const std::complex<double> s = (n_water * c - q) / (n_water * c + q), p = (c - n_water * q) / (c + n_water * q);
      light = dimmed(light, 1.0, 1.0, s * std::conj(p));
    } else {
      const double air = std::sqrt(1.0 - sine_air2);
      const double s = (n_water * c - air) / (n_water * c + air), p = (c - n_water * air) / (c + n_water * air);
      const Polarised out = dimmed(light, 1.0 - s * s, 1.0 - p * p, std::sqrt((1.0 - s * s) * (1.0 - p * p)));
      leave(glm::normalize(n_water * d + (air - n_water * c) * normal), out.i);
      light = dimmed(light, s * s, p * p, s * p);
      if (light.i < left_inside) return result;
    }
    d = glm::normalize(reflected);
  }
  return result;
}

}  // namespace petrichor
