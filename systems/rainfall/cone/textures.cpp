#include "systems/rainfall/cone/textures.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "engine/core/random.hpp"
#include "systems/drops/drop_physics.hpp"
#include "systems/rainfall/snow/flakes.hpp"

namespace petrichor {
namespace {

constexpr int size = cone_texture_size;
constexpr int most_streaks = 40000;  // a tile: smaller drops than these many become its even floor

// Marshall and Palmer's sizes at one rate, by the slope that gives the rate back (physics 1).
template <int rate_times_ten>
double rain_density(double mm) {
  static const double slope = 4.25 * std::pow(0.1 * rate_times_ten, -0.215);
  return std::exp(-slope * mm);
}
ConeParticle drop(double mm) {
  return {mm, 0.7853981634 * mm * mm, terminal_speed_mps(mm)};
}

template <int rate_times_ten>
double snow_density(double mm) {
  static const FlakeSizeDistribution sizes = solve_flake_sizes(0.1 * rate_times_ten);
  return density(sizes, mm);
}
ConeParticle flake(double mm) {
  const double diameter = diameter_of_melted_mm(mm), area = flake_area_mm2(diameter);
  return {2.0 * std::sqrt(area / M_PI), area, flake_speed_mps(diameter)};  // an opaque disc of that area
}

struct Streak {
  double u, v, width, length, mass;  // texels; mass: sum of opacities, in texels
  int channel;                       // the first that shows it
};

// Adds a streak, soft over a texel at every edge. Never over the seam of u: tiles side by side are moved along v.
void draw(std::vector<float>& tile, const Streak& s) {
  const double width = std::max(s.width, 1.0), length = std::max(s.length, 1.0);
  const double half = 0.5 * width, u = std::clamp(s.u, half + 1.0, size - half - 1.0);
  const int first = static_cast<int>(std::floor(u - half)), last = static_cast<int>(std::ceil(u + half));
  const int low = static_cast<int>(std::floor(s.v)), high = static_cast<int>(std::ceil(s.v + length));
  double across[96], sum = 0.0;
  const int columns = std::min(last - first, 96);
  for (int i = 0; i < columns; ++i) {
    const double a = std::max<double>(first + i, u - half), b = std::min<double>(first + i + 1, u + half);
    const double x = (0.5 * (a + b) - u) / half;
    across[i] = std::max(b - a, 0.0) * (s.width > 2.0 ? std::sqrt(std::max(1.0 - x * x, 0.0)) : 1.0);
    sum += across[i];
  }
  if (!(sum > 0.0)) return;
  for (int j = low; j < high; ++j) {
    const double a = std::max<double>(j, s.v), b = std::min<double>(j + 1, s.v + length);
    const double share = s.mass * std::max(b - a, 0.0) / (length * sum);
    float* row = tile.data() + (std::size_t((j % size + size) % size) * size) * cone_channels + s.channel;
    for (int i = 0; i < columns; ++i)
      row[std::size_t(first + i) * cone_channels] += static_cast<float>(share * across[i]);
  }
}

// A roundish blob, longer than wide by what it moves, for wide particles.
void draw_flake(std::vector<float>& tile, const Streak& s, double ragged) {
  const double half = 0.5 * std::max(s.width, 1.5), travel = 0.5 * std::max(s.length - s.width, 0.0);
  const double reach = std::min(half * 1.3 + 1.0, 0.45 * size);
  const double u = std::clamp(s.u, reach + 1.0, size - reach - 1.0);
  const int columns = static_cast<int>(2.0 * reach) + 1, rows = static_cast<int>(2.0 * (reach + travel)) + 1;
  std::vector<float> shape(std::size_t(columns) * rows);
  const double left = std::floor(u - reach), bottom = std::floor(s.v - reach - travel);
  double sum = 0.0;
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) {
      const double x = left + i + 0.5 - u, y0 = bottom + j + 0.5 - s.v;
      const double y = y0 - std::clamp(y0, -travel, travel);
      const double angle = std::atan2(y, x);
      const double edge =
          half * (1.0 + 0.25 * std::sin(3.0 * angle + ragged) + 0.15 * std::sin(5.0 * angle + 3.7 * ragged));
      const double inside = std::clamp((edge - std::hypot(x, y)) / (0.4 * half + 0.5) + 0.5, 0.0, 1.0);
      shape[std::size_t(j) * columns + i] = static_cast<float>(inside);
      sum += inside;
    }
  if (!(sum > 0.0)) return;
  for (int j = 0; j < rows; ++j) {
    const int y = (static_cast<int>(bottom) + j) % size;
    float* row = tile.data() + (std::size_t(y < 0 ? y + size : y) * size) * cone_channels + s.channel;
    for (int i = 0; i < columns; ++i) {
      const int x = static_cast<int>(left) + i;
      if (x >= 0 && x < size)
        row[std::size_t(x) * cone_channels] += static_cast<float>(s.mass / sum * shape[std::size_t(j) * columns + i]);
    }
  }
}

// 8 bits with the rounding left to chance, so that no mean is lost.
std::uint8_t rounded(float value, std::uint32_t bits) {
  return static_cast<std::uint8_t>(std::clamp(std::floor(value + unit_float(bits)), 0.0f, 255.0f));
}

std::array<float, cone_channels> mean_of(const std::vector<std::uint8_t>& texels) {
  std::array<double, cone_channels> sum{};
  for (std::size_t i = 0; i < texels.size(); ++i) sum[i % cone_channels] += texels[i];
  std::array<float, cone_channels> mean{};
  for (int c = 0; c < cone_channels; ++c)
    mean[c] = static_cast<float>(sum[c] / (static_cast<double>(texels.size()) / cone_channels));
  return mean;
}

// Quantiles of the sizes' distribution, by a table.
struct Sizes {
  static constexpr int steps = 2000;
  std::array<double, steps + 1> below{}, area_above{};  // share of number below; of extinction above
  double from, to;

  explicit Sizes(const ConeParticles& p) : from(p.smallest_mm), to(p.largest_mm) {
    for (int i = 0; i < steps; ++i) below[i + 1] = below[i] + p.density(at(i + 0.5));
    for (int i = steps; i-- > 0;) {
      area_above[i] = area_above[i + 1] + p.density(at(i + 0.5)) * p.particle(at(i + 0.5)).area_mm2;
    }
    for (double& b : below) b /= below[steps];
    const double all = area_above[0];
    for (double& a : area_above) a /= all;
  }
  double at(double step) const { return from + (to - from) * step / steps; }
  double quantile(double q) const {
    const auto found = std::upper_bound(below.begin(), below.end(), q);
    const int i = std::clamp(static_cast<int>(found - below.begin()), 1, steps);
    const double width = below[i] - below[i - 1];
    return at(i - 1 + (width > 0.0 ? (q - below[i - 1]) / width : 0.0));
  }
  double area_above_quantile(double q) const {
    const auto found = std::upper_bound(below.begin(), below.end(), q);
    return area_above[std::clamp(static_cast<int>(found - below.begin()) - 1, 0, steps)];
  }
};

ConeTile make_tile(const ConeParticles& particles, const Sizes& sizes, int layer, std::uint32_t seed) {
  const ConeLayer& l = cone_layout(particles.flakes)[layer];
  const double texel_rad = 2.0 * M_PI / (l.tiles_around * size), texel_m = l.tile_m / size;
  // Drops in the part of the shell that the tile stands for, at the cone's widest.
  const double shell = (std::pow(l.to_m, 3) - std::pow(l.from_m, 3)) / 3.0;
  const double volume = shell * texel_rad * size * l.tile_m / l.radius_m;
  const double expected = particles.full_per_m3 * volume;
  const double drawn_share = std::min(1.0, most_streaks / expected);
  const auto count = static_cast<std::uint32_t>(expected * drawn_share + 0.5);

  std::vector<float> tile(std::size_t(size) * size * cone_channels, 0.0f);
  RandomStream random(seed, 0x0c0e + 16u * layer);
  double drawn_mass = 0.0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double mm = sizes.quantile(1.0 - drawn_share * (1.0 - random.uniform()));
    const ConeParticle p = particles.particle(mm);
    const double u = random.uniform() * size, v = random.uniform() * size;
    const double cube = random.uniform();
    const double away = std::cbrt(std::pow(l.from_m, 3) + cube * (std::pow(l.to_m, 3) - std::pow(l.from_m, 3)));
    const double scale = l.radius_m / away;  // metres at the cone
    Streak s{u, v, 0.0, 0.0, 0.0, 0};
    s.width = 1e-3 * p.width_mm / away / texel_rad;
    s.length = (1e-3 * p.width_mm + p.speed_mps * cone_texture_exposure_s) * scale / texel_m;
    s.mass = 1e-6 * p.area_mm2 / (away * away) / (texel_rad * texel_m / l.radius_m);
    // Its mark: the first channel holds those below 1/64, and so on.
    const float mark = random.uniform();
    while (s.channel < cone_channels - 1 && mark >= std::pow(4.0f, float(s.channel - cone_channels + 1))) ++s.channel;
    drawn_mass += s.mass;
    const float ragged = 6.2831853f * random.uniform();
    if (particles.flakes)
      draw_flake(tile, s, ragged);
    else
      draw(tile, s);
  }
  // Of the smaller ones the mean alone, in every channel in proportion.
  const double above = sizes.area_above_quantile(1.0 - drawn_share);
  const double floor_mass = above > 0.0 ? drawn_mass * (1.0 - above) / above / (double(size) * size) : 0.0;
  for (std::size_t i = 0; i < tile.size(); i += cone_channels) {
    for (int c = 1; c < cone_channels; ++c) tile[i + c] += tile[i + c - 1];
    for (int c = 0; c < cone_channels; ++c)
      tile[i + c] += static_cast<float>(floor_mass * std::pow(4.0, c - cone_channels + 1));
  }

  ConeTile made;
  // The brightest share of a thousandth may saturate; 8 bits must still hold the mean.
  std::array<float, cone_channels> unit{};
  for (int c = 0; c < cone_channels; ++c) {
    std::vector<float> values;
    double sum = 0.0;
    for (std::size_t i = c; i < tile.size(); i += cone_channels) {
      sum += tile[i];
      if (tile[i] > 0.0f) values.push_back(tile[i]);
    }
    if (values.empty()) continue;
    const auto nth = values.begin() + static_cast<std::ptrdiff_t>(0.998 * static_cast<double>(values.size()));
    std::nth_element(values.begin(), nth, values.end());
    const auto mean = static_cast<float>(sum / (double(size) * size));
    unit[c] = 255.0f / std::clamp(*nth, 2.0f * mean, 150.0f * mean);
  }
  std::vector<float> now = tile;
  for (std::size_t i = 0; i < now.size(); ++i) now[i] = std::min(now[i] * unit[i % cone_channels], 255.0f);
  for (int level = 0, side = size; level < cone_texture_levels; ++level, side /= 2) {
    std::vector<std::uint8_t> bytes(now.size());
    for (std::size_t i = 0; i < now.size(); ++i) {
      const float whole = now[i];
      bytes[i] = whole > 0.0f ? rounded(whole, random.bits()) : std::uint8_t{0};
    }
    made.mean.push_back(mean_of(bytes));
    made.levels.push_back(std::move(bytes));
    if (level + 1 == cone_texture_levels) break;
    std::vector<float> next(now.size() / 4);
    for (int y = 0; y < side / 2; ++y)
      for (int x = 0; x < side / 2; ++x)
        for (int c = 0; c < cone_channels; ++c) {
          const auto at = [&](int i, int j) { return now[(std::size_t(j) * side + i) * cone_channels + c]; };
          next[(std::size_t(y) * (side / 2) + x) * cone_channels + c] =
              0.25f * (at(2 * x, 2 * y) + at(2 * x + 1, 2 * y) + at(2 * x, 2 * y + 1) + at(2 * x + 1, 2 * y + 1));
        }
    now = std::move(next);
  }
  return made;
}

}  // namespace

const std::array<ConeLayer, cone_layers>& cone_layout(bool flakes) {
  const auto make = [](const std::array<double, cone_layers>& along_rad) {
    std::array<ConeLayer, cone_layers> l{};
    // Across, texels of a picture 1920 pixels wide.
    const int around[] = {11, 13, 12, 14};
    for (int i = 0; i < cone_layers; ++i) {
      const double a = cone_edges_m[i], b = cone_edges_m[i + 1];
      const double radius = (b - a) / std::log(b / a);
      l[i] = {a, b, radius, around[i], along_rad[i] * size * radius};
    }
    return l;
  };
  // Rain's tiles are so long that it takes more than two frames of 5 a second to pass one: no wagon wheel (physics 13).
  static const auto rain = make({5.0e-3, 2.4e-3, 1.2e-3, 1.0e-3}), snow = make({1.2e-3, 1.0e-3, 1.0e-3, 1.0e-3});
  return flakes ? snow : rain;
}

const ConeParticles& cone_particles(ConeTexture texture) {
  static const ConeParticles drizzle{0.5, 6.0, rain_density<15>, drop, 4096.0, false},
      rain{0.5, 6.0, rain_density<200>, drop, 4096.0, false},
      fine{melted_mm(smallest_flake_mm), melted_mm(largest_flake_mm), snow_density<5>, flake, 2048.0, true},
      coarse{melted_mm(smallest_flake_mm), melted_mm(largest_flake_mm), snow_density<30>, flake, 2048.0, true};
  switch (texture) {
    case ConeTexture::drizzle:
      return drizzle;
    case ConeTexture::snow_fine:
      return fine;
    case ConeTexture::snow_coarse:
      return coarse;
    default:
      return rain;
  }
}

ConeMeans cone_means(ConeTexture texture) {
  const ConeParticles& p = cone_particles(texture);
  double area = 0.0;
  ConeMeans means{0.0, 0.0};
  for (int i = 0; i < 500; ++i) {
    const double mm = p.smallest_mm + (p.largest_mm - p.smallest_mm) * (i + 0.5) / 500.0;
    const ConeParticle one = p.particle(mm);
    const double weight = p.density(mm) * one.area_mm2;
    area += weight;
    means.speed_mps += weight * one.speed_mps;
    means.width_m += weight * 1e-3 * one.width_mm;
  }
  means.speed_mps /= area;
  means.width_m /= area;
  return means;
}

ConeTextureSet make_cone_textures(ConeTexture texture, std::uint32_t seed) {
  const ConeParticles& particles = cone_particles(texture);
  const Sizes sizes(particles);
  ConeTextureSet set;
  set.full_per_m3 = particles.full_per_m3;
  for (int i = 0; i < cone_layers; ++i)
    set.tiles[i] = make_tile(particles, sizes, i, seed + 0x9e37u * static_cast<std::uint32_t>(texture));
  return set;
}

std::shared_future<ConeTextureSet> shared_cone_textures(ConeTexture texture) {
  static std::mutex mutex;
  static std::array<std::shared_future<ConeTextureSet>, 5> made;
  const std::lock_guard lock(mutex);
  auto& one = made[static_cast<std::size_t>(texture)];
  if (!one.valid()) one = std::async(std::launch::async, [texture] { return make_cone_textures(texture); }).share();
  return one;
}

}  // namespace petrichor
