#include "systems/puddle/list.hpp"

#include <algorithm>
#include <cmath>

namespace petrichor {

PuddleList list_puddles(const FramePuddles& frame, const glm::dvec3& camera_m) {
  PuddleList list{};
  struct Box {
    glm::vec2 low, high;
  };
  std::vector<Box> boxes;
  glm::vec2 low(INFINITY), high(-INFINITY);
  for (const FramePuddles::Puddle& p : frame.puddles) {
    if (p.level_m <= 0.0f || list.puddles.size() == PUDDLES_AT_MOST) continue;
    const glm::vec3 x(p.world_from_puddle[0]), y(p.world_from_puddle[1]), z(p.world_from_puddle[2]);
    const glm::vec3 origin(glm::dvec3(glm::vec3(p.world_from_puddle[3])) - camera_m);
    const auto row = [&](const glm::vec3& axis) { return glm::vec4(axis, -glm::dot(axis, origin)); };
    list.puddles.push_back({row(x),
                            row(y),
                            row(z),
                            {p.half_size_m, p.depth_m, p.depth_m - p.level_m},
                            {p.ripple_influence, p.ripple_scale, p.ripple_turn_rad, p.by_height ? 1.0f : 0.0f}});
    list.head.counts.w |= p.by_height ? 1u : 0u;
    const glm::vec3 reach =
        glm::abs(x) * p.half_size_m.x + glm::abs(y) * (p.depth_m + PUDDLE_BELOW_M) + glm::abs(z) * p.half_size_m.y;
    boxes.push_back({{origin.x - reach.x, origin.z - reach.z}, {origin.x + reach.x, origin.z + reach.z}});
    low = glm::min(low, boxes.back().low);
    high = glm::max(high, boxes.back().high);
  }
  list.head.cells.w = frame.published;
  list.head.counts.z = static_cast<std::uint32_t>(list.puddles.size());
  if (boxes.empty()) {
    list.puddles.emplace_back();
    list.cells.assign(2, 0);
    return list;
  }
  const glm::vec2 extent = high - low;
  const float edge = std::max(PUDDLE_CELL_M, std::max(extent.x, extent.y) * 1.001f / PUDDLE_CELLS);
  const auto cells = [&](float length) {
    return static_cast<std::uint32_t>(std::clamp(std::ceil(length / edge), 1.0f, static_cast<float>(PUDDLE_CELLS)));
  };
  const std::uint32_t nx = cells(extent.x), nz = cells(extent.y);
  list.head.cells = {low, 1.0f / edge, frame.published};
  list.head.counts.x = nx;
  list.head.counts.y = nz;
  list.cells.assign(std::size_t{2} * nx * nz, 0);
  const auto cell_of = [&](float along, std::uint32_t count) {
    return static_cast<std::uint32_t>(std::clamp(std::floor(along / edge), 0.0f, static_cast<float>(count - 1)));
  };
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const glm::vec2 from = boxes[i].low - low, to = boxes[i].high - low;
    for (std::uint32_t z = cell_of(from.y, nz); z <= cell_of(to.y, nz); ++z) {
      for (std::uint32_t x = cell_of(from.x, nx); x <= cell_of(to.x, nx); ++x) {
        for (int slot = 0; slot < 8; ++slot) {
          std::uint32_t& word = list.cells[2 * (std::size_t{z} * nx + x) + static_cast<std::size_t>(slot / 4)];
          const int shift = 8 * (slot % 4);
          if ((word >> shift & 255u) != 0) continue;
          word |= static_cast<std::uint32_t>(i + 1) << shift;
          break;
        }
      }
    }
  }
  return list;
}

}  // namespace petrichor
