#include "systems/rainfall/streaks/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <numbers>

#include "engine/core/random.hpp"
#include "systems/drops/drop_optics.hpp"
#include "systems/rainfall/streaks/bake.hpp"
#include "systems/rainfall/streaks/drop_tracer.hpp"

namespace petrichor {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double lamp_radius_rad = 5.0 * pi / 180.0;
constexpr int truth_views = 24, truth_lamps = 32, truth_moments = 16;

struct Sample {
  StreakAngles angles;
  double along[truth_moments], oscillation[truth_moments];
  double radiance[2][truth_moments] = {};  // by two halves of the rays
  double truth(int moment) const { return 0.5 * (radiance[0][moment] + radiance[1][moment]); }
};

double phase_at(std::span<const float> phase, const StreakAngles& a) {
  const double sine = std::sqrt(std::clamp(0.5 - 0.5 * turn_cosine(a), 0.0, 1.0));
  return phase[std::min(static_cast<int>(sine * drop_phase_bins), drop_phase_bins - 1)];
}

// Mean of a phase function over the lamp.
double sphere_over_lamp(std::span<const float> phase, const StreakAngles& a) {
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
    sum += phase_at(phase, {a.view_elevation, std::asin(std::clamp(l.y, -1.0, 1.0)), azimuth});
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
      samples.push_back(sample);
    }
  }
  return samples;
}

enum class Reading {
  lines,   // of radiance, straight between entries
  mended,  // of what differs from the drops' own phase function; the mean by its logarithm
};

// A table read in one of the ways that are compared.
struct Way {
  std::string rung, label;
  LampGrid lamps;
  int views;              // 1: level alone
  bool mirrored = false;  // elevation of the lamp by its size
  Reading reading = Reading::lines;
  std::vector<std::vector<float>> values;             // by view: nodes x oscillations x along, radiance
  std::vector<std::vector<float>> means, mean_phase;  // by view: nodes, radiance
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

struct Read {
  double radiance, modulation;
};

Read read(const Way& way, const StreakBake& bake, const Sample& sample, int moment, double own_phase) {
  const double lowest = way.lamps.lowest_deg * pi / 180.0;
  const double light = way.mirrored ? std::abs(sample.angles.light_elevation) : sample.angles.light_elevation;
  const Between v = between(sample.angles.view_elevation, -0.5 * pi, 0.5 * pi, way.views);
  const Between l = between(light, lowest, 0.5 * pi, way.lamps.light);
  const Between a = between(sample.angles.azimuth, 0.0, pi, way.lamps.azimuth);
  const double x = sample.along[moment] * bake.along, y = sample.oscillation[moment] * bake.oscillations;
  const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
  double radiance = 0.0, modulation = 0.0, mean_log = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const auto weight = [&](int bit, double share) { return corner & bit ? share : 1.0 - share; };
    const double w = weight(1, v.share) * weight(2, l.share) * weight(4, a.share);
    if (w == 0.0) continue;
    const int view = v.low + bool(corner & 1);
    const std::size_t node = std::size_t(l.low + bool(corner & 2)) * way.lamps.azimuth + a.low + bool(corner & 4);
    const float* states = &way.values[view][node * bake.oscillations * bake.along];
    const auto at = [&](int o, int j) { return states[(o % bake.oscillations) * bake.along + j % bake.along]; };
    const double low = at(y0, x0) * (1.0 - (x - x0)) + at(y0, x0 + 1) * (x - x0);
    const double high = at(y0 + 1, x0) * (1.0 - (x - x0)) + at(y0 + 1, x0 + 1) * (x - x0);
    const double value = low * (1.0 - (y - y0)) + high * (y - y0), mean = way.means[view][node];
    radiance += w * value;
    modulation += w * (mean > 0.0 ? value / mean : 1.0);
    mean_log += w * std::log(std::max(mean, 1e-9) / std::max<double>(way.mean_phase[view][node], 1e-9));
  }
  if (way.reading == Reading::mended) radiance = own_phase * std::exp(mean_log) * modulation;
  return {radiance, modulation};
}

// Fills the values of every way that has a view at this elevation, from the same rays.
void fill(std::vector<Way>& ways, const StreakBake& bake, double elevation, int oscillation, std::mutex& mutex) {
  std::vector<LampGrid> grids;
  std::vector<std::pair<Way*, int>> users;
  for (Way& way : ways)
    for (int view = 0; view < way.views; ++view)
      if (std::abs(way.elevation(view) - elevation) < 1e-9) grids.push_back(way.lamps), users.emplace_back(&way, view);
  StreakBake finer = bake;
  if (elevation == 0.0) finer.rays = 4 * bake.rays;  // the tables that hold this view alone have small cells
  const auto lights = trace_view(finer, elevation, grids, oscillation, oscillation + 1);
  const std::size_t states = std::size_t(bake.oscillations) * bake.along;
  const std::vector<float> none(drop_phase_bins, 0.0f);
  for (std::size_t g = 0; g < grids.size(); ++g) {
    std::vector<double> power = lights[g].power;
    join_poles(power, grids[g], states);
    const std::vector<double> solid = tent_weights(elevation, grids[g], none).solid_angle;
    const std::lock_guard lock(mutex);
    std::vector<float>& values = users[g].first->values[users[g].second];
    values.resize(power.size());
    for (std::size_t node = 0; node < solid.size(); ++node)
      for (int j = 0; j < bake.along; ++j) {
        const std::size_t at = node * states + std::size_t(oscillation) * bake.along + j;
        values[at] = static_cast<float>(power[at] / solid[node]);
      }
  }
}

void find_means(Way& way, const StreakBake& bake, std::span<const float> phase) {
  const std::size_t states = std::size_t(bake.oscillations) * bake.along;
  for (int view = 0; view < way.views; ++view) {
    const TentWeights weights = tent_weights(way.elevation(view), way.lamps, phase);
    for (std::size_t node = 0; node < weights.phase.size(); ++node) {
      double sum = 0.0;
      for (std::size_t k = 0; k < states; ++k) sum += way.values[view][node * states + k];
      way.means[view].push_back(static_cast<float>(sum / states));
      way.mean_phase[view].push_back(static_cast<float>(weights.phase[node] / weights.solid_angle[node]));
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
    const std::string size = std::to_string(g.entries());
    ways.push_back({"table", size, {g.light, g.azimuth}, g.view, false, Reading::mended});
    ways.push_back({"nearest", size, level_grid(g.entries(), 0.0), 1, true});
    if (g.view != 7) continue;
    ways.push_back({"nearest", "but signed lamp elevation", level_grid(g.entries(), -90.0), 1, false});
    ways.push_back({"nearest", "but view elevation", {g.light / 2 + 1, 2 * g.azimuth - 1, 0.0}, g.view, true});
    ways.push_back({"table", "but straight lines of radiance", {g.light, g.azimuth}, g.view, false});
  }
  for (Way& way : ways) {
    way.values.resize(way.views);
    way.means.resize(way.views);
    way.mean_phase.resize(way.views);
  }
  return ways;
}

}  // namespace

Result<void> chart_streaks(const ChartRun& run) {
  StreakBake bake;
  bake.rays = 6000;
  constexpr int threads = 2, truth_rays = 40000;
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
      part(0.0, 0.4));
  StreakBake coarse = bake;  // for the phase function alone
  coarse.grid = {9, 2, 2};
  coarse.rays = 2000;
  const std::vector<float> own = bake_streaks(coarse, part(0.4, 0.45)).phase, sphere = make_drop_phase();
  std::vector<Way> ways = ways_to_compare();
  std::map<long, double> elevations;  // by millionths of a radian
  for (const Way& way : ways)
    for (int v = 0; v < way.views; ++v) elevations.emplace(std::lround(way.elevation(v) * 1e6), way.elevation(v));
  std::vector<double> views;
  for (const auto& [key, elevation] : elevations) views.push_back(elevation);
  std::mutex mutex;
  for_each_task(
      static_cast<int>(views.size()) * bake.oscillations, threads,
      [&](int i) { fill(ways, bake, views[i / bake.oscillations], i % bake.oscillations, mutex); }, part(0.45, 1.0));
  for (Way& way : ways) find_means(way, bake, own);

  // Root mean squares over the samples: of radiance over the mean of the true streak's and the drops' own phase
  // function, the same for nearly level views, and of modulation.
  struct Errors {
    double radiance = 0.0, level = 0.0, modulation = 0.0;
  };
  const auto errors = [&](const auto& value) {
    Errors e;
    for (const Sample& s : samples) {
      double mean = 0.0;
      for (int m = 0; m < truth_moments; ++m) mean += s.truth(m) / truth_moments;
      if (!(mean > 0.0)) continue;
      const double own_phase = phase_at(own, s.angles), size = 0.5 * (mean + own_phase);
      for (int m = 0; m < truth_moments; ++m) {
        const Read r = value(s, m, own_phase);
        const double wrong = std::pow((r.radiance - s.truth(m)) / size, 2);
        e.radiance += wrong;
        if (std::abs(s.angles.view_elevation) < 20.0 * pi / 180.0) e.level += wrong;
        e.modulation += std::pow(r.modulation - s.truth(m) / mean, 2);
      }
    }
    return Errors{std::sqrt(e.radiance), std::sqrt(e.level), std::sqrt(e.modulation)};
  };
  const Errors even = errors([&](const Sample& s, int, double) {
    return Read{sphere_over_lamp(sphere, s.angles), 1.0};
  });
  const Errors noise = errors([](const Sample& s, int m, double) {  // half the difference of the halves
    double mean = 0.0;
    for (int k = 0; k < truth_moments; ++k) mean += s.truth(k) / truth_moments;
    return Read{s.radiance[0][m], s.truth(m) / mean};
  });
  Chart radiance, bands;
  radiance.effect = bands.effect = "streaks";
  radiance.name = "streaks";
  bands.name = "streaks-bands";
  radiance.title = "Streaks of a 2 mm drop, entries of the table against error to tracing";
  bands.title = "Streaks of a 2 mm drop, entries of the table against error: bands alone";
  radiance.device = bands.device =
      fmt::format("{} random views x {} lamps x {} moments", truth_views, truth_lamps, truth_moments);
  radiance.x_label = bands.x_label = "size of the table, KiB";
  radiance.error_label = "error of radiance along the streak (even streaks of a sphere's radiance: 1)";
  bands.error_label = "error of radiance over its mean along the streak (even streaks: 1)";
  radiance.floor = noise.radiance / even.radiance;
  const auto add = [&](const std::string& rung, const std::string& label, double size, const Errors& e) {
    // Hollow: worse than no table at all.
    radiance.points.push_back({rung,
                               label,
                               size,
                               size,
                               size,
                               e.radiance / even.radiance,
                               0.0,
                               e.radiance <= even.radiance,
                               {{"nearly_level_views", e.level / even.level}}});
    bands.points.push_back(
        {rung, label, size, size, size, e.modulation / even.modulation, 0.0, e.modulation <= even.modulation, {}});
  };
  add("even", "a sphere's radiance", drop_phase_bins * 4.0 / 1024.0, even);
  for (const Way& way : ways)
    add(way.rung, way.label, way.kilobytes(bake),
        errors([&](const Sample& s, int m, double own_phase) { return read(way, bake, s, m, own_phase); }));
  if (auto written = write_chart(run.folder, radiance); !written) return written;
  return write_chart(run.folder, bands);
}

}  // namespace petrichor
