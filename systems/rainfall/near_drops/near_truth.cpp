#include "systems/rainfall/near_drops/near_truth.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace petrichor {
namespace {

constexpr double pi = std::numbers::pi;

// Radius of a listed drop, m: of the circle that its image is drawn as.
double radius_of(const Frame& frame, const NearDropGpu& drop) {
  const glm::dvec3 place(drop.place);
  const double axial = glm::dot(place, glm::dquat(frame.camera.orientation) * glm::dvec3(0, 0, -1));
  const double away = glm::length(place),
               pixels_per_radian = 0.5 * frame.height / std::tan(0.5 * frame.camera.vertical_fov_rad);
  return drop.depths.w / pixels_per_radian * std::sqrt(axial * axial * axial / away);
}

// The streak's side in the world, across the ray: near_list.glsl, lateral_of and across.
glm::dvec3 side_of(const Frame& frame, const NearDropGpu& drop) {
  const glm::dvec2 span(drop.from_to.z - drop.from_to.x, drop.from_to.w - drop.from_to.y);
  glm::dvec2 side = glm::length(span) < 1e-4 ? glm::dvec2(1, 0) : glm::normalize(glm::dvec2(-span.y, span.x));
  if (std::abs(side.x) > 1e-6) side *= side.x > 0 ? 1.0 : -1.0;
  const glm::dquat to_world(frame.camera.orientation);
  const glm::dvec3 d = glm::normalize(glm::dvec3(drop.place));
  const glm::dvec3 w = to_world * glm::dvec3(side.x, side.y, 0.0);
  return glm::normalize(w - d * glm::dot(w, d));
}

double brightness(const glm::dvec3& c) {
  return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

}  // namespace

std::vector<glm::dvec3> traced_columns(const World& world, const Frame& frame, const NearDropGpu& drop,
                                       int interactions) {
  const int columns = static_cast<int>(drop.place.w), aside = 256 / columns;  // lamps take a thousandth of the image
  constexpr int along = 96;
  const glm::dvec3 eye = frame.camera.position_m, centre = eye + glm::dvec3(drop.place);
  const glm::dvec3 d = glm::normalize(centre - eye), right = side_of(frame, drop), up = glm::cross(right, d);
  const double radius = radius_of(frame, drop);
  std::vector<glm::dvec3> means(static_cast<std::size_t>(columns), glm::dvec3(0.0));
  for (int c = 0; c < columns; ++c) {
    double weights = 0.0;
    for (int k = 0; k < aside; ++k) {
      const double x = (c * aside + k + 0.5) * 2.0 / (columns * aside) - 1.0, chord = std::sqrt(1.0 - x * x);
      for (int j = 0; j < along; ++j) {
        const double y = chord * ((2.0 * j + 1.0) / along - 1.0);
        means[c] += chord * traced_drop(world, eye, centre, radius, right, up, {x, y}, interactions);
        weights += chord;
      }
    }
    means[c] /= weights;
  }
  return means;
}

glm::dvec3 field_colour(const World& world, const Frame& frame, const NearDropGpu& drop) {
  const glm::dvec3 eye = frame.camera.position_m, n = glm::normalize(glm::dvec3(drop.place));
  const glm::dvec3 side =
      glm::normalize(glm::cross(std::abs(n.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0), n));
  const glm::dvec3 up = glm::cross(n, side);
  constexpr int samples = 256;
  const double a2 = std::pow(0.55, 4.0);  // as environment_filter.comp.glsl
  glm::dvec3 lobe(0.0), all(0.0);
  double weights = 0.0;
  for (int i = 0; i < samples; ++i) {
    const double u = (i + 0.5) / samples, angle = 2.399963 * i;
    const double cosine = std::sqrt((1.0 - u) / (1.0 + (a2 - 1.0) * u)), sine = std::sqrt(1.0 - cosine * cosine);
    const glm::dvec3 h = side * (std::cos(angle) * sine) + up * (std::sin(angle) * sine) + n * cosine;
    const glm::dvec3 l = 2.0 * glm::dot(n, h) * h - n;
    const double weight = std::max(glm::dot(n, l), 0.0);
    if (weight > 0.0) lobe += weight * world(eye, l);
    weights += weight;
    const double y = 1.0 - 2.0 * u, r = std::sqrt(1.0 - y * y);
    all += world(eye, {r * std::cos(angle), y, r * std::sin(angle)}) / double(samples);
  }
  return 0.93 * lobe / weights + 0.0664 * all;
}

NearComparison compare_columns(const World& world, const Frame& frame, const NearListed& listed, int most_drops) {
  NearComparison result;
  std::vector<std::size_t> order(listed.drops.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return listed.drops[a].bits.x < listed.drops[b].bits.x; });
  double squares = 0.0, off = 0.0, weights = 0.0;
  for (const std::size_t i : order) {
    const NearDropGpu& drop = listed.drops[i];
    const glm::vec2 span(drop.from_to.z - drop.from_to.x, drop.from_to.w - drop.from_to.y);
    if (!(glm::length(span) > 4.0f * drop.depths.w)) continue;
    if (result.drops >= most_drops) break;
    ++result.drops;
    const std::vector<glm::dvec3> truth = traced_columns(world, frame, drop);
    const double even = brightness(field_colour(world, frame, drop));
    const std::size_t n = truth.size();
    for (std::size_t c = 0; c < n; ++c) {
      const double x = (2.0 * c + 1.0) / n - 1.0;
      const double weight = std::sqrt(1.0 - x * x) / n * drop.depths.z;
      const double seen = brightness(glm::dvec3(listed.columns[i * NEAR_COLUMNS + c])), is = brightness(truth[c]);
      squares += weight * (seen - is) * (seen - is);
      off += weight * (even - is) * (even - is);
      result.mean += weight * seen;
      result.true_mean += weight * is;
      weights += weight;
    }
  }
  if (!(weights > 0.0)) return result;
  result.error = std::sqrt(squares / weights);
  result.off = std::sqrt(off / weights);
  result.mean /= weights;
  result.true_mean /= weights;
  return result;
}

}  // namespace petrichor
