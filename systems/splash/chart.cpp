#include <algorithm>
#include <cmath>
#include <string>

#include "systems/splash/splash.hpp"
#include "systems/splash/stage.hpp"

namespace petrichor {
namespace {

constexpr int moments = 5, instants = 16, block = 8;
using Picture = std::vector<float>;  // luminance of pixels, output units

struct Blocks {
  std::vector<double> mean, deviation;  // over moments and the pixels of a block
};

Blocks blocks_of(const std::vector<Picture>& pictures, int width, int height) {
  Blocks b;
  for (int y = 0; y + block <= height; y += block)
    for (int x = 0; x + block <= width; x += block) {
      double sum = 0.0, squares = 0.0;
      for (const Picture& p : pictures)
        for (int j = 0; j < block; ++j)
          for (int i = 0; i < block; ++i) {
            const double v = p[std::size_t(y + j) * width + x + i];
            sum += v;
            squares += v * v;
          }
      const double n = double(pictures.size()) * block * block;
      b.mean.push_back(sum / n);
      b.deviation.push_back(std::sqrt(std::max(squares / n - sum / n * (sum / n), 0.0)));
    }
  return b;
}

double distance_of(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(std::max<std::size_t>(a.size(), 1)));
}

struct Errors {
  double mean, deviation, all;
};
Errors errors_of(const Blocks& found, const Blocks& truth, const Blocks& none) {
  Errors e{};
  const double m = distance_of(none.mean, truth.mean), d = distance_of(none.deviation, truth.deviation);
  e.mean = distance_of(found.mean, truth.mean) / std::max(m, 1e-12);
  e.deviation = distance_of(found.deviation, truth.deviation) / std::max(d, 1e-12);
  e.all = 0.5 * (e.mean + e.deviation);
  return e;
}

struct Set {
  std::unique_ptr<SplashStage> stage;
  const MakeRain& make_rain;
  int width, height;
  float rate;

  Frame frame(double time_s, std::uint32_t seed) const {
    Frame f = stage->frame(width, height);
    f.time_s = time_s;
    Emitter emitter;
    emitter.rain_mm_per_hour = rate;
    emitter.seed = seed;
    f.rain = make_rain(emitter, {}, time_s);
    return f;
  }
  Result<Picture> draw(Frame& f) const {
    if (auto drawn = stage->draw(f); !drawn) return tl::unexpected(drawn.error());
    const std::vector<float> light = stage->light();
    Picture p(light.size() / 3);
    for (std::size_t i = 0; i < p.size(); ++i)
      p[i] = (0.2126f * light[3 * i] + 0.7152f * light[3 * i + 1] + 0.0722f * light[3 * i + 2]) * f.uniforms.lens.w;
    return p;
  }
  // All impacts, their crowns as they stand at many instants of the exposure, all their droplets.
  Result<Picture> truth(double time_s, std::uint32_t seed) const {
    Picture sum;
    for (int i = 0; i < instants; ++i) {
      const double exposure = 1.0 / 60.0;
      Frame f = frame(time_s - exposure * (i + 0.5) / instants, seed);
      f.camera.exposure_s = 0.0f;
      auto all = default_splashes();
      all->most_splashes = 400000;
      all->secondary_reach_m = 6.0f;
      f.splashes = all;
      f.techniques.set(Effect::splashes, SplashRung::secondary);
      auto p = draw(f);
      if (!p) return p;
      if (sum.empty()) sum.assign(p->size(), 0.0f);
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += (*p)[k] / instants;
    }
    return sum;
  }
};

struct Setting {
  SplashRung rung;
  const char* name;
  const char* label;
  std::int32_t most;
  bool published = false;
};
constexpr Setting settings[] = {{SplashRung::random, "random", "5 k, as printed", 5000, true},
                                {SplashRung::random, "random", "1 k", 1000},
                                {SplashRung::random, "random", "5 k", 5000},
                                {SplashRung::field, "field", "250", 250},
                                {SplashRung::field, "field", "1 k", 1000},
                                {SplashRung::field, "field", "all", 20000},
                                {SplashRung::secondary, "secondary", "250", 250},
                                {SplashRung::secondary, "secondary", "1 k", 1000},
                                {SplashRung::secondary, "secondary", "all", 20000}};

double moment(int i) {
  return 12.0 + 0.41 * i;
}

Result<std::vector<double>> time_of(const Set& set, const Setting& s, int frames) {
  std::vector<double> all;
  for (int i = 0; i < frames + 2; ++i) {
    Frame f = set.frame(20.0 + i / 60.0, 1);
    auto splashes = default_splashes();
    splashes->most_splashes = s.most;
    splashes->published = s.published;
    f.splashes = splashes;
    f.techniques.set(Effect::splashes, s.rung);
    set.stage->timer().begin_frame(true);
    if (auto drawn = set.stage->draw(f); !drawn) return tl::unexpected(drawn.error());
    set.stage->timer().end_frame();
    glFinish();
    const std::vector<Timing> timings = set.stage->timer().collect();
    double sum = 0.0;
    for (const Timing& t : timings)
      if (t.name.rfind("splash_", 0) == 0) sum += t.milliseconds;
    if (i >= 2 && !timings.empty()) all.push_back(sum);
  }
  return all;
}

}  // namespace

Result<void> chart_splashes(const ChartRun& run, const MakeRain& make_rain) {
  const int width = run.software ? 320 : 1024, height = run.software ? 184 : 768;
  const std::pair<float, const char*> rates[] = {{10.0f, "rain"}, {50.0f, "downpour"}};
  double done = 0.0;
  const double steps = double(std::size(rates)) * (2 * moments * instants + std::size(settings) * (moments + 14.0));
  const auto advance = [&](double n) {
    done += n;
    if (run.progress) run.progress(std::min(done / steps, 1.0));
  };
  for (const auto& [rate, name] : rates) {
    auto stage = SplashStage::make({.software = run.software, .film_mm = 0.4f});
    if (!stage) return tl::unexpected(stage.error());
    const Set set{std::move(*stage), make_rain, width, height, rate};
    Blocks truth[2];
    for (std::uint32_t seed = 1; seed <= 2; ++seed) {
      std::vector<Picture> pictures;
      for (int i = 0; i < moments; ++i) {
        auto p = set.truth(moment(i), seed);
        if (!p) return tl::unexpected(p.error());
        pictures.push_back(std::move(*p));
        advance(instants);
      }
      truth[seed - 1] = blocks_of(pictures, width, height);
    }
    Frame dry = set.frame(moment(0), 1);
    dry.techniques.set(Effect::splashes, SplashRung::none);
    auto nothing = set.draw(dry);
    if (!nothing) return tl::unexpected(nothing.error());
    const Blocks none = blocks_of({*nothing}, width, height);
    Chart chart;
    chart.name = std::string("splashes-") + name;
    chart.effect = "splashes";
    chart.title = "Splashes, " + std::to_string(int(rate)) + " mm/h, a pavement under two lamps";
    chart.device = run.device;
    chart.width = width;
    chart.height = height;
    chart.error_label = "error of mean and deviation by blocks (no splashes: 1)";
    chart.floor = errors_of(truth[1], truth[0], none).all;
    chart.points.push_back({"none",
                            "",
                            1e-3,
                            1e-3,
                            1e-3,
                            1.0,
                            0.0,
                            true,
                            {{"mean_error", 1.0}, {"deviation_error", 1.0}, {"splashes", 0.0}}});
    for (const Setting& s : settings) {
      std::vector<Picture> pictures;
      double listed = 0.0;
      for (int i = 0; i < moments; ++i) {
        Frame f = set.frame(moment(i), 1);
        auto splashes = default_splashes();
        splashes->most_splashes = s.most;
        splashes->published = s.published;
        f.splashes = splashes;
        f.techniques.set(Effect::splashes, s.rung);
        auto p = set.draw(f);
        if (!p) return tl::unexpected(p.error());
        pictures.push_back(std::move(*p));
        listed += splash_stats().splashes / double(moments);
        advance(1);
      }
      const Blocks found = blocks_of(pictures, width, height);
      const Errors e = errors_of(found, truth[0], none);
      auto times = time_of(set, s, 12);
      if (!times) return tl::unexpected(times.error());
      advance(14);
      const double least = 1e-3;
      chart.points.push_back({s.name,
                              s.label,
                              std::max(quantile(*times, 0.5), least),
                              std::max(quantile(*times, 0.05), least),
                              std::max(quantile(*times, 0.95), least),
                              e.all,
                              0.0,
                              !s.published && std::isfinite(e.all),
                              {{"mean_error", e.mean}, {"deviation_error", e.deviation}, {"splashes", listed}}});
    }
    if (auto written = write_chart(run.folder, chart); !written) return written;
  }
  return {};
}

Result<std::vector<BenchRow>> bench_splashes(int width, int height, int frames, bool software_gl,
                                             const MakeRain& make_rain) {
  auto stage = SplashStage::make({.software = software_gl, .film_mm = 0.4f});
  if (!stage) return tl::unexpected(stage.error());
  Set set{std::move(*stage), make_rain, width, height, 50.0f};
  struct Row {
    const char* name;
    Setting setting;
    float rate;
  };
  const Row rows[] = {{"field", {SplashRung::field, "", "", 20000}, 100.0f},
                      {"secondary", {SplashRung::secondary, "", "", 20000}, 100.0f},
                      {"field", {SplashRung::field, "", "", 5000}, 50.0f},
                      {"secondary", {SplashRung::secondary, "", "", 5000}, 50.0f},
                      {"random", {SplashRung::random, "", "", 5000}, 50.0f},
                      {"published", {SplashRung::random, "", "", 5000, true}, 50.0f}};
  std::vector<BenchRow> out;
  for (const Row& row : rows) {
    set.rate = row.rate;
    auto times = time_of(set, row.setting, frames);
    const std::uint32_t listed = splash_stats().splashes;
    if (!times) return tl::unexpected(times.error());
    const double median = quantile(*times, 0.5);
    out.push_back({std::string("splashes/") + row.name, std::to_string(listed),
                   std::to_string(width) + "x" + std::to_string(height), median, quantile(*times, 0.95),
                   software_gl ? std::nullopt : std::optional<double>(median)});
  }
  return out;
}

}  // namespace petrichor
