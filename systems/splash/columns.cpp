#include "systems/splash/columns.hpp"

#include <algorithm>
#include <cmath>

#include "systems/splash/impact.h"

namespace petrichor {

bool may_splash(const RainClass& c) {
  const float diameter = c.diameter_mm * 1e-3f, speed = glm::length(c.velocity_mps);
  return c.drops_per_m3 > 0.0f && c.velocity_mps.y < -0.1f &&
         (impact::splash_on_dry(diameter, speed) > 1.0f || impact::splash_on_wetted(diameter, speed) > 1.0f);
}

RainLayers splash_columns(const FrameRain& rain, const FrameCamera& camera, int width, int height, float reach_m,
                          float least_mm, float secondary_reach_m) {
  RainLayers result;
  for (std::size_t k = 0; k < rain.classes.size(); ++k) {
    const RainClass& c = rain.classes[k];
    if (!may_splash(c) || c.diameter_mm < least_mm) continue;
    const float diameter = c.diameter_mm * 1e-3f;
    const RainBox view = view_box(camera, width, height, reach_m);
    const glm::dvec3 origin = c.origin_m - camera.position_m, velocity(c.velocity_mps);
    float life = impact::splash_life(diameter);
    if (diameter > 1e-3f && secondary_reach_m > 0.0f) life = std::max(life, impact::SECONDARY_LIFE);
    const double deep = -velocity.y * (life + camera.exposure_s) + 0.2;
    int number = 0;
    for (const RainLayer& layer : layers_of(c)) {
      const double edge = layer.edge_m;
      const double first_level = std::floor((view.low.y - deep - origin.y) / edge);
      const double levels = std::min(std::floor((view.high.y + 0.2 - origin.y) / edge) - first_level + 1.0, 128.0);
      const double base = origin.y + first_level * edge, tall = levels * edge;
      // Columns that pass through the box of what is seen, at any of its heights.
      const glm::dvec2 slope(velocity.x / velocity.y, velocity.z / velocity.y);
      const glm::dvec2 origin_xz(origin.x, origin.z);
      const glm::dvec2 leans = slope * tall;
      const glm::dvec2 low = glm::dvec2(view.low.x, view.low.z) - glm::max(leans, 0.0) - 0.5 * edge;
      const glm::dvec2 high = glm::dvec2(view.high.x, view.high.z) - glm::min(leans, 0.0) + 0.5 * edge;
      const glm::dvec2 first = glm::floor((low - origin_xz) / edge);
      const glm::dvec2 count = glm::floor((high - origin_xz) / edge) - first + 1.0;
      RainLayerGpu gpu;
      gpu.corner_edge = {static_cast<float>(origin.x + first.x * edge), static_cast<float>(base),
                         static_cast<float>(origin.z + first.y * edge), layer.edge_m};
      const auto wrapped = [](double v) { return static_cast<std::int32_t>(static_cast<std::int64_t>(v)); };
      gpu.first_cell = {wrapped(first.x), wrapped(first_level), wrapped(first.y), static_cast<int>(k << 8) | number};
      gpu.box = glm::uvec4(static_cast<std::uint32_t>(count.x), static_cast<std::uint32_t>(levels),
                           static_cast<std::uint32_t>(count.y), static_cast<std::uint32_t>(result.candidates));
      gpu.velocity_diameter = glm::vec4(c.velocity_mps, diameter);
      gpu.expected = {layer.expected, std::exp(-layer.expected), reach_m,
                      static_cast<float>(layer.expected / (edge * edge * edge))};
      result.candidates += std::uint64_t(gpu.box.x) * gpu.box.z;
      result.layers.push_back(gpu);
      ++number;
    }
  }
  return result;
}

}  // namespace petrichor
