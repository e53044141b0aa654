#include "systems/rainfall/chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/core/bench_row.hpp"
#include "systems/rainfall/passes.hpp"
#include "systems/rainfall/studio.hpp"

namespace petrichor {
namespace {

constexpr int moments = 6;   // pictures, far enough apart to share no drop
constexpr int repeats = 24;  // frames timed
constexpr int warm_up = 2;   // compile shaders, make buffers

struct Setting {
  RainRung rung;
  const char* name;
  const char* label;
  std::int32_t most_drops = 400'000'000;
  bool published = false;
};

const std::vector<Setting>& settings() {
  static const std::vector<Setting> all{
      {RainRung::fog, "fog", ""},
      {RainRung::double_cone, "double_cone", ""},
      {RainRung::double_cone, "double_cone", "as published", 400'000'000, true},
      {RainRung::composite, "composite", ""},
      {RainRung::composite, "composite", "as published", 400'000'000, true},
      {RainRung::sprites, "sprites", "30 k", 30'000},
      {RainRung::sprites, "sprites", "300 k", 300'000},
      {RainRung::sprites, "sprites", "300 k, as published", 300'000, true},
      {RainRung::drop_field, "drop_field", "3 k", 3'000},
      {RainRung::drop_field, "drop_field", "30 k", 30'000},
      {RainRung::drop_field, "drop_field", "300 k", 300'000},
      {RainRung::full_field, "full_field", "all"},
      {RainRung::near_drops, "near_drops", "30 k", 30'000},
      {RainRung::near_drops, "near_drops", "300 k", 300'000},
  };
  return all;
}

double moment(int i) {
  return 20.0 + 0.83 * i;
}

// Counts steps towards the end of a run of several charts.
struct Steps {
  const ChartRun& run;
  double total, done = 0.0;
  void advance(double steps) {
    done += steps;
    if (run.progress) run.progress(std::min(1.0, done / total));
  }
};

Result<std::vector<Picture>> truths(Studio& studio, std::uint32_t seed, Steps& steps) {
  std::vector<Picture> images;
  studio.begin(studio.cast());
  for (int i = 0; i < moments; ++i) {
    auto image = studio.truth(moment(i), seed);
    if (!image) return tl::unexpected(image.error());
    images.push_back(std::move(*image));
    steps.advance(32);
  }
  return images;
}

Result<ChartPoint> point(Studio& studio, const Setting& setting, const Statistics& truth, const Statistics& dry,
                         Steps& steps) {
  Studio::Cast cast = studio.cast();
  cast.techniques.set(Effect::rainfall, setting.rung);
  cast.emitter.maximum_drops = setting.most_drops;
  cast.cone.published = cast.layered.published = cast.sprites.published = setting.published;
  studio.begin(cast);
  std::vector<Picture> images;
  double drops = 0.0;
  for (int i = 0; i < moments; ++i) {
    // What holds state (sprites as published) sees some frames of the film first.
    for (int before = setting.published ? 20 : 3; before > 0; --before) {
      Frame f = studio.frame(moment(i) - before / 60.0);
      if (auto drawn = studio.draw(f); !drawn) return tl::unexpected(drawn.error());
    }
    Frame f = studio.frame(moment(i));
    auto image = studio.draw(f);
    if (!image) return tl::unexpected(image.error());
    images.push_back(std::move(*image));
    drops += rain_stats(f).drops_drawn / double(moments);
    steps.advance(1);
  }
  std::vector<double> times;
  for (int i = 0; i < repeats + warm_up; ++i) {
    Frame f = studio.frame(moment(moments) + i / 60.0);
    const auto ms = studio.time(f);
    if (!ms) return tl::unexpected(ms.error());
    if (i >= warm_up) times.push_back(*ms);
    steps.advance(1);
  }
  const StatisticsError e = compare(statistics_of(images, studio.width(), studio.height()), truth, dry);
  ChartPoint p;
  p.rung = setting.name;
  p.label = setting.label;
  p.ms = std::max(quantile(times, 0.5), 1e-3);
  p.ms_p5 = std::max(quantile(times, 0.05), 1e-3);
  p.ms_p95 = std::max(quantile(times, 0.95), 1e-3);
  p.error = e.all;
  p.mean_shift = e.mean_shift;
  // What is published fails tests of tests/stability/; and no rung may move the mean by 0.5% of the background.
  p.stable = !setting.published && std::isfinite(e.all) && std::abs(e.mean_shift) < 0.005;
  p.more = {{"mean_error", e.mean}, {"deviation_error", e.deviation}, {"spectrum_error", e.spectrum}, {"drops", drops}};
  return p;
}

Result<void> chart_scene(const ChartRun& run, const StudioScene& scene, Steps& steps) {
  auto made = Studio::make(run.software, scene);
  if (!made) return tl::unexpected(made.error());
  Studio& studio = **made;
  const int width = studio.width(), height = studio.height();
  std::array<Statistics, 2> truth;
  for (std::uint32_t which = 0; which < 2; ++which) {
    const auto images = truths(studio, 1 + which, steps);
    if (!images) return tl::unexpected(images.error());
    truth[which] = statistics_of(*images, width, height);
  }
  studio.begin(studio.cast());
  Frame dry_frame = studio.frame(0.0);
  dry_frame.rain.reset();
  const auto dry_image = studio.draw(dry_frame);
  if (!dry_image) return tl::unexpected(dry_image.error());
  const Statistics dry = statistics_of({*dry_image, *dry_image}, width, height);

  Chart chart;
  chart.name = "rainfall-" + scene.name;
  chart.effect = "rainfall";
  chart.title = "Falling rain, " + scene.title;
  chart.device = run.device;
  chart.width = width;
  chart.height = height;
  chart.error_label = "error of mean, deviation and spectrum (no rain at all: 1)";
  chart.floor = compare(truth[1], truth[0], dry).all;
  for (const Setting& setting : settings()) {
    auto p = point(studio, setting, truth[0], dry, steps);
    if (!p) return tl::unexpected(p.error());
    chart.points.push_back(std::move(*p));
  }
  return write_chart(run.folder, chart);
}

}  // namespace

Result<void> chart_rainfall(const ChartRun& run) {
  const std::array scenes{day_street(), night_lamps(), storm()};
  Steps steps{run, static_cast<double>(scenes.size()) *
                       (2.0 * moments * 32 + static_cast<double>(settings().size()) * (moments + repeats + warm_up))};
  for (const StudioScene& scene : scenes)
    if (auto charted = chart_scene(run, scene, steps); !charted) return charted;
  return {};
}

}  // namespace petrichor
