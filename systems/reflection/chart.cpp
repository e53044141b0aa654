#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "engine/core/bench_row.hpp"
#include "systems/reflection/reflection.hpp"
#include "systems/reflection/stage.hpp"
#include "systems/reflection/truth.hpp"

namespace petrichor {
namespace {

struct Setting {
  ReflectionRung rung;
  std::string name, label;
  std::map<std::string, double> parameters;
};

const std::vector<Setting>& settings() {
  static const std::vector<Setting> all{
      {ReflectionRung::environment, "environment", "", {}},
      {ReflectionRung::toyshop, "toyshop", "as published", {}},
      {ReflectionRung::impostors, "impostors", "", {}},
      {ReflectionRung::impostors, "impostors", "k_a", {{"published_edges", 1.0}}},
      {ReflectionRung::screen_space, "screen_space", "1 ray", {}},
      {ReflectionRung::screen_space, "screen_space", "2 rays", {{"rays", 2}}},
      {ReflectionRung::screen_space, "screen_space", "4 rays", {{"rays", 4}}},
      {ReflectionRung::screen_space, "screen_space", "4 rays, 48 steps", {{"rays", 4}, {"steps", 48}}},
      {ReflectionRung::planar, "planar", "", {}}};
  return all;
}

// mean((a - r)^2 / (r^2 + 0.01)) over what mirrors (physics 14), luminance; and the shift of the mean.
struct Difference {
  double error = 0.0, shift = 0.0;
};
double luminance(const glm::vec4& c) {
  return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}
Difference difference(const std::vector<glm::vec4>& picture, const std::vector<glm::vec4>& truth) {
  constexpr double shown = 1.0 / (1.2 * 8.0);  // cd/m2 to linear output at EV 3: what 0.01 is meant in
  double squares = 0.0, mean = 0.0, true_mean = 0.0, count = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (truth[i].w <= 0.0f) continue;
    const double a = picture.empty() ? 0.0 : shown * luminance(picture[i]), r = shown * luminance(truth[i]);
    squares += (a - r) * (a - r) / (r * r + 0.01);
    mean += a, true_mean += r, count += 1.0;
  }
  return {std::sqrt(squares / std::max(count, 1.0)), (mean - true_mean) / std::max(true_mean, 1e-9)};
}

}  // namespace

Result<void> chart_reflections(const ChartRun& run, const MakePasses& passes) {
  const int width = run.software ? 192 : 256, height = run.software ? 108 : 144;  // of the pictures compared
  const int timed_width = run.software ? 640 : 1024, timed_height = run.software ? 360 : 768;
  const int repeats = run.software ? 5 : 60;
  struct Case {
    float roughness;
    const char *name, *title;
  };
  const Case cases[] = {{0.1f, "reflections-puddle", "Night street on still water, roughness 0.1"},
                        {0.22f, "reflections", "Night street on wet asphalt, roughness 0.22"},
                        {0.4f, "reflections-damp", "Night street on damp stone, roughness 0.4"}};
  double done = 0.0;
  for (const Case& c : cases) {
    Chart chart;
    chart.name = c.name;
    chart.effect = "reflections";
    chart.title = c.title;
    chart.device = run.device;
    chart.width = timed_width;
    chart.height = timed_height;
    std::vector<glm::vec4> truth;
    double nothing = 1.0;
    for (const Setting& s : settings()) {
      auto stage = ReflectionStage::make(passes, night_street(c.roughness), width, height, s.parameters);
      if (!stage) return tl::unexpected(stage.error());
      (*stage)->use(s.rung);
      auto picture = (*stage)->draw();
      if (!picture) return tl::unexpected(picture.error());
      if (truth.empty()) {
        truth = reflection_truth((*stage)->scene, (*stage)->frame, run.software ? 144 : 256);
        nothing = difference({}, truth).error;
        const auto again = reflection_truth((*stage)->scene, (*stage)->frame, run.software ? 144 : 256, 2);
        chart.floor = difference(again, truth).error / nothing;
      }
      const Difference d = difference(*picture, truth);
      ChartPoint p;
      p.rung = s.name;
      p.label = s.label;
      p.error = d.error / nothing;
      p.mean_shift = d.shift;
      // tests/stability/reflections.cpp: ThePublishedStretchIgnoresElevation, ThePublishedEdgesRemoveGrazingLight.
      p.stable = s.rung != ReflectionRung::toyshop && s.label != "k_a";
      chart.points.push_back(p);
      done += 0.5 / (3.0 * static_cast<double>(settings().size()));
      if (run.progress) run.progress(done);
    }
    for (std::size_t i = 0; i < settings().size(); ++i) {
      const Setting& s = settings()[i];
      auto stage = ReflectionStage::make(passes, night_street(c.roughness), timed_width, timed_height, s.parameters);
      if (!stage) return tl::unexpected(stage.error());
      (*stage)->use(s.rung);
      std::vector<double> ms;
      for (int k = 0; k < repeats + 2; ++k) {
        const auto time = (*stage)->time(run.software);
        if (!time) return tl::unexpected(time.error());
        if (k >= 2) ms.push_back(*time);
      }
      chart.points[i].ms = quantile(ms, 0.5);
      chart.points[i].ms_p5 = quantile(ms, 0.05);
      chart.points[i].ms_p95 = quantile(ms, 0.95);
      done += 0.5 / (3.0 * static_cast<double>(settings().size()));
      if (run.progress) run.progress(done);
    }
    if (auto written = write_chart(run.folder, chart); !written) return written;
  }
  return {};
}

Result<std::vector<BenchRow>> bench_reflections(const MakePasses& passes, int width, int height, int frames,
                                                bool software_gl) {
  std::vector<BenchRow> rows;
  const std::string size = fmt::format("{}x{}", width, height);
  const Ladder ladder = reflections_ladder();
  auto stage = ReflectionStage::make(passes, night_street(0.22f), width, height);
  if (!stage) return tl::unexpected(stage.error());
  for (std::size_t rung = 1; rung < ladder.rungs.size(); ++rung) {
    (*stage)->use(static_cast<ReflectionRung>(rung));
    std::vector<double> ms;
    for (int i = 0; i < frames + 4; ++i) {
      const auto time = (*stage)->time(software_gl);
      if (!time) return tl::unexpected(time.error());
      if (i >= 4) ms.push_back(*time);
    }
    const double median = quantile(ms, 0.5);
    rows.push_back({"reflections/" + std::string(ladder.rungs[rung].name), "", size, median, quantile(ms, 0.95),
                    software_gl ? std::nullopt : std::optional<double>(median)});
  }
  return rows;
}

}  // namespace petrichor
