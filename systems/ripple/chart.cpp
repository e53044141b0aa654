// Rungs of ripples against the exact solution.

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "engine/core/bench_row.hpp"
#include "systems/ripple/measure.hpp"
#include "systems/ripple/ripple.hpp"
#include "systems/ripple/truth.hpp"
#include "systems/ripple_frame.hpp"

namespace petrichor {
namespace {

struct Setting {
  RippleRung rung;
  const char *name, *label;
  int cells;
  float seed_cells = 3.0f;
  double rings = 0.0;
  bool published = false, low_eye = false, stable = true;
};

const std::vector<Setting>& settings() {
  // Hollow: what a test of tests/stability/ripples.cpp shows to fail.
  static const std::vector<Setting> all{
      {RippleRung::rings, "rings", "16 rings", 256, 3, 16},
      {RippleRung::rings, "rings", "48 rings", 256, 3, 48},
      {RippleRung::rings, "rings", "256 rings", 256, 3, 256},
      {RippleRung::rings, "rings", "all", 256, 3, 100000},
      {RippleRung::euler, "euler", "C = 0.67", 256, 3, 0, false, false, false},
      {RippleRung::verlet5, "verlet5", "64^2", 64},
      {RippleRung::verlet5, "verlet5", "128^2", 128},
      {RippleRung::verlet5, "verlet5", "256^2", 256},
      {RippleRung::verlet5, "verlet5", "published seeds, 16 bits", 256, 3, 0, true, false, false},
      {RippleRung::verlet9, "verlet9", "64^2", 64},
      {RippleRung::verlet9, "verlet9", "128^2", 128},
      {RippleRung::verlet9, "verlet9", "256^2, seed 2.2 cells", 256, 0},
      {RippleRung::verlet9, "verlet9", "256^2", 256},
      {RippleRung::verlet9, "verlet9", "256^2, seed 5 cells", 256, 5},
      {RippleRung::near_tile, "near_tile", "256^2 of 8 mm", 256},
      {RippleRung::near_tile, "near_tile", "256^2 of 8 mm, seed 1.5 cells", 256, 1.5f},
      {RippleRung::near_tile, "near_tile", "256^2 of 5 mm", 256, 3, 0, false, true}};
  return all;
}

std::unique_ptr<RippleStage> make_stage(const Setting& s, bool software, Result<void>& loaded) {
  auto stage = std::make_unique<RippleStage>();
  stage->software = software;
  stage->ripples().seed_cells = s.seed_cells;
  stage->ripples().published = s.published;
  stage->techniques.set(Effect::ripples, s.rung);
  if (s.low_eye) stage->look({0.0, 0.5, 2.0}, glm::normalize(glm::vec3(0, -0.5f, -1)));
  loaded = stage->load(s.cells, 3, s.rings);
  return stage;
}

constexpr double settled_s = 2.0, judged_s = 1.0;
constexpr int moments = 5;

}  // namespace

Result<void> chart_ripples(const ChartRun& run) {
  Chart chart;
  chart.name = chart.effect = "ripples";
  chart.title = "Rings on a puddle, 10 mm/h, against the exact solution of the same drops";
  chart.device = run.device;
  chart.width = chart.height = 256;
  chart.x_label = "milliseconds of the pass, two ticks a frame (median; bar 5% to 95%)";
  chart.error_label = "error: waves and repetition (still water: 1)";
  std::vector<std::unique_ptr<RippleStage>> stages;
  // The drops of the shared tile are the same for all: one truth for each number of cells and moment.
  std::map<int, std::vector<TrueSlopes>> truths;
  for (const Setting& s : settings()) {
    Result<void> loaded;
    stages.push_back(make_stage(s, run.software, loaded));
    if (!loaded) return loaded;
    RippleStage& stage = *stages.back();
    stage.run(settled_s);
    std::vector<std::int64_t> ticks;
    std::vector<std::vector<glm::vec4>> drawn_slopes;
    RippleError mean;
    for (int m = 0; m < moments; ++m) {
      stage.run(judged_s / moments);
      const Frame f = stage.frame();
      if (auto drawn = stage.draw(f); !drawn) return tl::unexpected(drawn.error());
      ticks.push_back(f.ripples->tick);
      drawn_slopes.push_back(stage.layer(0));
      if (m + 1 == moments && s.rung == RippleRung::near_tile)
        mean = near_error(stage, f, true_near_slopes(*f.ripples, s.cells, 2.0));
    }
    const Frame last = stage.frame();
    if (truths[s.cells].empty()) truths[s.cells] = true_shared_slopes(*last.ripples, s.cells, ticks);
    double shared_waves = 0.0, shared_strength = 0.0;
    for (int m = 0; m < moments; ++m) {
      const RippleError e = shared_error(drawn_slopes[static_cast<std::size_t>(m)],
                                         truths[s.cells][static_cast<std::size_t>(m)], s.cells);
      shared_waves += e.waves / moments;
      shared_strength += e.strength / moments;
    }
    if (s.rung != RippleRung::near_tile) mean = {shared_waves, 1.0, shared_strength};
    ChartPoint p;
    p.rung = s.name;
    p.label = s.label;
    p.error = std::sqrt(0.5 * (mean.waves * mean.waves + mean.repeats * mean.repeats));
    p.stable = s.stable;
    p.more = {{"cells", s.cells},        {"seed_cells", s.seed_cells}, {"waves", mean.waves},
              {"repeats", mean.repeats}, {"strength", mean.strength},  {"waves_of_shared_tile", shared_waves}};
    chart.points.push_back(std::move(p));
    if (run.progress) run.progress(0.7 * static_cast<double>(stages.size()) / static_cast<double>(settings().size()));
  }
  // By turns, so that whatever else the machine does falls on all alike.
  std::vector<std::vector<double>> times(settings().size());
  const int frames = run.software ? 40 : 300;
  for (int i = 0; i < frames; ++i) {
    for (std::size_t k = 0; k < stages.size(); ++k) {
      stages[k]->tick();
      stages[k]->tick();
      const auto ms = stages[k]->draw(stages[k]->frame());
      if (!ms) return tl::unexpected(ms.error());
      if (i > 2) times[k].push_back(*ms);
    }
    if (run.progress) run.progress(0.7 + 0.3 * (i + 1) / frames);
  }
  for (std::size_t k = 0; k < stages.size(); ++k) {
    chart.points[k].ms = quantile(times[k], 0.5);
    chart.points[k].ms_p5 = quantile(times[k], 0.05);
    chart.points[k].ms_p95 = quantile(times[k], 0.95);
  }
  return write_chart(run.folder, chart);
}

}  // namespace petrichor
