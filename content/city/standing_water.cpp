#include "content/city/standing_water.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

#include "content/city/dice.hpp"
#include "content/city/plan.hpp"
#include "content/city/scene.hpp"

namespace petrichor::city {
namespace {

struct Hollow {
  glm::vec2 centre_m, radius_m;
  float depth_m;
};

// Settled places: a few chosen for the pictures, the rest by chance.
const std::vector<Hollow>& hollows() {
  static const std::vector<Hollow> list = [] {
    std::vector<Hollow> out{{{2.6f, -1.2f}, {1.9f, 1.3f}, 0.030f},  {{-1.9f, 3.6f}, {1.5f, 2.0f}, 0.026f},
                            {{3.9f, -9.5f}, {0.9f, 2.6f}, 0.032f},  {{-2.2f, 12.0f}, {0.9f, 2.4f}, 0.024f},
                            {{0.8f, 8.6f}, {1.0f, 1.5f}, 0.018f},   {{3.6f, 18.5f}, {1.2f, 2.8f}, 0.028f},
                            {{-0.9f, -8.0f}, {1.1f, 2.2f}, 0.022f}, {{2.2f, -17.0f}, {0.9f, 3.1f}, 0.024f},
                            {{14.0f, 0.9f}, {2.1f, 1.0f}, 0.026f},  {{-13.0f, -1.1f}, {2.4f, 0.9f}, 0.024f},
                            {{7.2f, 1.6f}, {1.4f, 0.9f}, 0.022f},   {{0.5f, 17.2f}, {1.5f, 1.9f}, 0.026f}};
    Dice dice{4242};
    for (int k = 0; k < 34; ++k) {
      const float z = dice.between(-58.0f, 58.0f);
      const Hollow hollow{{dice.between(-4.6f, 4.6f), z},
                          {dice.between(0.5f, 1.3f), dice.between(0.7f, 2.4f)},
                          dice.between(0.010f, 0.026f)};
      if (std::abs(hollow.centre_m.x) > 2.5f || z < 18.0f || z > 26.0f)
        out.push_back(hollow);  // not underfoot of view_crossing
    }
    for (int k = 0; k < 24; ++k) {
      const float x = dice.between(8.0f, 58.0f) * (dice.chance(0.5f) ? 1.0f : -1.0f);
      out.push_back({{x, dice.between(-3.6f, 3.6f)},
                     {dice.between(0.6f, 1.8f), dice.between(0.4f, 1.1f)},
                     dice.between(0.010f, 0.024f)});
    }
    return out;
  }();
  return list;
}

float bell(float x, float centre, float width) {
  const float d = (x - centre) / width;
  return std::exp(-d * d);
}

float value_noise(float x, float z, float cell_m, std::uint32_t seed) {
  const float fx = std::floor(x / cell_m);
  const float fz = std::floor(z / cell_m);
  const auto at = [&](float i, float j) {
    return unit(mix(seed, static_cast<std::uint32_t>(static_cast<int>(i) + 4096),
                    static_cast<std::uint32_t>(static_cast<int>(j) + 4096)));
  };
  const auto ease = [](float t) { return t * t * (3.0f - 2.0f * t); };
  const float u = ease(x / cell_m - fx);
  const float v = ease(z / cell_m - fz);
  const float low = at(fx, fz) * (1 - u) + at(fx + 1, fz) * u;
  const float high = at(fx, fz + 1) * (1 - u) + at(fx + 1, fz + 1) * u;
  return low * (1 - v) + high * v - 0.5f;
}

bool on_carriageway(float x, float z) {
  const float ax = std::abs(x);
  const float az = std::abs(z);
  if (ax > street_end_m || az > street_end_m) return false;
  if (ax < main_half_m || az < lane_half_m) return true;
  // The rounded kerbs of the four corners.
  const float dx = main_half_m + kerb_radius_m - ax;
  const float dz = lane_half_m + kerb_radius_m - az;
  return dx > 0.0f && dz > 0.0f && dx * dx + dz * dz > kerb_radius_m * kerb_radius_m;
}

}  // namespace

float carriageway_height_m(float x, float z) {
  const float ax = std::abs(x);
  const float az = std::abs(z);
  const float main_crown = 0.085f * std::max(0.0f, 1.0f - (x * x) / (main_half_m * main_half_m));
  const float lane_crown = 0.070f * std::max(0.0f, 1.0f - (z * z) / (lane_half_m * lane_half_m));
  float h = std::max(main_crown, lane_crown) + 0.3f * std::min(main_crown, lane_crown);
  // Tyre tracks: 1.5 m apart in each lane, deepest where buses brake before the crossing.
  const float braking = 1.0f + 0.8f * bell(az, 10.0f, 6.0f);
  if (az > lane_half_m) h -= 0.010f * braking * (bell(ax, 0.75f, 0.3f) + bell(ax, 2.25f, 0.3f));
  if (ax > main_half_m) h -= 0.008f * (bell(az, 0.9f, 0.28f) + bell(az, 2.4f, 0.28f));
  h += 0.020f * value_noise(x, z, 6.3f, 1) + 0.010f * value_noise(x, z, 2.1f, 2) + 0.004f * value_noise(x, z, 0.8f, 3);
  for (const Hollow& hollow : hollows()) {
    const glm::vec2 d = (glm::vec2(x, z) - hollow.centre_m) / hollow.radius_m;
    const float r2 = glm::dot(d, d);
    if (r2 < 4.0f) h -= hollow.depth_m * std::exp(-1.6f * r2);
  }
  return h;
}

StandingWater flood_streets() {
  StandingWater w;
  const int n = static_cast<int>(2.0f * street_end_m / water_cell_m);
  w.size = n;
  const auto at = [n](int i, int j) {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(n) + static_cast<std::size_t>(i);
  };
  const auto centre = [](int i) { return -street_end_m + (static_cast<float>(i) + 0.5f) * water_cell_m; };
  const float nowhere = std::numeric_limits<float>::infinity();
  w.ground_m.assign(static_cast<std::size_t>(n) * static_cast<std::size_t>(n), nowhere);
  for (int j = 0; j < n; ++j) {
    for (int i = 0; i < n; ++i) {
      if (on_carriageway(centre(i), centre(j))) w.ground_m[at(i, j)] = carriageway_height_m(centre(i), centre(j));
    }
  }
  w.level_m = w.ground_m;
  for (float s : {-1.0f, 1.0f}) {
    for (float z : {-52.0f, -31.0f, -12.0f, 13.0f, 30.0f, 51.0f}) w.gullies.emplace_back(s * (main_half_m - 0.3f), z);
    for (float x : {-46.0f, -22.0f, 22.0f, 46.0f}) w.gullies.emplace_back(x, s * (lane_half_m - 0.3f));
  }

  // Priority-Flood (Barnes, Lehman, Mulla 2014, algorithm 1). `downhill`: where a cell's water goes.
  using Entry = std::pair<float, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  std::vector<char> closed(w.ground_m.size(), 0);
  std::vector<std::size_t> downhill(w.ground_m.size()), order;
  const auto outlet = [&](int i, int j) {
    const std::size_t k = at(i, j);
    if (closed[k] || w.ground_m[k] == nowhere) return;
    closed[k] = 1;
    downhill[k] = k;
    open.emplace(w.ground_m[k], k);
  };
  for (const glm::vec2& g : w.gullies) {
    outlet(static_cast<int>((g.x + street_end_m) / water_cell_m),
           static_cast<int>((g.y + street_end_m) / water_cell_m));
  }
  for (int k = 0; k < n; ++k) {
    outlet(k, 0);
    outlet(k, n - 1);
    outlet(0, k);
    outlet(n - 1, k);
  }
  const auto each_neighbour = [&](std::size_t k, auto&& visit) {
    const int i = static_cast<int>(k % static_cast<std::size_t>(n));
    const int j = static_cast<int>(k / static_cast<std::size_t>(n));
    for (int b = std::max(j - 1, 0); b <= std::min(j + 1, n - 1); ++b) {
      for (int a = std::max(i - 1, 0); a <= std::min(i + 1, n - 1); ++a) {
        if ((a != i || b != j) && w.ground_m[at(a, b)] != nowhere) visit(at(a, b));
      }
    }
  };
  while (!open.empty()) {
    const auto [level, k] = open.top();
    open.pop();
    order.push_back(k);
    each_neighbour(k, [&, level = level, k = k](std::size_t m) {
      if (closed[m]) return;
      closed[m] = 1;
      downhill[m] = k;
      w.level_m[m] = std::max(w.ground_m[m], level);
      open.emplace(w.level_m[m], m);
    });
  }

  // Basins: connected cells that lie below one brim.
  constexpr int none = -1;
  std::vector<int> basin_of(w.ground_m.size(), none);
  const auto holds = [&](std::size_t k) { return w.ground_m[k] != nowhere && w.level_m[k] - w.ground_m[k] > 1e-3f; };
  const float cell_m2 = water_cell_m * water_cell_m;
  std::vector<Basin> basins;
  for (std::size_t start = 0; start < basin_of.size(); ++start) {
    if (basin_of[start] != none || !holds(start)) continue;
    const int number = static_cast<int>(basins.size());
    Basin basin{glm::vec2(1e9f), glm::vec2(-1e9f)};
    basin.level_m = w.level_m[start];
    std::vector<std::size_t> stack{start};
    basin_of[start] = number;
    while (!stack.empty()) {
      const std::size_t k = stack.back();
      stack.pop_back();
      const float depth = w.level_m[k] - w.ground_m[k];
      basin.maximum_depth_m = std::max(basin.maximum_depth_m, depth);
      basin.volume_m3 += cell_m2 * depth;
      basin.area_m2 += cell_m2;
      const glm::vec2 c(centre(static_cast<int>(k % static_cast<std::size_t>(n))),
                        centre(static_cast<int>(k / static_cast<std::size_t>(n))));
      basin.minimum_m = glm::min(basin.minimum_m, c - water_cell_m);
      basin.maximum_m = glm::max(basin.maximum_m, c + water_cell_m);
      each_neighbour(k, [&](std::size_t m) {
        if (basin_of[m] != none || !holds(m) || std::abs(w.level_m[m] - basin.level_m) > 1e-4f) return;
        basin_of[m] = number;
        stack.push_back(m);
      });
    }
    basins.push_back(basin);
  }
  // What falls on a cell runs downhill into the first basin on its way: cells in reverse order of the flood.
  std::vector<float> runoff_m2(w.ground_m.size(), cell_m2);
  for (auto k = order.rbegin(); k != order.rend(); ++k) {
    if (basin_of[*k] != none)
      basins[static_cast<std::size_t>(basin_of[*k])].catchment_m2 += runoff_m2[*k];
    else if (downhill[*k] != *k)
      runoff_m2[downhill[*k]] += runoff_m2[*k];
  }

  // How far each place lies below its brim. Round about a basin the same level goes on, under the ground, so that the
  // shore is where the two meet; where the ground falls again beyond the sill it counts as dry.
  w.depth_m.assign(w.ground_m.size(), no_puddle_m);
  std::vector<std::size_t> ring;
  std::vector<float> brim(w.ground_m.size());
  const auto worth_it = [](const Basin& b) { return b.area_m2 > 0.5f && b.maximum_depth_m > 0.004f; };
  for (std::size_t k = 0; k < basin_of.size(); ++k) {
    if (basin_of[k] == none || !worth_it(basins[static_cast<std::size_t>(basin_of[k])])) continue;
    brim[k] = w.level_m[k];
    w.depth_m[k] = brim[k] - w.ground_m[k];
    ring.push_back(k);
  }
  for (int step = 1; step <= 4; ++step) {
    std::vector<std::size_t> next;
    for (std::size_t k : ring) {
      each_neighbour(k, [&](std::size_t m) {
        if (w.depth_m[m] != no_puddle_m) return;
        brim[m] = brim[k];
        w.depth_m[m] = std::max(std::min(brim[m] - w.ground_m[m], -0.001f * static_cast<float>(step)), no_puddle_m);
        next.push_back(m);
      });
    }
    ring = std::move(next);
  }
  for (const Basin& basin : basins) {
    if (worth_it(basin)) w.basins.push_back(basin);
  }
  std::stable_sort(w.basins.begin(), w.basins.end(),
                   [](const Basin& a, const Basin& b) { return a.area_m2 > b.area_m2; });
  return w;
}

float StandingWater::depth_at(float x, float z) const {
  const float fx = (x + street_end_m) / water_cell_m - 0.5f;
  const float fz = (z + street_end_m) / water_cell_m - 0.5f;
  const int i = static_cast<int>(std::floor(fx));
  const int j = static_cast<int>(std::floor(fz));
  float depth = 0.0f, all = 0.0f;
  for (int b = 0; b < 2; ++b) {
    for (int a = 0; a < 2; ++a) {
      const int ci = std::clamp(i + a, 0, size - 1);
      const int cj = std::clamp(j + b, 0, size - 1);
      const std::size_t k =
          static_cast<std::size_t>(cj) * static_cast<std::size_t>(size) + static_cast<std::size_t>(ci);
      if (!std::isfinite(ground_m[k])) continue;
      const float wx = a ? fx - static_cast<float>(i) : 1.0f - (fx - static_cast<float>(i));
      const float wz = b ? fz - static_cast<float>(j) : 1.0f - (fz - static_cast<float>(j));
      depth += wx * wz * depth_m[k];
      all += wx * wz;
    }
  }
  return all > 0.0f ? depth / all : no_puddle_m;
}

}  // namespace petrichor::city
