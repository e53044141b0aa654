#include "systems/drip/normal_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "systems/drip/drip_shared.h"

namespace petrichor {
namespace {

using Level = std::vector<glm::vec4>;  // normal.xy, height, opacity

Level droplet(int size) {
  Level level(static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      glm::vec2 q = (glm::vec2(x, y) + 0.5f) * (2.0f / static_cast<float>(size)) - 1.0f;
      q.x *= 1.0f - 0.08f * q.y;  // +y is the way it falls: heavier below
      const float b = std::min(glm::length(q), 1.0f);
      // Beyond the rim normals go on, so that blurring does not bend them.
      const glm::vec2 n = b < 1.0f ? q : glm::normalize(q);
      level[static_cast<std::size_t>(y * size + x)] = {n, std::sqrt(1.0f - b * b), 1.0f};
    }
  return level;
}

// Half the size, and along y a mean over twice as far.
Level next_level(const Level& fine, int size) {
  const int half = size / 2;
  Level level(static_cast<std::size_t>(half) * static_cast<std::size_t>(half));
  for (int y = 0; y < half; ++y)
    for (int x = 0; x < half; ++x) {
      glm::vec4 sum(0.0f);
      float weights = 0.0f;
      for (int j = -2; j < 4; ++j)
        for (int i = 0; i < 2; ++i) {
          const int row = std::clamp(2 * y + j, 0, size - 1);
          const float weight = j == 0 || j == 1 ? 1.0f : 0.5f;
          sum += weight * fine[static_cast<std::size_t>(row * size + 2 * x + i)];
          weights += weight;
        }
      level[static_cast<std::size_t>(y * half + x)] = sum / weights;
    }
  return level;
}

}  // namespace

Texture make_droplet_normals() {
  Texture texture = make_texture_2d(DRIP_NORMALS, DRIP_NORMALS, GL_RGBA8, full_mip_levels(DRIP_NORMALS, DRIP_NORMALS));
  Level level = droplet(DRIP_NORMALS);
  for (int l = 0, size = DRIP_NORMALS; l < texture.levels; ++l, size /= 2) {
    std::vector<std::uint8_t> bytes;
    for (const glm::vec4& t : level)
      for (const float v : {0.5f + 0.5f * t.x, 0.5f + 0.5f * t.y, t.z, t.w})
        bytes.push_back(static_cast<std::uint8_t>(std::lround(255.0f * std::clamp(v, 0.0f, 1.0f))));
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(texture.id, l, 0, 0, size, size, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
    if (size > 1) level = next_level(level, size);
  }
  return texture;
}

}  // namespace petrichor
