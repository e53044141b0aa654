#include "systems/drops/layers.hpp"

#include <algorithm>
#include <cmath>

namespace petrichor {

std::vector<RainLayer> layers_of(const RainClass& c) {
  std::vector<RainLayer> layers;
  double below = 0.0, held = c.base_drops_per_m3;
  while (c.drops_per_m3 > below) {
    const double edge = std::cbrt(drops_per_full_cell / held);
    const double here = std::min<double>(c.drops_per_m3 - below, held);
    layers.push_back({static_cast<float>(edge), static_cast<float>(drops_per_full_cell * (here / held))});
    below += held;
    held = below;
  }
  return layers;
}

RainLayers layers_in(const FrameRain& rain, const glm::dvec3& reference,
                     const std::function<bool(const RainClass&, RainBox&)>& wanted) {
  RainLayers result;
  for (std::size_t k = 0; k < rain.classes.size(); ++k) {
    const RainClass& c = rain.classes[k];
    RainBox box;
    if (!wanted(c, box)) continue;
    const glm::dvec3 origin = c.origin_m - reference;
    int number = 0;
    for (const RainLayer& layer : layers_of(c)) {
      const double edge = layer.edge_m;
      const glm::dvec3 first = glm::floor((box.low - origin) / edge);
      const glm::dvec3 count = glm::floor((box.high - origin) / edge) - first + 1.0;
      RainLayerGpu gpu;
      gpu.corner_edge = glm::vec4(glm::vec3(origin + first * edge), layer.edge_m);
      // Indices wrap at 2^32 cells.
      const auto wrapped = [](double v) { return static_cast<std::int32_t>(static_cast<std::int64_t>(v)); };
      gpu.first_cell = {wrapped(first.x), wrapped(first.y), wrapped(first.z), static_cast<int>(k << 8) | number};
      gpu.box = glm::uvec4(static_cast<std::uint32_t>(count.x), static_cast<std::uint32_t>(count.y),
                           static_cast<std::uint32_t>(count.z), static_cast<std::uint32_t>(result.candidates));
      gpu.velocity_diameter = glm::vec4(c.velocity_mps, c.diameter_mm * 1e-3f);
      gpu.expected = {layer.expected, std::exp(-layer.expected), c.reach, 0.0f};
      result.candidates += std::uint64_t(gpu.box.x) * gpu.box.y * gpu.box.z;
      result.layers.push_back(gpu);
      ++number;
    }
  }
  return result;
}

RainBox view_box(const FrameCamera& camera, int width, int height, float distance_m) {
  // The pyramid to that axial depth holds the part of the sphere that is seen; both bound the box.
  const double tall = std::tan(0.5 * camera.vertical_fov_rad), wide = tall * width / std::max(height, 1);
  RainBox box{glm::dvec3(0.0), glm::dvec3(0.0)};
  const glm::dquat now(camera.orientation);
  const glm::dvec3 turn = glm::dvec3(camera.angular_velocity_radps) * double(camera.exposure_s);
  const double angle = glm::length(turn);
  const glm::dquat then = angle > 1e-12 ? glm::angleAxis(-angle, turn / angle) * now : now;
  const glm::dvec3 moved = -glm::dvec3(camera.velocity_mps) * double(camera.exposure_s);
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 ray((i & 1 ? wide : -wide), (i & 2 ? tall : -tall), -1.0);
    glm::dvec3 corner = (i & 4 ? then : now) * ray * double(distance_m);
    corner = glm::clamp(corner, glm::dvec3(-distance_m), glm::dvec3(distance_m)) + (i & 4 ? moved : glm::dvec3(0.0));
    box.low = glm::min(box.low, corner);
    box.high = glm::max(box.high, corner);
  }
  box.low = glm::min(box.low, moved);
  box.high = glm::max(box.high, moved);
  return box;
}

RainLayers view_layers(const FrameRain& rain, const FrameCamera& camera, int width, int height) {
  if (!(rain.drawn_distance_m > 0.0f)) return {};
  FrameRain thinned = rain;
  for (RainClass& c : thinned.classes) c.drops_per_m3 *= rain.field_share();
  return layers_in(thinned, camera.position_m, [&](const RainClass& c, RainBox& box) {
    if (!c.drawn) return false;
    const RainBox view = view_box(camera, width, height, rain.drawn_distance_m * c.reach);
    // A drop that is seen while the shutter is open may have left the view when it closes.
    const glm::dvec3 swept = glm::dvec3(c.velocity_mps) * double(camera.exposure_s);
    box.low = view.low + glm::min(swept, 0.0);
    box.high = view.high + glm::max(swept, 0.0);
    return true;
  });
}

double candidate_cells(const FrameRain& rain, const FrameCamera& camera, int width, int height, float distance_m) {
  double sum = 0.0;
  for (const RainClass& c : rain.classes) {
    if (!c.drawn) continue;
    const RainBox view = view_box(camera, width, height, distance_m * c.reach);
    const glm::dvec3 size = view.high - view.low + glm::abs(glm::dvec3(c.velocity_mps)) * double(camera.exposure_s);
    for (const RainLayer& layer : layers_of(c)) {
      const glm::dvec3 cells = size / double(layer.edge_m) + 1.0;
      sum += cells.x * cells.y * cells.z;
    }
  }
  return sum;
}

}  // namespace petrichor
