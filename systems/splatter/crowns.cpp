#include "systems/splatter/crowns.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/random.hpp"
#include "systems/splatter/splatter_shared.h"

namespace petrichor {
namespace {

constexpr double pi = 3.14159265358979;
constexpr double film = 0.1;    // h / D
constexpr double spread = 5.8;  // largest radius, D

}  // namespace

double crown_radius(double age, double height) {
  const double free = std::pow(2.0 / 3.0, 0.25) * std::pow(film, -0.25) * std::sqrt(std::max(age, 0.0));
  return spread * (1.0 - std::exp(-free / spread)) + 0.4 * height;  // the sheet leans outwards
}

double crown_rim(double age) {
  // Up within an eighth of its life, down over the rest; as high as physics, section 6, has it: 1 to 3 D.
  const double x = std::clamp(age / SPLATTER_LIFE, 0.0, 1.0);
  return SPLATTER_HEIGHT * (x < 0.125 ? std::sin(0.5 * pi * x / 0.125) : std::pow(1.0 - (x - 0.125) / 0.875, 0.7));
}

double crown_sheet(double share, double z, double radius, double blur) {
  const double t = share * SPLATTER_LIFE, rim = crown_rim(t);
  const double width = 0.28 + 0.25 * share;  // the ring blurs as it breaks into beads
  const double there =
      std::clamp((rim - z) / blur + 0.5, 0.0, 1.0) * (1.0 + 1.5 * std::exp(-std::abs(rim - z) / 0.3));
  const double d = (radius - crown_radius(t, z)) / width;
  return there * std::exp(-d * d);
}

double crown_left(double share) {
  return 1.0 - std::clamp((share - 0.7) / 0.3, 0.0, 1.0);
}

std::vector<float> make_crowns() {
  std::vector<float> table(std::size_t{SPLATTER_SHELLS} * SPLATTER_AGES * SPLATTER_RADII, 0.0f);
  const auto at = [](int layer, int age, int radius) {
    return (std::size_t(layer) * SPLATTER_AGES + std::size_t(age)) * SPLATTER_RADII + std::size_t(radius);
  };
  const double layer_d = double(SPLATTER_HEIGHT) / SPLATTER_SHELLS,
               step_r = double(SPLATTER_REACH) / (SPLATTER_RADII - 1);
  constexpr int substeps = 8;
  std::vector<double> now(std::size_t{SPLATTER_SHELLS} * SPLATTER_RADII);
  for (int age = 1; age < SPLATTER_AGES; ++age) {
    for (int sub = 0; sub < substeps; ++sub) {
      const double share = (age - 1 + (sub + 0.5) / substeps) / (SPLATTER_AGES - 1);
      double sum = 0.0;
      for (int layer = 0; layer < SPLATTER_SHELLS; ++layer) {
        const double z = (layer + 0.5) * layer_d;
        for (int r = 0; r < SPLATTER_RADII; ++r) {
          const double a = crown_sheet(share, z, r * step_r, layer_d);
          now[std::size_t(layer) * SPLATTER_RADII + std::size_t(r)] = a;
          sum += a * 2.0 * pi * r * step_r * step_r * layer_d;
        }
      }
      const double scale = sum > 1e-9 ? 0.25 * pi * crown_left(share) / sum : 0.0;
      for (int layer = 0; layer < SPLATTER_SHELLS; ++layer)
        for (int r = 0; r < SPLATTER_RADII; ++r) {
          float& cell = table[at(layer, age, r)];
          if (sub == 0) cell = table[at(layer, age - 1, r)];
          cell += static_cast<float>(scale * now[std::size_t(layer) * SPLATTER_RADII + std::size_t(r)] /
                                     (substeps * (SPLATTER_AGES - 1)));
        }
    }
  }
  return table;
}

std::vector<std::uint8_t> make_mist_texture() {
  constexpr int side = mist_texels;
  std::vector<std::uint8_t> bytes(std::size_t{side} * side * 2);
  for (int channel = 0; channel < 2; ++channel) {
    std::vector<double> sum(std::size_t{side} * side, 0.0);
    RandomStream random(0x5a1a7, static_cast<std::uint32_t>(channel));
    for (int i = 0; i < 2600; ++i) {
      // Droplets near and less near the fin, drawn out along their way.
      const double size = 1.0 * std::pow(3.5, double(random.uniform())), tall = size * (1.6 + 1.4 * random.uniform());
      const double x0 = random.uniform() * side, y0 = random.uniform() * side, strength = 1.0 / (size * tall);
      const int reach_x = int(3.0 * size) + 1, reach_y = int(3.0 * tall) + 1;
      for (int y = -reach_y; y <= reach_y; ++y)
        for (int x = -reach_x; x <= reach_x; ++x) {
          const int px = int(x0) + x, py = int(y0) + y;
          const double dx = (px + 0.5 - x0) / size, dy = (py + 0.5 - y0) / tall;
          sum[std::size_t((py % side + side) % side) * side + std::size_t((px % side + side) % side)] +=
              strength * std::exp(-0.5 * (dx * dx + dy * dy));
        }
    }
    double mean = 0.0, square = 0.0;
    for (const double v : sum) mean += v / double(sum.size());
    for (const double v : sum) square += (v - mean) * (v - mean) / double(sum.size());
    for (std::size_t i = 0; i < sum.size(); ++i) {
      const double v = 0.5 + mist_deviation * (sum[i] - mean) / std::sqrt(square);
      bytes[2 * i + std::size_t(channel)] = static_cast<std::uint8_t>(std::clamp(std::lround(255.0 * v), 0l, 255l));
    }
  }
  return bytes;
}

}  // namespace petrichor
