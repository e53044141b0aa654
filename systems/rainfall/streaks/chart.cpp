#include "systems/rainfall/streaks/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>

#include "engine/core/random.hpp"
#include "systems/rainfall/drop_optics.hpp"
#include "systems/rainfall/streaks/bake.hpp"
#include "systems/rainfall/streaks/drop_tracer.hpp"

namespace petrichor {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double lamp_radius_rad = 5.0 * pi / 180.0;
constexpr int truth_views = 24, truth_lamps = 32, truth_moments = 6;

struct Sample {
  StreakAngles angles;
  double along[truth_moments], oscillation[truth_moments];
  double radiance[2][truth_moments] = {};  // by two halves of the rays
  double sphere = 0.0;                     // that a sphere would have
  double truth(int moment) const { return 0.5 * (radiance[0][moment] + radiance[1][moment]); }
};

double sphere_phase(const StreakAngles& a) {
  static const std::vector<float> phase = make_drop_phase();
  const double sine = std::sqrt(std::clamp(0.5 - 0.5 * turn_cosine(a), 0.0, 1.0));
  return phase[std::min(static_cast<int>(sine * drop_phase_bins), drop_phase_bins - 1)];
}

// Mean of the sphere's phase function over the lamp.
double sphere_of(const StreakAngles& a) {
  const double ce = std::cos(a.light_elevation), se = std::sin(a.light_elevation);
  const glm::dvec3 middle(ce * std::cos(a.azimuth), se, ce * std::sin(a.azimuth));
  const glm::dvec3 side =
      glm::normalize(glm::cross(middle, std::abs(se) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0)));
  const glm::dvec3 up = glm::cross(side, middle);
  double sum = 0.0;
  constexpr int count = 64;
  for (int i = 0; i < count; ++i) {
    const double t = std::sqrt((i + 0.5) / count) * lamp_radius_rad, turn = 2.4 * i;
    const glm::dvec3 l = std::cos(t) * middle + std::sin(t) * (std::cos(turn) * side + std::sin(turn) * up);
    const double azimuth = std::acos(std::clamp(l.x / std::max(std::hypot(l.x, l.z), 1e-9), -1.0, 1.0));
    sum += sphere_phase({a.view_elevation, std::asin(std::clamp(l.y, -1.0, 1.0)), azimuth});
  }
  return sum / count;
}

// Radiance at the lamps of one view, straight from traced rays.
void trace_truth(std::span<Sample> samples, const StreakBake& bake, int rays) {
  const double view = samples.front().angles.view_elevation, c = std::cos(view), s = std::sin(view);
  const glm::dvec3 to_eye(c, s, 0.0), side(0.0, 0.0, 1.0), up(-s, c, 0.0);
  std::vector<glm::dvec3> lamps;
  for (const Sample& sample : samples) {
    const StreakAngles& a = sample.angles;
    const double ce = std::cos(a.light_elevation);
    lamps.emplace_back(ce * std::cos(a.azimuth), std::sin(a.light_elevation), ce * std::sin(a.azimuth));
  }
  const double near = std::cos(lamp_radius_rad), solid = 2.0 * pi * (1.0 - near);
  const double reach = 1.05 + bake.drop.prolate + 2.1 * bake.drop.sideways;
  const Oscillation oscillation{bake.drop.prolate, bake.drop.sideways, bake.drop.lean_deg * pi / 180.0};
  for (int m = 0; m < truth_moments; ++m) {
    const double phase2 = 2.0 * pi * samples.front().along[m];
    const DropShape shape = drop_shape(bake.drop.diameter_mm, oscillation, phase2,
                                       2.0 * phase2 + 2.0 * pi * samples.front().oscillation[m]);
    for (int i = 0; i < rays; ++i) {
      const double u = 0.5 + 0.8191725133961645 * i, w = 0.5 + 0.6710436067037893 * i;  // even, but not the bake's
      const double r = reach * std::sqrt(u - std::floor(u)), turn = 2.0 * pi * (w - std::floor(w));
      const DropPaths paths =
          trace_drop(shape, r * std::cos(turn) * side + r * std::sin(turn) * up + 4.0 * to_eye, -to_eye);
      for (int p = 0; p < paths.count; ++p)
        for (std::size_t k = 0; k < lamps.size(); ++k)
          if (glm::dot(lamps[k], paths.paths[p].direction) > near)
            samples[k].radiance[2 * i >= rays][m] += paths.paths[p].share * reach * reach / (0.5 * rays) / solid;
    }
  }
}

std::vector<Sample> random_samples() {
  std::vector<Sample> samples;
  for (unsigned v = 0; v < truth_views; ++v) {
    const glm::vec4 view = random_float4(glm::uvec4(v, 1u, 2u, 3u));
    for (unsigned k = 0; k < truth_lamps; ++k) {
      const glm::vec4 r = random_float4(glm::uvec4(v, k, 4u, 5u));
      Sample sample;
      sample.angles = {std::asin(2.0 * view.x - 1.0), std::asin(2.0 * r.x - 1.0), pi * r.y};
      for (unsigned m = 0; m < truth_moments; ++m) {  // the same for all lamps of a view
        const glm::vec4 at = random_float4(glm::uvec4(v, m, 6u, 7u));
        sample.along[m] = at.x, sample.oscillation[m] = at.y;
      }
      sample.sphere = sphere_of(sample.angles);
      samples.push_back(sample);
    }
  }
  return samples;
}

// A table read in one of the ways that are compared.
struct Way {
  std::string rung, label;
  LampGrid lamps;
  int views;              // 1: level alone
  bool mirrored = false;  // elevation of the lamp by its size
  bool over_sphere = false;
  std::vector<std::vector<float>> values;  // by view: nodes x oscillations x along
  double kilobytes(const StreakBake& b) const {
    return double(views) * lamps.light * lamps.azimuth * b.oscillations * b.along * 4.0 / 1024.0;
  }
  double elevation(int view) const { return views == 1 ? 0.0 : -0.5 * pi + pi * view / (views - 1); }
};

struct Between {
  int low;
  double share;
};
Between between(double value, double low, double high, int nodes) {
  if (nodes == 1) return {0, 0.0};
  const double at = std::clamp((value - low) / (high - low), 0.0, 1.0) * (nodes - 1);
  const int i = std::min(static_cast<int>(at), nodes - 2);
  return {i, at - i};
}

double read(const Way& way, const StreakBake& bake, const Sample& sample, int moment) {
  const double lowest = way.lamps.lowest_deg * pi / 180.0;
  const double light = way.mirrored ? std::abs(sample.angles.light_elevation) : sample.angles.light_elevation;
  const Between v = between(sample.angles.view_elevation, -0.5 * pi, 0.5 * pi, way.views);
  const Between l = between(light, lowest, 0.5 * pi, way.lamps.light);
  const Between a = between(sample.angles.azimuth, 0.0, pi, way.lamps.azimuth);
  const double x = sample.along[moment] * bake.along, y = sample.oscillation[moment] * bake.oscillations;
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  double sum = 0.0;
  for (int corner = 0; corner < 32; ++corner) {
    const auto weight = [&](int bit, double share) { return corner & bit ? share : 1.0 - share; };
    const double w =
        weight(1, v.share) * weight(2, l.share) * weight(4, a.share) * weight(8, x - x0) * weight(16, y - y0);
    if (w == 0.0) continue;
    const std::size_t node = std::size_t(l.low + bool(corner & 2)) * way.lamps.azimuth + a.low + bool(corner & 4);
    const std::size_t state =
        std::size_t((y0 + bool(corner & 16)) % bake.oscillations) * bake.along + (x0 + bool(corner & 8)) % bake.along;
    sum += w * way.values[v.low + bool(corner & 1)][node * bake.oscillations * bake.along + state];
  }
  return way.over_sphere ? sum * sample.sphere : sum;
}

// Fills the values of every way that has a view at this elevation, from the same rays.
void fill(std::vector<Way>& ways, const StreakBake& bake, double elevation, int oscillation, std::mutex& mutex) {
  std::vector<LampGrid> grids;
  std::vector<std::pair<Way*, int>> users;
  for (Way& way : ways)
    for (int view = 0; view < way.views; ++view)
      if (std::abs(way.elevation(view) - elevation) < 1e-9) grids.push_back(way.lamps), users.emplace_back(&way, view);
  StreakBake finer = bake;
  if (elevation == 0.0) finer.rays = 4 * bake.rays;  // whose tables hold this view alone have small cells
  const auto lights = trace_view(finer, elevation, grids, oscillation, oscillation + 1);
  const std::size_t states = std::size_t(bake.oscillations) * bake.along;
  for (std::size_t g = 0; g < grids.size(); ++g) {
    std::vector<double> power = lights[g].power;
    join_poles(power, grids[g], states);
    const TentWeights weights = tent_weights(elevation, grids[g]);
    const std::vector<double>& over = users[g].first->over_sphere ? weights.phase : weights.solid_angle;
    const std::lock_guard lock(mutex);
    std::vector<float>& values = users[g].first->values[users[g].second];
    values.resize(power.size());
    for (std::size_t node = 0; node < over.size(); ++node)
      for (int j = 0; j < bake.along; ++j) {
        const std::size_t at = node * states + std::size_t(oscillation) * bake.along + j;
        values[at] = static_cast<float>(over[node] > 0.0 ? power[at] / over[node] : 0.0);
      }
  }
}

// Level, of about as many entries as a table of three angles.
LampGrid level_grid(int entries, double lowest_deg) {
  // Steps alike in both angles: 90 (or 180) degrees of elevation to 180 of azimuth.
  const double ratio = lowest_deg < 0.0 ? 1.0 : 0.5;
  const int azimuth = std::max(2, static_cast<int>(std::lround(std::sqrt(entries / ratio))));
  return {std::max(2, static_cast<int>(std::lround(double(entries) / azimuth))), azimuth, lowest_deg};
}

std::vector<Way> ways_to_compare() {
  std::vector<Way> ways;
  for (const StreakGrid g : {StreakGrid{3, 5, 5}, {5, 7, 7}, {7, 9, 9}, {9, 13, 13}, {13, 19, 19}}) {
    const std::string size = fmt::format("{} entries", g.entries());
    ways.push_back({"table", size, {g.light, g.azimuth}, g.view, false, true, {}});
    ways.push_back({"nearest", size, level_grid(g.entries(), 0.0), 1, true, false, {}});
    if (g.view != 7) continue;
    ways.push_back(
        {"nearest", "with the sign of the lamp's elevation", level_grid(g.entries(), -90.0), 1, false, false, {}});
    ways.push_back(
        {"nearest", "with the view's elevation", {g.light / 2 + 1, 2 * g.azimuth - 1, 0.0}, g.view, true, false, {}});
    ways.push_back({"table", "of radiance, not over the sphere's", {g.light, g.azimuth}, g.view, false, false, {}});
  }
  for (Way& way : ways) way.values.resize(way.views);
  return ways;
}

}  // namespace

Result<void> chart_streaks(const ChartRun& run) {
  StreakBake bake;
  bake.rays = 8000;
  constexpr int threads = 2, truth_rays = 60000;
  const auto part = [&](double from, double to) {
    return [&run, from, to](double share) {
      if (run.progress) run.progress(from + (to - from) * share);
    };
  };
  std::vector<Sample> samples = random_samples();
  for_each_task(
      truth_views, threads,
      [&](int v) {
        trace_truth(std::span(samples).subspan(std::size_t(v) * truth_lamps, truth_lamps), bake, truth_rays);
      },
      part(0.0, 0.3));
  std::vector<Way> ways = ways_to_compare();
  std::map<long, double> elevations;  // by millionths of a radian
  for (const Way& way : ways)
    for (int v = 0; v < way.views; ++v) elevations.emplace(std::lround(way.elevation(v) * 1e6), way.elevation(v));
  std::vector<double> views;
  for (const auto& [key, elevation] : elevations) views.push_back(elevation);
  std::mutex mutex;
  for_each_task(
      static_cast<int>(views.size()) * bake.oscillations, threads,
      [&](int i) { fill(ways, bake, views[i / bake.oscillations], i % bake.oscillations, mutex); }, part(0.3, 1.0));

  // Squares of errors over the mean of the true streak's radiance and the sphere's; and of errors as they are.
  const auto errors = [&](const auto& value) {
    double relative = 0.0, absolute = 0.0;
    for (const Sample& s : samples) {
      double mean = 0.0;
      for (int m = 0; m < truth_moments; ++m) mean += s.truth(m) / truth_moments;
      for (int m = 0; m < truth_moments; ++m) {
        const double e = value(s, m) - s.truth(m);
        relative += e * e / (0.25 * (mean + s.sphere) * (mean + s.sphere));
        absolute += e * e;
      }
    }
    return std::pair(std::sqrt(relative), std::sqrt(absolute));
  };
  const auto even = errors([](const Sample& s, int) { return s.sphere; });
  const auto noise = errors([](const Sample& s, int m) { return s.radiance[0][m]; });  // half the halves' difference
  Chart chart;
  chart.name = chart.effect = "streaks";
  chart.title = "Streaks of a 2 mm drop: table size against error to tracing";
  chart.device = fmt::format("{} rays a shape", bake.rays);
  chart.x_label = "size of the table, KiB";
  chart.error_label = "error of radiance (even streaks: 1)";
  chart.floor = noise.first / even.first;
  const auto add = [&](const std::string& rung, const std::string& label, double size, std::pair<double, double> e,
                       bool stable) {
    chart.points.push_back({rung,
                            label,
                            size,
                            size,
                            size,
                            e.first / even.first,
                            0.0,
                            stable,
                            {{"absolute_error", e.second / even.second}}});
  };
  add("even", "a sphere's radiance", drop_phase_bins * 4.0 / 1024.0, even, true);
  for (const Way& way : ways) {
    const auto e = errors([&](const Sample& s, int m) { return read(way, bake, s, m); });
    // Worse than none: hollow.
    add(way.rung, way.label, way.kilobytes(bake), e, e.first < even.first);
  }
  return write_chart(run.folder, chart);
}

}  // namespace petrichor
