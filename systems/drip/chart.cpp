#include "systems/drip/chart.hpp"

#include <algorithm>
#include <cmath>

#include "systems/drip/drip.hpp"
#include "systems/drip/stage.hpp"
#include "systems/drip_frame.hpp"

namespace petrichor {
namespace {

using Picture = std::vector<float>;

double distance(const Picture& a, const Picture& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(double(a[i]) - b[i], 2);
  return std::sqrt(sum / static_cast<double>(a.size()));
}

double mean(const Picture& a) {
  double sum = 0.0;
  for (const float v : a) sum += v;
  return sum / static_cast<double>(a.size());
}

void use(Frame& f, DripRung rung) {
  f.techniques.set(Effect::drips, rung);
}

constexpr double time_of_chart_s = 1.0;
constexpr std::size_t most_drops = 4096;

struct Setting {
  DripRung rung;
  const char* name;
  const char* label;
  bool published;
  float shows_world_px;
  bool stable;
};

}  // namespace

Result<Picture> true_drips(DripStage& stage, const DripSet& set, int width, int height, int pixels, int instants) {
  DripSet all = set;
  all.shows_world_px = 0.0f;
  Picture sum(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0.0f);
  const float share = 1.0f / static_cast<float>(instants * pixels * pixels);
  for (int i = 0; i < instants; ++i) {
    const double earlier = (i + 0.5) / instants / 60.0;
    Frame f = stage.frame(all, width * pixels, height * pixels, time_of_chart_s - earlier, most_drops);
    use(f, DripRung::refracting);
    f.camera.exposure_s = 1e-4f;  // drops are as high as they are, and stand still
    if (f.drips) {
      auto still = std::make_shared<FrameDrips>(*f.drips);
      for (FrameDrip& d : still->drops) d.velocity_mps = glm::vec3(0.0f);
      f.drips = still;
    }
    if (auto drawn = stage.draw(f); !drawn) return tl::unexpected(drawn.error());
    const Picture light = stage.read_light();
    for (int y = 0; y < height * pixels; ++y)
      for (int x = 0; x < width * pixels; ++x)
        sum[static_cast<std::size_t>((y / pixels) * width + x / pixels)] +=
            share * light[static_cast<std::size_t>(y * width * pixels + x)];
  }
  return sum;
}

Result<DripComparison> compare_drips(DripStage& stage, const std::vector<float>& truth, const DripSet& set,
                                     DripRung rung, int width, int height) {
  Frame f = stage.frame(set, width, height, time_of_chart_s, most_drops);
  use(f, DripRung::none);
  if (auto drawn = stage.draw(f); !drawn) return tl::unexpected(drawn.error());
  const Picture off = stage.read_light();
  use(f, rung);
  if (auto drawn = stage.draw(f); !drawn) return tl::unexpected(drawn.error());
  const Picture found = stage.read_light();
  return DripComparison{distance(found, truth) / std::max(distance(off, truth), 1e-12),
                        (mean(found) - mean(truth)) / mean(off), (mean(truth) - mean(off)) / mean(off)};
}

Result<void> chart_drips(const ChartRun& run) {
  const int width = run.software ? 320 : 960, height = run.software ? 180 : 540;
  const int pixels = 4, instants = run.software ? 8 : 16, frames = run.software ? 9 : 120;
  Chart chart;
  chart.name = chart.effect = "drips";
  chart.title = "Drips, half a metre away, lamps behind, 20 mm/h";
  chart.device = run.device;
  chart.width = width;
  chart.height = height;
  auto stage = DripStage::make(run.software);
  if (!stage) return tl::unexpected(stage.error());
  DripSet set;
  set.source.length_m = 3.0f;
  set.camera_away_m = 0.5f;  // where some show the world
  set.source.catchment_depth_m = 1.0f;
  const auto truth = true_drips(**stage, set, width, height, pixels, instants);
  if (!truth) return tl::unexpected(truth.error());
  // Hollow: moves the mean (tests/stability/drips_gl.cpp).
  const Setting settings[] = {{DripRung::billboards, "billboards", "as printed", true, 1.0f, false},
                              {DripRung::billboards, "billboards", "", false, 1.0f, true},
                              {DripRung::streaks, "streaks", "", false, 1.0f, true},
                              {DripRung::refracting, "refracting", "from 2 px", false, 1.0f, true},
                              {DripRung::refracting, "refracting", "from 1 px", false, 0.5f, true},
                              {DripRung::refracting, "refracting", "all", false, 0.0f, true}};
  chart.points.push_back({"none", "no drips", 1e-3, 1e-3, 1e-3, 1.0, 0.0, true, {{"drops", 0.0}}});
  double done = 0.0;
  for (const Setting& s : settings) {
    set.shows_world_px = s.shows_world_px;
    set.source.published = s.published;
    auto compared = compare_drips(**stage, *truth, set, s.rung, width, height);
    if (!compared) return tl::unexpected(compared.error());
    Frame f = (*stage)->frame(set, width, height, time_of_chart_s, most_drops);
    use(f, s.rung);
    std::vector<double> times;
    for (int i = 0; i < frames + 3; ++i) {
      auto ms = (*stage)->time(f);
      if (!ms) return tl::unexpected(ms.error());
      if (i >= 3) times.push_back(*ms);
    }
    const double drops = f.drips ? static_cast<double>(f.drips->drops.size()) : 0.0;
    chart.points.push_back({s.name,
                            s.label,
                            quantile(times, 0.5),
                            quantile(times, 0.05),
                            quantile(times, 0.95),
                            compared->error,
                            compared->mean_shift,
                            s.stable,
                            {{"drops", drops}}});
    done += 1.0;
    if (run.progress) run.progress(done / std::size(settings));
  }
  return write_chart(run.folder, chart);
}

Result<std::vector<BenchRow>> bench_drips(int width, int height, int frames, bool software_gl) {
  auto stage = DripStage::make(software_gl);
  if (!stage) return tl::unexpected(stage.error());
  DripSet set;
  set.source.length_m = 12.0f;
  set.source.catchment_depth_m = 4.0f;
  set.camera_away_m = 8.0f;
  set.rows = 20;
  set.rain_mm_per_hour = 50.0f;
  std::vector<BenchRow> rows;
  for (const std::size_t most : {std::size_t(1000), std::size_t(10000)}) {
    for (const auto& [rung, name] : {std::pair(DripRung::billboards, "billboards"),
                                     {DripRung::streaks, "streaks"},
                                     {DripRung::refracting, "refracting"}}) {
      Frame f = (*stage)->frame(set, width, height, 1.0, most);
      use(f, rung);
      std::vector<double> times;
      for (int i = 0; i < frames + 4; ++i) {
        auto ms = (*stage)->time(f);
        if (!ms) return tl::unexpected(ms.error());
        if (i >= 4) times.push_back(*ms);
      }
      const double median = quantile(times, 0.5);
      rows.push_back({std::string("drips/") + name, std::to_string(f.drips ? f.drips->drops.size() : 0),
                      std::to_string(width) + "x" + std::to_string(height), median, quantile(times, 0.95),
                      software_gl ? std::nullopt : std::optional<double>(median)});
    }
  }
  return rows;
}

}  // namespace petrichor
