#include "content/city/standing_water.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

#include "content/city/dice.hpp"
#include "content/city/plan.hpp"

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

  using Entry = std::pair<float, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  std::vector<char> closed(w.ground_m.size(), 0);
  const auto outlet = [&](int i, int j) {
    const std::size_t k = at(i, j);
    if (closed[k] || w.ground_m[k] == nowhere) return;
    closed[k] = 1;
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
  const std::array<glm::ivec2, 8> around{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};
  const auto inside = [n](int i, int j) { return i >= 0 && j >= 0 && i < n && j < n; };
  while (!open.empty()) {
    const auto [level, k] = open.top();
    open.pop();
    const int i = static_cast<int>(k % static_cast<std::size_t>(n));
    const int j = static_cast<int>(k / static_cast<std::size_t>(n));
    for (const glm::ivec2& d : around) {
      if (!inside(i + d.x, j + d.y)) continue;
      const std::size_t m = at(i + d.x, j + d.y);
      if (closed[m] || w.ground_m[m] == nowhere) continue;
      closed[m] = 1;
      w.level_m[m] = std::max(w.ground_m[m], level);
      open.emplace(w.level_m[m], m);
    }
  }

  // Basins: connected cells that stand at least 3 mm under water.
  std::vector<char> seen(w.ground_m.size(), 0);
  const auto stands = [&](std::size_t k) { return w.ground_m[k] != nowhere && w.level_m[k] - w.ground_m[k] > 0.003f; };
  for (std::size_t start = 0; start < seen.size(); ++start) {
    if (seen[start] || !stands(start)) continue;
    Basin basin;
    basin.level_m = w.level_m[start];
    std::vector<std::size_t> stack{start};
    std::vector<std::size_t> cells;
    seen[start] = 1;
    while (!stack.empty()) {
      const std::size_t k = stack.back();
      stack.pop_back();
      const int i = static_cast<int>(k % static_cast<std::size_t>(n));
      const int j = static_cast<int>(k / static_cast<std::size_t>(n));
      cells.push_back(k);
      basin.maximum_depth_m = std::max(basin.maximum_depth_m, w.level_m[k] - w.ground_m[k]);
      for (const glm::ivec2& d : around) {
        if (!inside(i + d.x, j + d.y)) continue;
        const std::size_t m = at(i + d.x, j + d.y);
        if (seen[m] || !stands(m) || std::abs(w.level_m[m] - basin.level_m) > 1e-4f) continue;
        seen[m] = 1;
        stack.push_back(m);
      }
    }
    // Some of it has soaked away: the sheet lies below the spill.
    const float lowered = 0.35f * basin.maximum_depth_m;
    basin = {glm::vec2(1e9f), glm::vec2(-1e9f), basin.maximum_depth_m - lowered, 0.0f, basin.level_m - lowered};
    for (std::size_t k : cells) {
      w.level_m[k] = std::max(w.ground_m[k], basin.level_m);
      if (!stands(k)) continue;
      const glm::vec2 c(centre(static_cast<int>(k % static_cast<std::size_t>(n))),
                        centre(static_cast<int>(k / static_cast<std::size_t>(n))));
      basin.minimum_m = glm::min(basin.minimum_m, c - 0.5f * water_cell_m);
      basin.maximum_m = glm::max(basin.maximum_m, c + 0.5f * water_cell_m);
      basin.area_m2 += water_cell_m * water_cell_m;
    }
    if (basin.area_m2 > 0.3f) w.basins.push_back(basin);
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
  float depth = 0.0f;
  for (int b = 0; b < 2; ++b) {
    for (int a = 0; a < 2; ++a) {
      const int ci = std::clamp(i + a, 0, size - 1);
      const int cj = std::clamp(j + b, 0, size - 1);
      const std::size_t k =
          static_cast<std::size_t>(cj) * static_cast<std::size_t>(size) + static_cast<std::size_t>(ci);
      if (!std::isfinite(ground_m[k])) continue;
      const float wx = a ? fx - static_cast<float>(i) : 1.0f - (fx - static_cast<float>(i));
      const float wz = b ? fz - static_cast<float>(j) : 1.0f - (fz - static_cast<float>(j));
      depth += wx * wz * (level_m[k] - ground_m[k]);
    }
  }
  return depth;
}

}  // namespace petrichor::city
