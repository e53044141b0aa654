#include "systems/rainfall/class_chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "engine/core/bench_row.hpp"
#include "systems/rainfall/extract.hpp"
#include "systems/rainfall/passes.hpp"
#include "systems/rainfall/studio.hpp"

namespace petrichor {
namespace {

constexpr int reference_classes = 64;
constexpr std::array<int, 6> counts{1, 2, 4, 8, 16, 32};
constexpr int moments = 8;  // pictures
constexpr float distance_m = 12.0f;
constexpr int repeats = 15;  // frames timed
constexpr int warm_up = 2;

using Weighted = std::vector<std::pair<double, double>>;  // value, weight

Weighted of(const std::vector<DropClass>& classes, const std::function<double(const DropClass&)>& value,
            const std::function<double(const DropClass&)>& weight) {
  Weighted all;
  double sum = 0.0;
  for (const DropClass& c : classes)
    if (c.drawn) all.emplace_back(value(c), weight(c)), sum += all.back().second;
  for (auto& [v, w] : all) w /= sum;
  std::sort(all.begin(), all.end());
  return all;
}

// How far values must be moved, on average, to turn one distribution into the other (Wasserstein 1).
double distance(const Weighted& a, const Weighted& b) {
  std::size_t i = 0, j = 0;
  double left_a = a[0].second, left_b = b[0].second, sum = 0.0;
  while (i < a.size() && j < b.size()) {
    const double moved = std::min(left_a, left_b);
    sum += moved * std::abs(a[i].first - b[j].first);
    left_a -= moved;
    left_b -= moved;
    if (left_a <= left_b) {
      if (++i < a.size()) left_a += a[i].second;
    } else if (++j < b.size()) {
      left_b += b[j].second;
    }
  }
  return sum;
}

// Of the spread that the reference has: 1 is all at the mean.
double spread_error(const Weighted& found, const Weighted& truth) {
  double mean = 0.0;
  for (const auto& [v, w] : truth) mean += v * w;
  return distance(found, truth) / distance({{mean, 1.0}}, truth);
}

double sum(const std::vector<DropClass>& classes, const std::function<double(const DropClass&)>& value) {
  double all = 0.0;
  for (const DropClass& c : classes) all += c.drawn ? value(c) : 0.0;
  return all;
}

struct SplitError {
  double length, tilt, energy, extinction, impacts, all;
};

SplitError split_error(const std::vector<DropClass>& found, const std::vector<DropClass>& truth) {
  SplitError e{};
  const auto number = [](const DropClass& c) { return c.drops_per_m3; };
  const auto water = [](const DropClass& c) { return rain_mm_per_hour(c); };
  const auto speed = [](const DropClass& c) { return c.fall_speed_mps; };  // times the exposure: a streak's length
  const auto slowness = [](const DropClass& c) { return 1.0 / c.fall_speed_mps; };  // times the wind: its tilt
  e.length = spread_error(of(found, speed, number), of(truth, speed, number));
  e.tilt = spread_error(of(found, slowness, water), of(truth, slowness, water));
  const auto relative = [&](const std::function<double(const DropClass&)>& value) {
    return std::abs(sum(found, value) / sum(truth, value) - 1.0);
  };
  e.energy = relative([&](const DropClass& c) { return water(c) * c.fall_speed_mps * c.fall_speed_mps; });
  e.extinction = relative([](const DropClass& c) { return extinction_per_m(c); });
  e.impacts = relative([](const DropClass& c) { return c.drops_per_m3 * c.fall_speed_mps; });
  const double squares =
      e.length * e.length + e.tilt * e.tilt + e.energy * e.energy + e.extinction * e.extinction + e.impacts * e.impacts;
  e.all = std::sqrt(squares / 5.0);
  return e;
}

double moment(int i) {
  return 20.0 + 0.83 * i;
}

Frame frame_of(Studio& studio, const StudioScene& scene, int classes, std::uint32_t seed, double time_s) {
  Emitter emitter = studio.cast().emitter;
  emitter.drawn_distance_m = distance_m;
  emitter.seed = seed;
  Frame f = studio.frame(time_s);
  f.rain = make_frame_rain(emitter, start_rain_motion(emitter, scene.wind, classes), f.camera, f.width, f.height,
                           time_s, classes);
  f.rain->techniques = f.techniques;
  return f;
}

Result<Statistics> pictures(Studio& studio, const StudioScene& scene, int classes, std::uint32_t seed) {
  studio.begin(studio.cast());
  std::vector<Picture> images;
  for (int i = 0; i < moments; ++i) {
    Frame f = frame_of(studio, scene, classes, seed, moment(i));
    auto image = studio.draw(f);
    if (!image) return tl::unexpected(image.error());
    images.push_back(std::move(*image));
  }
  return statistics_of(images, studio.width(), studio.height());
}

}  // namespace

Result<void> chart_classes(const ChartRun& run) {
  StudioScene scene = night_lamps();
  scene.wind.velocity_mps = {5.0f, 0.0f, 0.0f};
  auto made = Studio::make(run.software, scene);
  if (!made) return tl::unexpected(made.error());
  Studio& studio = **made;
  const Emitter emitter = studio.cast().emitter;
  const std::vector<DropClass> truth = make_drop_classes(emitter, reference_classes);

  double done = 0.0;
  const auto advance = [&] {
    done += 1.0;
    if (run.progress) run.progress(done / (counts.size() + 2.0 + repeats + warm_up));
  };
  const auto picture_truth = pictures(studio, scene, reference_classes, 1);
  if (!picture_truth) return tl::unexpected(picture_truth.error());
  advance();
  const auto other_seed = pictures(studio, scene, reference_classes, 2);
  if (!other_seed) return tl::unexpected(other_seed.error());
  advance();
  Frame dry_frame = studio.frame(60.0);
  dry_frame.rain.reset();
  const auto dry_image = studio.draw(dry_frame);
  if (!dry_image) return tl::unexpected(dry_image.error());
  const Statistics dry = statistics_of({*dry_image, *dry_image}, studio.width(), studio.height());

  Chart chart;
  chart.name = "classes";
  chart.effect = "rainfall";
  chart.title = "Size classes of drops, 10 mm/h, wind 5 m/s, every drop to 12 m";
  chart.device = run.device;
  chart.width = studio.width();
  chart.height = studio.height();
  chart.error_label = "error of lengths, tilts, energy, extinction, impacts against 64 classes (all alike: about 1)";
  const double picture_floor = compare(*other_seed, *picture_truth, dry).all;
  for (const int classes : counts) {
    const SplitError e = split_error(make_drop_classes(emitter, classes), truth);
    const auto found = pictures(studio, scene, classes, 1);
    if (!found) return tl::unexpected(found.error());
    const StatisticsError picture = compare(*found, *picture_truth, dry);
    ChartPoint p;
    p.rung = "drop_field";
    p.label = std::to_string(classes) + (classes == 1 ? " class" : " classes");
    p.error = e.all;
    p.mean_shift = picture.mean_shift;
    p.more = {{"classes", classes},
              {"length", e.length},
              {"tilt", e.tilt},
              {"energy", e.energy},
              {"extinction", e.extinction},
              {"impacts", e.impacts},
              {"picture", picture.all},
              {"picture_other_seed", picture_floor}};
    chart.points.push_back(std::move(p));
    advance();
  }
  // By turns, so that whatever else the machine does falls on all alike.
  studio.begin(studio.cast());
  std::vector<std::vector<double>> times(counts.size());
  for (int i = 0; i < repeats + warm_up; ++i) {
    for (std::size_t k = 0; k < counts.size(); ++k) {
      Frame f = frame_of(studio, scene, counts[k], 1, moment(moments) + i / 60.0);
      const auto ms = studio.time(f);
      if (!ms) return tl::unexpected(ms.error());
      if (i >= warm_up) times[k].push_back(*ms);
    }
    advance();
  }
  for (std::size_t k = 0; k < counts.size(); ++k) {
    chart.points[k].ms = quantile(times[k], 0.5);
    chart.points[k].ms_p5 = quantile(times[k], 0.05);
    chart.points[k].ms_p95 = quantile(times[k], 0.95);
  }
  return write_chart(run.folder, chart);
}

}  // namespace petrichor
