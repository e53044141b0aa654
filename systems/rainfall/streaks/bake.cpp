#include "systems/rainfall/streaks/bake.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <numbers>
#include <thread>

#include "systems/drops/drop_optics.hpp"
#include "systems/drops/drop_physics.hpp"
#include "systems/rainfall/streaks/drop_tracer.hpp"

namespace petrichor {
namespace {

constexpr double pi = std::numbers::pi;

double radians(double degrees) {
  return degrees * pi / 180.0;
}

struct Tent {  // a place between two nodes
  int low;
  double share;  // of low + 1
};
Tent tent_of(double value, double lowest, double highest, int nodes) {
  const double at = std::clamp((value - lowest) / (highest - lowest), 0.0, 1.0) * (nodes - 1);
  const int low = std::min(static_cast<int>(at), nodes - 2);
  return {low, at - low};
}

// Places in the unit square that fill it evenly, however many are taken: the R2 sequence (Roberts 2018), by the powers
// of the inverse of the plastic number.
glm::dvec2 even_place(int i) {
  const double a = 0.5 + 0.7548776662466927 * (i + 1), b = 0.5 + 0.5698402909980532 * (i + 1);
  return {a - std::floor(a), b - std::floor(b)};
}

// Share of the disc's area within each bin across it.
std::vector<double> chord_shares(int bins) {
  const auto below = [](double h) { return 0.5 + (h * std::sqrt(1.0 - h * h) + std::asin(h)) / pi; };
  std::vector<double> shares(bins);
  for (int i = 0; i < bins; ++i) shares[i] = below(-1.0 + 2.0 * (i + 1) / bins) - below(-1.0 + 2.0 * i / bins);
  return shares;
}

}  // namespace

StreakBake fine_streak_bake() {
  StreakBake bake;
  bake.grid = {13, 19, 19};
  bake.along = 24;
  bake.oscillations = 12;
  bake.across = 16;
  bake.rays = 40000;
  return bake;
}

void for_each_task(int count, int threads, const std::function<void(int)>& task,
                   const std::function<void(double)>& progress) {
  std::atomic<int> next{0};
  std::mutex mutex;
  int done = 0;
  const auto work = [&] {
    for (int i = next++; i < count; i = next++) {
      task(i);
      const std::lock_guard lock(mutex);
      ++done;
      if (progress) progress(double(done) / count);
    }
  };
  std::vector<std::thread> others;
  for (int i = 1; i < threads; ++i) others.emplace_back(work);
  work();
  for (std::thread& t : others) t.join();
}

std::vector<ViewLight> trace_view(const StreakBake& bake, double view_elevation, std::span<const LampGrid> grids,
                                  int first, int last) {
  const std::size_t states = std::size_t(bake.oscillations) * bake.along;
  std::vector<ViewLight> result(grids.size());
  for (std::size_t g = 0; g < grids.size(); ++g) {
    const std::size_t nodes = std::size_t(grids[g].light) * grids[g].azimuth;
    result[g].power.assign(nodes * states, 0.0);
    result[g].across.assign(nodes * bake.across, 0.0);
    result[g].area.assign(states, 0.0);
    result[g].turns.assign(drop_phase_bins, 0.0);
  }
  const double c = std::cos(view_elevation), s = std::sin(view_elevation);
  const glm::dvec3 to_eye(c, s, 0.0), side(0.0, 0.0, 1.0), up(-s, c, 0.0);
  const double reach = std::min(1.05 + bake.drop.prolate + 2.1 * bake.drop.sideways, largest_radius);
  const double ray_area = reach * reach / bake.rays;  // over that of the disc
  // What lies lower in the picture meets a place of the streak earlier: samples along per radius.
  const double speed = terminal_speed_mps(bake.drop.diameter_mm);
  const double passing = bake.along * oscillation_frequency_hz(2, bake.drop.diameter_mm) * 0.5e-3 *
                         bake.drop.diameter_mm / (speed * std::max(c, 0.2));
  const Oscillation oscillation{bake.drop.prolate, bake.drop.sideways, radians(bake.drop.lean_deg)};
  for (int o = first; o < last; ++o) {
    for (int j = 0; j < bake.along; ++j) {
      const double phase2 = 2.0 * pi * j / bake.along;
      const DropShape shape =
          drop_shape(bake.drop.diameter_mm, oscillation, phase2, 2.0 * phase2 + 2.0 * pi * o / bake.oscillations);
      for (int i = 0; i < bake.rays; ++i) {
        const glm::dvec2 at = even_place(i);
        const double r = reach * std::sqrt(at.x), x = r * std::cos(2.0 * pi * at.y), y = r * std::sin(2.0 * pi * at.y);
        const DropPaths paths = trace_drop(shape, x * side + y * up + 4.0 * to_eye, -to_eye);
        if (paths.count == 0) continue;
        const double shift = std::clamp(-y * passing, -1.0, 1.0);
        const std::size_t here = std::size_t(o) * bake.along + j;
        const std::size_t beside = std::size_t(o) * bake.along + (j + (shift < 0.0 ? bake.along - 1 : 1)) % bake.along;
        const int bin = std::clamp(static_cast<int>(0.5 * (x + 1.0) * bake.across), 0, bake.across - 1);
        for (ViewLight& light : result) light.area[here] += ray_area;
        for (int p = 0; p < paths.count; ++p) {
          const glm::dvec3& l = paths.paths[p].direction;
          const double sine = std::sqrt(std::clamp(0.5 + 0.5 * glm::dot(l, to_eye), 0.0, 1.0));
          result.front().turns[std::min(static_cast<int>(sine * drop_phase_bins), drop_phase_bins - 1)] +=
              paths.paths[p].share * ray_area;
          if (l.z < 0.0) continue;  // the mirror image, of a drop that leans the other way
          const double elevation = std::asin(std::clamp(l.y, -1.0, 1.0)), azimuth = std::atan2(l.z, l.x);
          const double power = paths.paths[p].share * ray_area;
          for (std::size_t g = 0; g < grids.size(); ++g) {
            const LampGrid& grid = grids[g];
            const double lowest = radians(grid.lowest_deg);
            if (elevation < lowest) continue;
            const Tent e = tent_of(elevation, lowest, 0.5 * pi, grid.light),
                       a = tent_of(azimuth, 0.0, pi, grid.azimuth);
            for (int corner = 0; corner < 4; ++corner) {
              const int le = e.low + (corner >> 1), la = a.low + (corner & 1);
              const double weight =
                  power * (corner & 2 ? e.share : 1.0 - e.share) * (corner & 1 ? a.share : 1.0 - a.share);
              const std::size_t node = std::size_t(le) * grid.azimuth + la;
              result[g].power[node * states + here] += weight * (1.0 - std::abs(shift));
              result[g].power[node * states + beside] += weight * std::abs(shift);
              result[g].across[node * bake.across + bin] += weight;
            }
          }
        }
      }
    }
  }
  return result;
}

TentWeights tent_weights(double view_elevation, const LampGrid& grid, std::span<const float> phase) {
  TentWeights weights;
  weights.phase.assign(std::size_t(grid.light) * grid.azimuth, 0.0);
  weights.solid_angle = weights.phase;
  const double lowest = radians(grid.lowest_deg);
  // Midpoints, fine against the phase function's bins.
  const int rows = (grid.light - 1) * std::max(8, 360 / (grid.light - 1)),
            columns = (grid.azimuth - 1) * std::max(8, 360 / (grid.azimuth - 1));
  for (int i = 0; i < rows; ++i) {
    const double elevation = lowest + (0.5 * pi - lowest) * (i + 0.5) / rows;
    for (int j = 0; j < columns; ++j) {
      const double azimuth = pi * (j + 0.5) / columns;
      const double cosine = turn_cosine({view_elevation, elevation, azimuth});
      const double sine = std::sqrt(std::clamp(0.5 - 0.5 * cosine, 0.0, 1.0));
      const double p = phase[std::min(static_cast<int>(sine * drop_phase_bins), drop_phase_bins - 1)];
      const double solid = std::cos(elevation) * (0.5 * pi - lowest) / rows * pi / columns;
      const Tent e = tent_of(elevation, lowest, 0.5 * pi, grid.light), a = tent_of(azimuth, 0.0, pi, grid.azimuth);
      for (int corner = 0; corner < 4; ++corner) {
        const std::size_t node = std::size_t(e.low + (corner >> 1)) * grid.azimuth + a.low + (corner & 1);
        const double w = solid * (corner & 2 ? e.share : 1.0 - e.share) * (corner & 1 ? a.share : 1.0 - a.share);
        weights.phase[node] += w * p;
        weights.solid_angle[node] += w;
      }
    }
  }
  join_poles(weights.phase, grid, 1);
  join_poles(weights.solid_angle, grid, 1);
  return weights;
}

void join_poles(std::vector<double>& values, const LampGrid& grid, std::size_t width) {
  const auto join = [&](int light) {
    double* row = &values[std::size_t(light) * grid.azimuth * width];
    for (std::size_t k = 0; k < width; ++k) {
      double sum = 0.0;
      for (int a = 0; a < grid.azimuth; ++a) sum += row[a * width + k];
      for (int a = 0; a < grid.azimuth; ++a) row[a * width + k] = sum;
    }
  };
  join(grid.light - 1);
  if (grid.lowest_deg <= -90.0) join(0);
}

StreakTable bake_streaks(const StreakBake& bake, const std::function<void(double)>& progress) {
  StreakTable table;
  table.grid = bake.grid;
  table.drop = bake.drop;
  table.along = bake.along;
  table.oscillations = bake.oscillations;
  table.across = bake.across;
  table.rays = bake.rays;
  const LampGrid lamps{bake.grid.light, bake.grid.azimuth};
  const std::size_t states = std::size_t(bake.oscillations) * bake.along;
  const std::size_t nodes = std::size_t(lamps.light) * lamps.azimuth;
  table.modulation.assign(nodes * bake.grid.view * states, 1.0f);
  table.profile.assign(nodes * bake.grid.view * bake.across, 1.0f);
  table.mean.assign(nodes * bake.grid.view, 1.0f);
  const std::vector<double> chords = chord_shares(bake.across);
  std::vector<std::vector<ViewLight>> parts(std::size_t(bake.grid.view) * bake.oscillations);
  const auto elevation_of = [&](int view) { return -0.5 * pi + pi * view / (bake.grid.view - 1); };
  for_each_task(
      static_cast<int>(parts.size()), bake.threads,
      [&](int i) {
        const int o = i % bake.oscillations;
        parts[i] = trace_view(bake, elevation_of(i / bake.oscillations), std::span(&lamps, 1), o, o + 1);
      },
      progress);
  // The drops' own phase function: over all views as often as random drops are seen from them.
  std::vector<double> turns(drop_phase_bins, 0.0);
  double seen = 0.0;
  for (int i = 0; i < static_cast<int>(parts.size()); ++i) {
    const double weight = std::cos(elevation_of(i / bake.oscillations));
    seen += weight * bake.along;
    for (int k = 0; k < drop_phase_bins; ++k) turns[k] += weight * parts[i].front().turns[k];
  }
  table.phase.resize(drop_phase_bins);
  for (int k = 0; k < drop_phase_bins; ++k)  // over the solid angle of the bin, as in make_drop_phase()
    table.phase[k] =
        static_cast<float>(turns[k] / seen * drop_phase_bins * drop_phase_bins / (4.0 * pi * (2.0 * k + 1.0)));
  for (int view = 0; view < bake.grid.view; ++view) {
    ViewLight light = std::move(parts[std::size_t(view) * bake.oscillations].front());
    for (int o = 1; o < bake.oscillations; ++o) {
      const ViewLight& more = parts[std::size_t(view) * bake.oscillations + o].front();
      for (std::size_t i = 0; i < light.power.size(); ++i) light.power[i] += more.power[i];
      for (std::size_t i = 0; i < light.across.size(); ++i) light.across[i] += more.across[i];
    }
    join_poles(light.power, lamps, states);
    join_poles(light.across, lamps, bake.across);
    const TentWeights weights = tent_weights(elevation_of(view), lamps, table.phase);
    for (std::size_t node = 0; node < nodes; ++node) {
      const std::size_t entry = view * nodes + node;
      double sum = 0.0, across = 0.0;
      for (std::size_t k = 0; k < states; ++k) sum += light.power[node * states + k];
      for (int k = 0; k < bake.across; ++k) across += light.across[node * bake.across + k];
      if (!(sum > 0.0) || !(weights.phase[node] > 0.0)) continue;  // no light at all: even
      table.mean[entry] = static_cast<float>(sum / states / weights.phase[node]);
      for (std::size_t k = 0; k < states; ++k)
        table.modulation[entry * states + k] = static_cast<float>(light.power[node * states + k] * states / sum);
      // A lamp that stands in the plane of the view has no side.
      const std::size_t azimuth = node % lamps.azimuth, first = node * bake.across, last = first + bake.across - 1;
      if (azimuth == 0 || azimuth + 1 == std::size_t(lamps.azimuth))
        for (int k = 0; 2 * k < bake.across; ++k)
          light.across[first + k] = light.across[last - k] = 0.5 * (light.across[first + k] + light.across[last - k]);
      for (int k = 0; k < bake.across; ++k)
        table.profile[entry * bake.across + k] =
            static_cast<float>(light.across[node * bake.across + k] / across / chords[k]);
    }
  }
  return table;
}

}  // namespace petrichor
