#include "systems/rainfall/snow/chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/core/bench_row.hpp"
#include "systems/rainfall/snow/extract.hpp"
#include "systems/rainfall/snow/passes.hpp"
#include "systems/rainfall/studio.hpp"

namespace petrichor {
namespace {

constexpr int instants = 6;  // of the truth's exposure, in which a flake falls by 20 mm
constexpr int moments = 16;  // pictures, far enough apart to share no flake
constexpr int repeats = 16;  // frames timed
constexpr int warm_up = 2;   // compile shaders, make buffers
constexpr float wall_m = 7.0f;
constexpr float behind_m = 1.2f * wall_m;  // beyond the wall's corners
constexpr std::array<double, 3> delays_s{1.0 / 20, 3.0 / 20, 7.0 / 20};
constexpr int across = 12, down = 20;  // shifts, in blocks of `coarse` pixels
constexpr int coarse = 2;

double moment(int i) {
  return 20.0 + 4.13 * i;
}

StudioScene scene_of(const char* name, float mm_per_hour) {
  StudioScene s;
  s.name = name;
  s.title = std::string(name) + " snow, " + (mm_per_hour < 1.0f ? "0.3" : "3") + " mm/h of water, dusk";
  s.rain_mm_per_hour = 0.0f;
  s.snow_mm_per_hour = mm_per_hour;
  s.wind.velocity_mps = {0.3f, 0.0f, 0.0f};
  // No lamps: a few flakes beside one would outshine all others, and chance would decide.
  s.wall_cd_m2 = glm::vec3(0.1f);
  s.sky_cd_m2 = 0.5f;
  s.wall_distance_m = wall_m;
  return s;
}

struct Setting {
  SnowRung rung;
  const char* name;
  const char* label;
  std::int32_t most_flakes = 400'000'000;
  float jitter = 0.0f;
  bool published = false;
};

const std::vector<Setting>& settings() {
  static const std::vector<Setting> all{
      {SnowRung::fog, "fog", ""},
      {SnowRung::double_cone, "double_cone", "still"},
      {SnowRung::double_cone, "double_cone", "jitter", 0, 1.0f},
      {SnowRung::double_cone, "double_cone", "as published", 0, 0.0f, true},
      {SnowRung::field, "field", "1 k flakes", 1'000},
      {SnowRung::field, "field", "5 k flakes", 5'000},
      {SnowRung::field, "field", "20 k flakes", 20'000},
      {SnowRung::field, "field", "all flakes"},
  };
  return all;
}

struct Steps {
  const ChartRun& run;
  double total, done = 0.0;
  void advance(double steps) {
    done += steps;
    if (run.progress) run.progress(std::min(1.0, done / total));
  }
};

// What deviates from the mean over time, by blocks of pixels.
Picture residual(const Picture& image, const Picture& mean, int width, int height) {
  const int wide = width / coarse, high = height / coarse;
  Picture r(std::size_t(wide) * high, 0.0f);
  for (int y = 0; y < high * coarse; ++y)
    for (int x = 0; x < wide * coarse; ++x)
      r[std::size_t(y / coarse) * wide + x / coarse] +=
          image[std::size_t(y) * width + x] - mean[std::size_t(y) * width + x];
  // Lamps shine on a few flakes far more than on all others: the root lets all have their say.
  for (float& v : r) v = std::copysign(std::sqrt(std::abs(v)), v);
  return r;
}

// How pictures are correlated with later ones (of each delay), by shift. All of it 0 where nothing deviates.
struct Motion {
  std::vector<double> correlation = std::vector<double>(delays_s.size() * (2 * across + 1) * (2 * down + 1), 0.0);
  double power = 0.0;
  void add(const Picture& now, const Picture& later, std::size_t delay, int wide, int high) {
    std::size_t at = delay * (2 * across + 1) * (2 * down + 1);
    for (int dy = -down; dy <= down; ++dy)
      for (int dx = -across; dx <= across; ++dx, ++at) {
        double sum = 0.0;
        for (int y = down; y < high - down; ++y) {
          const float* a = &now[std::size_t(y) * wide + across];
          const float* b = &later[std::size_t(y + dy) * wide + across + dx];
          float row = 0.0f;
          for (int x = 0; x < wide - 2 * across; ++x) row += a[x] * b[x];
          sum += row;
        }
        correlation[at] += sum;
      }
    for (int y = down; y < high - down; ++y)
      for (int x = across; x < wide - across; ++x) {
        const double v = now[std::size_t(y) * wide + x];
        power += v * v / double(delays_s.size());
      }
  }
};

// 0: moves alike; 1: nothing is there that could (but for rounding).
double motion_error(const Motion& found, const Motion& truth) {
  double difference = 0.0, all = 0.0;
  for (std::size_t i = 0; i < truth.correlation.size(); ++i) {
    const double t = truth.correlation[i] / truth.power;
    const double f = found.power > 0.05 * truth.power ? found.correlation[i] / found.power : 0.0;
    difference += (f - t) * (f - t);
    all += t * t;
  }
  return std::sqrt(difference / all);
}

// A film of short takes: at each moment a picture, and those after each delay.
struct Takes {
  std::vector<Picture> first;
  std::vector<std::array<Picture, delays_s.size()>> later;
};

Motion motion_of(const Takes& takes, int width, int height) {
  Picture mean(takes.first.front().size(), 0.0f);
  const float count = static_cast<float>(takes.first.size()) * (1.0f + delays_s.size());
  for (std::size_t i = 0; i < takes.first.size(); ++i)
    for (std::size_t p = 0; p < mean.size(); ++p) {
      mean[p] += takes.first[i][p] / count;
      for (const Picture& image : takes.later[i]) mean[p] += image[p] / count;
    }
  Motion motion;
  for (std::size_t i = 0; i < takes.first.size(); ++i) {
    const Picture now = residual(takes.first[i], mean, width, height);
    for (std::size_t d = 0; d < delays_s.size(); ++d)
      motion.add(now, residual(takes.later[i][d], mean, width, height), d, width / coarse, height / coarse);
  }
  return motion;
}

Result<Takes> film(Studio& studio, const Studio::Cast& cast, double* flakes = nullptr) {
  Takes takes;
  studio.begin(cast);
  for (int i = 0; i < moments; ++i) {
    // What holds state sees the frames of a film, not leaps.
    for (int before = 3; before > 0; --before) {
      Frame f = studio.frame(moment(i) - before / 60.0);
      if (auto drawn = studio.draw(f); !drawn) return tl::unexpected(drawn.error());
    }
    Frame f = studio.frame(moment(i));
    auto image = studio.draw(f);
    if (!image) return tl::unexpected(image.error());
    takes.first.push_back(std::move(*image));
    if (flakes) *flakes += snow_stats(f).flakes_drawn / double(moments);
    takes.later.emplace_back();
    for (std::size_t d = 0; d < delays_s.size(); ++d) {
      Frame next = studio.frame(moment(i) + delays_s[d]);
      auto later = studio.draw(next);
      if (!later) return tl::unexpected(later.error());
      takes.later.back()[d] = std::move(*later);
    }
  }
  return takes;
}

// Every flake before the wall, the mean of some instants of the exposure.
Result<Picture> truth_at(Studio& studio, const StudioScene& scene, const Studio::Cast& cast, double time_s) {
  Picture sum;
  const WindMotion wind = start_snow_motion(scene.wind);
  for (int i = 0; i < instants; ++i) {
    Frame f = studio.frame(time_s);
    const double earlier = f.camera.exposure_s * (i + 0.5) / instants;
    f.camera.exposure_s = 0.0f;
    f.snow = make_frame_snow(cast.snowfall, wind, f.camera, f.width, f.height, time_s - earlier);
    f.snow->fade_start_m = behind_m;  // nothing is left to haze
    f.snow->drawn_distance_m = 1.01f * behind_m;
    auto image = studio.draw(f);
    if (!image) return image;
    if (sum.empty()) sum.assign(image->size(), 0.0f);
    for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += (*image)[k] / instants;
  }
  return sum;
}

struct Truth {
  Statistics statistics;
  Motion motion;
};

Result<Truth> truth_of(Studio& studio, const StudioScene& scene, std::uint32_t seed, Steps& steps) {
  Studio::Cast cast = studio.cast();
  cast.snowfall.drawn_distance_m = 1.1f * behind_m;
  cast.snowfall.seed = seed;
  studio.begin(cast);
  std::vector<Picture> images;
  for (int i = 0; i < moments; ++i) {
    auto image = truth_at(studio, scene, cast, moment(i));
    if (!image) return tl::unexpected(image.error());
    images.push_back(std::move(*image));
    steps.advance(instants);
  }
  // Flakes move alike whether their streaks are integrated or drawn at instants.
  const auto takes = film(studio, cast);
  if (!takes) return tl::unexpected(takes.error());
  return Truth{statistics_of(images, studio.width(), studio.height()),
               motion_of(*takes, studio.width(), studio.height())};
}

double all_of(const StatisticsError& e, double motion) {
  return (e.mean + e.deviation + e.spectrum + motion) / 3.0;
}

Result<ChartPoint> point(Studio& studio, const Setting& setting, const Truth& truth, const Statistics& bare,
                         Steps& steps) {
  Studio::Cast cast = studio.cast();
  cast.techniques.set(Effect::snow, setting.rung);
  cast.snowfall.drawn_distance_m = 1.1f * behind_m;
  cast.snowfall.maximum_flakes = setting.most_flakes;
  cast.snowfall.cone_jitter = setting.jitter;
  cast.cone.published = setting.published;
  double flakes = 0.0;
  const auto takes = film(studio, cast, &flakes);
  if (!takes) return tl::unexpected(takes.error());
  steps.advance(moments * (4 + delays_s.size()));
  std::vector<double> times;
  for (int i = 0; i < repeats + warm_up; ++i) {
    Frame f = studio.frame(moment(moments) + i / 60.0);
    const auto ms = studio.time(f);
    if (!ms) return tl::unexpected(ms.error());
    if (i >= warm_up) times.push_back(*ms);
    steps.advance(1);
  }
  const StatisticsError e =
      compare(statistics_of(takes->first, studio.width(), studio.height()), truth.statistics, bare);
  const double motion = motion_error(motion_of(*takes, studio.width(), studio.height()), truth.motion);
  ChartPoint p;
  p.rung = setting.name;
  p.label = setting.label;
  p.ms = std::max(quantile(times, 0.5), 1e-3);
  p.ms_p5 = std::max(quantile(times, 0.05), 1e-3);
  p.ms_p95 = std::max(quantile(times, 0.95), 1e-3);
  p.error = all_of(e, motion);
  p.mean_shift = e.mean_shift;
  // What is published fails tests of tests/stability/; and no rung may move the mean by 0.5% of the background.
  p.stable = !setting.published && std::isfinite(p.error) && std::abs(e.mean_shift) < 0.005;
  p.more = {{"mean_error", e.mean},
            {"deviation_error", e.deviation},
            {"spectrum_error", e.spectrum},
            {"motion_error", motion},
            {"flakes", flakes}};
  return p;
}

Result<void> chart_scene(const ChartRun& run, const StudioScene& scene, Steps& steps) {
  auto made = Studio::make(run.software, scene);
  if (!made) return tl::unexpected(made.error());
  Studio& studio = **made;
  auto truth = truth_of(studio, scene, 1, steps);
  if (!truth) return tl::unexpected(truth.error());
  const auto other = truth_of(studio, scene, 2, steps);
  if (!other) return tl::unexpected(other.error());
  studio.begin(studio.cast());
  Frame clear = studio.frame(0.0);
  clear.snow.reset();
  const auto clear_image = studio.draw(clear);
  if (!clear_image) return tl::unexpected(clear_image.error());
  const Statistics bare = statistics_of({*clear_image, *clear_image}, studio.width(), studio.height());

  Chart chart;
  chart.name = "snow-" + scene.name;
  chart.effect = "snow";
  chart.title = "Falling snow: " + scene.title;
  chart.device = run.device;
  chart.width = studio.width();
  chart.height = studio.height();
  chart.error_label = "error of mean and deviation, spectrum, and motion (no snow at all: 1)";
  chart.floor = all_of(compare(other->statistics, truth->statistics, bare), motion_error(other->motion, truth->motion));
  for (const Setting& setting : settings()) {
    auto p = point(studio, setting, *truth, bare, steps);
    if (!p) return tl::unexpected(p.error());
    chart.points.push_back(std::move(*p));
  }
  return write_chart(run.folder, chart);
}

}  // namespace

Result<void> chart_snow(const ChartRun& run) {
  const std::array scenes{scene_of("light", 0.3f), scene_of("heavy", 3.0f)};
  Steps steps{run, static_cast<double>(scenes.size()) *
                       (2.0 * moments * instants + static_cast<double>(settings().size()) *
                                                       (moments * (4.0 + delays_s.size()) + repeats + warm_up))};
  for (const StudioScene& scene : scenes)
    if (auto charted = chart_scene(run, scene, steps); !charted) return charted;
  return {};
}

}  // namespace petrichor
