#include "systems/rainfall/layered/textures.hpp"

#include <cmath>
#include <glm/glm.hpp>
#include <numeric>
#include <utility>

#include "engine/core/random.hpp"
#include "systems/drops/drop_physics.hpp"
#include "systems/rainfall/layered/motion.hpp"

namespace petrichor {

std::vector<std::array<std::uint8_t, 4>> make_placement() {
  constexpr int size = layered_placement;
  std::vector<std::array<std::uint8_t, 4>> texels(std::size_t(size) * size);
  RandomStream random(0x70796f74u);
  std::array<std::uint8_t, size> order;
  for (int x = 0; x < size; ++x)
    for (int channel = 0; channel < 4; ++channel) {
      std::iota(order.begin(), order.end(), std::uint8_t{0});
      for (std::uint32_t i = size - 1; i > 0; --i) std::swap(order[i], order[random.below(i + 1)]);
      for (int y = 0; y < size; ++y) texels[std::size_t(y) * size + x][channel] = order[y];
    }
  return texels;
}

std::vector<std::array<std::uint32_t, 2>> pair_placement(const std::vector<std::array<std::uint8_t, 4>>& texels,
                                                         int stretch) {
  constexpr std::size_t size = layered_placement;
  std::vector<std::array<std::uint32_t, 2>> pairs(texels.size());
  for (std::size_t y = 0; y < size; ++y)
    for (std::size_t x = 0; x < size; ++x)
      for (std::size_t i = 0; i < 2; ++i) {
        const auto& t = texels[(((y + i) << stretch) % size) * size + x];
        pairs[y * size + x][i] =
            t[0] | std::uint32_t{t[1]} << 8 | std::uint32_t(t[2] >> stretch) << 16 | std::uint32_t{t[3]} << 24;
      }
  return pairs;
}

std::vector<std::array<std::int8_t, 4>> make_drop_normals(int size, int drops) {
  std::vector<std::array<std::int8_t, 4>> texels(std::size_t(size) * size * drops);
  RandomStream random(0x64726f70u);
  for (int drop = 0; drop < drops; ++drop) {
    const double diameter_mm = 1.0 + 5.0 * drop / std::max(drops - 1, 1);
    // The oblate mode (2, 0) about the mean shape, at a phase of its own; canting of a few degrees.
    const double ratio = axis_ratio(diameter_mm) * (1.0 + 0.1 * random.uniform(-1.0f, 1.0f));
    const double cant = 0.1 * random.uniform(-1.0f, 1.0f);
    const double wide = std::min(1.0, 1.0 / ratio), tall = wide * ratio;
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) {
        const double u = (x + 0.5) / size * 2.0 - 1.0, v = (y + 0.5) / size * 2.0 - 1.0;
        const glm::dvec2 at(std::cos(cant) * u + std::sin(cant) * v, -std::sin(cant) * u + std::cos(cant) * v);
        const glm::dvec2 p = at / glm::dvec2(wide, tall);
        const double inside = glm::dot(p, p);
        if (inside > 1.0) continue;
        // Of the spheroid, as deep as it is wide.
        const glm::dvec3 n =
            glm::normalize(glm::dvec3(p.x / wide, p.y / tall, std::sqrt(std::max(1.0 - inside, 0.0)) / wide));
        const glm::dvec2 turned(std::cos(cant) * n.x - std::sin(cant) * n.y,
                                std::sin(cant) * n.x + std::cos(cant) * n.y);
        texels[(std::size_t(drop) * size + y) * size + x] = {static_cast<std::int8_t>(std::lround(127.0 * turned.x)),
                                                             static_cast<std::int8_t>(std::lround(127.0 * turned.y)),
                                                             127, 127};
      }
  }
  return texels;
}

}  // namespace petrichor
