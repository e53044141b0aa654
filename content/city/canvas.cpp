#include "content/city/canvas.hpp"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "content/city/dice.hpp"

namespace petrichor::city {
namespace {

glm::vec2 lattice_gradient(int x, int y, glm::ivec2 period, std::uint32_t seed) {
  const int wx = ((x % period.x) + period.x) % period.x;
  const int wy = ((y % period.y) + period.y) % period.y;
  const float t = unit(mix(seed, static_cast<std::uint32_t>(wx), static_cast<std::uint32_t>(wy))) * 6.2831853f;
  return {std::cos(t), std::sin(t)};
}

float fade(float t) {
  return t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
}

// Gradients of one period, tabulated: the textures evaluate tens of millions of lattice points.
struct Lattice {
  glm::ivec2 period{0};
  std::uint32_t seed = 0;
  std::vector<glm::vec2> gradients;
};

// Direct-mapped by seed and period; a clash only rebuilds a table.
const Lattice& lattice(glm::ivec2 period, std::uint32_t seed) {
  static std::array<Lattice, 256> known;
  Lattice& slot = known[mix(seed, static_cast<std::uint32_t>(period.x), static_cast<std::uint32_t>(period.y)) & 255u];
  if (slot.seed == seed && slot.period == period) return slot;
  slot = {period, seed, {}};
  slot.gradients.reserve(static_cast<std::size_t>(period.x) * static_cast<std::size_t>(period.y));
  for (int y = 0; y < period.y; ++y) {
    for (int x = 0; x < period.x; ++x) slot.gradients.push_back(lattice_gradient(x, y, period, seed));
  }
  return slot;
}

}  // namespace

float periodic_noise(glm::vec2 p, glm::ivec2 period, std::uint32_t seed) {
  const Lattice& current = lattice(period, seed);
  const glm::vec2 cell = glm::floor(p);
  const glm::vec2 f = p - cell;
  const int x0 = ((static_cast<int>(cell.x) % period.x) + period.x) % period.x;
  const int y0 = ((static_cast<int>(cell.y) % period.y) + period.y) % period.y;
  const int x1 = x0 + 1 == period.x ? 0 : x0 + 1;
  const int y1 = y0 + 1 == period.y ? 0 : y0 + 1;
  const auto corner = [&](int x, int y, float dx, float dy) {
    const glm::vec2 g = current.gradients[static_cast<std::size_t>(y) * period.x + x];
    return g.x * (f.x - dx) + g.y * (f.y - dy);
  };
  const float u = fade(f.x);
  const float v = fade(f.y);
  const float top = corner(x0, y0, 0, 0) * (1 - u) + corner(x1, y0, 1, 0) * u;
  const float low = corner(x0, y1, 0, 1) * (1 - u) + corner(x1, y1, 1, 1) * u;
  return 1.414f * (top * (1 - v) + low * v);
}

float periodic_fbm(float u, float v, glm::ivec2 cells, int octaves, std::uint32_t seed) {
  float sum = 0.0f;
  float amplitude = 0.5f;
  for (int k = 0; k < octaves; ++k) {
    sum += amplitude * periodic_noise(glm::vec2(u, v) * glm::vec2(cells), cells, seed + static_cast<std::uint32_t>(k));
    cells *= 2;
    amplitude *= 0.5f;
  }
  return sum * 1.3f;
}

float to_srgb(float linear) {
  linear = std::clamp(linear, 0.0f, 1.0f);
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

std::uint8_t to_byte(float value) {
  return static_cast<std::uint8_t>(std::clamp(value, 0.0f, 1.0f) * 255.0f + 0.5f);
}

Maps paint_maps(int width, int height, glm::vec2 metres, float relief_m,
                const std::function<Texel(float, float)>& texel) {
  Maps maps{Picture(width, height), Picture(width, height), Picture(width, height)};
  std::vector<float> heights(static_cast<std::size_t>(width) * height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Texel t = texel((static_cast<float>(x) + 0.5f) / static_cast<float>(width),
                            (static_cast<float>(y) + 0.5f) / static_cast<float>(height));
      std::uint8_t* colour = maps.base_colour.at(x, y);
      for (int c = 0; c < 3; ++c) colour[c] = to_byte(to_srgb(t.albedo[c]));
      std::uint8_t* material = maps.roughness_metalness.at(x, y);
      material[0] = relief_m > 0.0f ? to_byte(0.5f + t.height_m / relief_m) : 255;
      material[1] = to_byte(t.roughness);
      material[2] = to_byte(t.metalness);
      heights[static_cast<std::size_t>(y) * width + x] = t.height_m;
    }
  }
  const glm::vec2 step = metres / glm::vec2(width, height) * 2.0f;
  for (int y = 0; y < height; ++y) {
    const auto row = [&](int yy) { return static_cast<std::size_t>((yy + height) % height) * width; };
    for (int x = 0; x < width; ++x) {
      const float dx = heights[row(y) + (x + 1) % width] - heights[row(y) + (x + width - 1) % width];
      const float dy = heights[row(y + 1) + x] - heights[row(y - 1) + x];
      // glTF: +y of the map is up in the picture, which is -v.
      const glm::vec3 n = glm::normalize(glm::vec3(-dx / step.x, dy / step.y, 1.0f));
      std::uint8_t* out = maps.normal.at(x, y);
      for (int c = 0; c < 3; ++c) out[c] = to_byte(n[c] * 0.5f + 0.5f);
    }
  }
  return maps;
}

std::vector<std::uint8_t> encode(const Picture& picture, const std::string& format) {
  OIIO::Filesystem::IOVecOutput memory;
  const std::string name = "texture." + format;
  auto out = OIIO::ImageOutput::create(name);
  if (!out) return {};
  OIIO::ImageSpec spec(picture.width, picture.height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  if (format == "jpg") {
    spec.attribute("Compression", "jpeg:90");
    spec.attribute("jpeg:subsampling", "4:4:4");
  } else {
    spec.attribute("png:compressionLevel", 6);
  }
  if (!out->supports("ioproxy") || !out->set_ioproxy(&memory)) return {};
  if (!out->open(name, spec) || !out->write_image(OIIO::TypeDesc::UINT8, picture.rgb.data()) || !out->close()) {
    return {};
  }
  return memory.buffer();
}

}  // namespace petrichor::city
