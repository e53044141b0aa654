#pragma once
// The drop field on the CPU, written from field.glsl's definition: which drops are in a box. Slow and plain.

#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

#include "engine/core/random.hpp"
#include "systems/drops/layers.hpp"

namespace petrichor {

struct FieldDrop {
  std::size_t cls;
  std::uint32_t layer;
  glm::ivec3 cell;
  std::uint32_t number;
  glm::dvec3 position_m;  // relative to the reference
};

inline std::vector<FieldDrop> drops_in(const FrameRain& rain, const glm::dvec3& reference, const RainBox& box) {
  std::vector<FieldDrop> drops;
  const RainLayers layers = layers_in(rain, reference, [&](const RainClass&, RainBox& b) {
    b = box;
    return true;
  });
  for (const RainLayerGpu& layer : layers.layers) {
    for (std::uint32_t z = 0; z < layer.box.z; ++z)
      for (std::uint32_t y = 0; y < layer.box.y; ++y)
        for (std::uint32_t x = 0; x < layer.box.x; ++x) {
          const glm::ivec3 cell = glm::ivec3(layer.first_cell) + glm::ivec3(x, y, z);
          const glm::uvec4 bits =
              random_bits4(glm::uvec4(key_of(cell.x), key_of(cell.y), key_of(cell.z),
                                      std::uint32_t(layer.first_cell.w) ^ (rain.seed * 0x9e3779b9u)));
          const std::uint32_t count = poisson_count(unit_float(bits.x), layer.expected.x, layer.expected.y, 255u);
          for (std::uint32_t m = 0; m < count; ++m) {
            const glm::uvec4 b = random_bits4(glm::uvec4(bits.y, bits.z, m, bits.w));
            const glm::dvec3 at =
                glm::dvec3(layer.corner_edge) +
                (glm::dvec3(x, y, z) + glm::dvec3(unit_float(b.x), unit_float(b.y), unit_float(b.z))) *
                    double(layer.corner_edge.w);
            if (glm::all(glm::greaterThanEqual(at, box.low)) && glm::all(glm::lessThan(at, box.high)))
              drops.push_back(
                  {std::size_t(layer.first_cell.w >> 8), std::uint32_t(layer.first_cell.w & 255), cell, m, at});
          }
        }
  }
  return drops;
}

}  // namespace petrichor
