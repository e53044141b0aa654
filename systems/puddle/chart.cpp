// Standing water: depth by each rung against the height field's own balance, over an hour of showers.

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "engine/core/bench_row.hpp"
#include "systems/puddle/puddle.hpp"
#include "systems/puddle/stage.hpp"
#include "systems/puddle/street.hpp"
#include "systems/puddle/water.hpp"

namespace petrichor {
namespace {

constexpr std::array<ShowerPart, 7> showers{{{8, 3}, {10, 0}, {6, 20}, {14, 0}, {8, 6}, {6, 0}, {8, 1.5}}};
constexpr float drain_mm_per_hour = 15.0f;
constexpr double minute_s = 60.0, mps_of_mm_per_hour = 1e-3 / 3600.0;
constexpr float mask_depth_m = 0.05f;
constexpr int view_width = 640, view_height = 360;

struct Setting {
  PuddleRung rung;
  std::string label;
  PuddleShape shape;
  float mean_depth;  // 0: measured
  double step_s;
};

struct Bed {
  const StreetPatch& patch;
  std::vector<PuddleQuestion> places;  // every second cell along both sides that lies in a hollow
  std::vector<std::size_t> hollow;     // of each
  std::vector<double> below_brim_m;    // of each
};

Bed make_bed(const StreetPatch& patch) {
  Bed bed{patch, {}, {}, {}};
  for (int j = 0; j < patch.height; j += 2)
    for (int i = 0; i < patch.width; i += 2) {
      const std::size_t k = static_cast<std::size_t>(j * patch.width + i);
      const int n = patch.hollow_of[k];
      if (n < 0) continue;
      const double below = patch.hollows[static_cast<std::size_t>(n)].brim_m - patch.ground_m[k];
      bed.places.push_back({{(i + 0.5) * patch.cell_m, patch.ground_m[k], (j + 0.5) * patch.cell_m},
                            {static_cast<float>(below) / mask_depth_m, 1.0f / 255.0f}});
      bed.hollow.push_back(static_cast<std::size_t>(n));
      bed.below_brim_m.push_back(below);
    }
  return bed;
}

// A Puddle for each hollow that a person would mark: larger than a hand.
std::vector<std::pair<FramePuddles::Puddle, Puddle>> mark_puddles(const StreetPatch& patch, PuddleShape shape,
                                                                  float mean_depth, std::vector<std::size_t>& hollows) {
  std::vector<std::pair<FramePuddles::Puddle, Puddle>> out;
  for (std::size_t n = 0; n < patch.hollows.size(); ++n) {
    const StreetHollow& h = patch.hollows[n];
    const double area = static_cast<double>(h.cells.size()) * patch.cell_m * patch.cell_m;
    if (area < 0.02) continue;
    glm::dvec2 low(1e9), high(-1e9);
    for (const std::size_t k : h.cells) {
      const glm::dvec2 c((static_cast<double>(k % static_cast<std::size_t>(patch.width)) + 0.5) * patch.cell_m,
                         (static_cast<double>(k / static_cast<std::size_t>(patch.width)) + 0.5) * patch.cell_m);
      low = glm::min(low, c - patch.cell_m);
      high = glm::max(high, c + patch.cell_m);
    }
    Puddle p;
    p.size_m = high - low;
    p.maximum_depth_mm = static_cast<float>(1000.0 * (h.brim_m - h.deepest_m));
    p.area_share = static_cast<float>(area / (double(p.size_m.x) * double(p.size_m.y)));
    p.catchment_ratio = static_cast<float>(h.catchment_m2 / area);
    p.drain_mm_per_hour = drain_mm_per_hour;
    p.initial_fill = 0.0f;
    p.shape = shape;
    double volume = 0.0;
    for (const double ground : h.heights_m) volume += (h.brim_m - ground) * patch.cell_m * patch.cell_m;
    p.mean_depth_share = static_cast<float>(volume / (area * (h.brim_m - h.deepest_m)));
    if (mean_depth > 0.0f) p.mean_depth_share = mean_depth;
    FramePuddles::Puddle f;
    f.world_from_puddle[3] = glm::vec4(0.5 * (low.x + high.x), h.brim_m, 0.5 * (low.y + high.y), 1.0);
    f.half_size_m = 0.5f * p.size_m;
    f.depth_m = 1e-3f * p.maximum_depth_mm;
    out.emplace_back(f, p);
    hollows.push_back(n);
  }
  return out;
}

struct Run {
  double square = 0.0, truth_square = 0.0, bias_m = 0.0;
  double pass_ms = 0.0;
  std::vector<double> query_ms;
};

Result<Run> measure(PuddleStage& stage, const Bed& bed, const Setting& s) {
  std::vector<std::size_t> hollows;
  const auto marked = mark_puddles(bed.patch, s.shape, s.mean_depth, hollows);
  std::vector<PuddleWater> water;
  for (const auto& [frame, p] : marked) water.push_back(start_puddle(p, 0.0, 0.0));
  StreetTruth truth(bed.patch);
  Run run;
  std::size_t samples = 0;
  for (const ShowerPart& part : showers) {
    const double evaporation = part.rain_mm_per_hour > 0.0 ? 0.0 : 0.1;
    for (double minute = 0.0; minute < part.minutes; minute += 1.0) {
      truth.advance(minute_s, 0.5, part.rain_mm_per_hour * mps_of_mm_per_hour,
                    (double(drain_mm_per_hour) + evaporation) * mps_of_mm_per_hour);
      auto frame = std::make_shared<FramePuddles>();
      for (std::size_t i = 0; i < water.size(); ++i) {
        water[i].rain_mm_per_hour = part.rain_mm_per_hour;
        const double end = water[i].since_s + minute_s;
        while (water[i].since_s < end - 1e-9)
          water[i] = puddle_at(water[i], std::min(water[i].since_s + s.step_s, end));
        FramePuddles::Puddle f = marked[i].first;
        f.level_m = s.rung == PuddleRung::none    ? 0.0f
                    : s.rung == PuddleRung::masks ? f.depth_m
                                                  : static_cast<float>(water[i].depth_m);
        frame->any_water |= f.level_m > 0.0f;
        frame->puddles.push_back(f);
      }
      frame->published = s.rung == PuddleRung::masks ? 1.0f : 0.0f;
      stage.frame.puddles = std::move(frame);
      const auto answers = stage.ask(bed.places);
      if (!answers) return tl::unexpected(answers.error());
      for (std::size_t k = 0; k < bed.places.size(); ++k) {
        const StreetHollow& h = bed.patch.hollows[bed.hollow[k]];
        const double depth = std::max(bed.below_brim_m[k] - (h.brim_m - truth.level_m(bed.hollow[k])), 0.0);
        const double got = answers->empty() ? 0.0 : double((*answers)[k].depth_m);
        run.square += (got - depth) * (got - depth);
        run.truth_square += depth * depth;
        run.bias_m += got - depth;
        ++samples;
      }
    }
  }
  run.bias_m /= static_cast<double>(samples);
  return run;
}

// As many places as a picture has pixels, a fifth of them in hollows.
Result<void> time(PuddleStage& stage, const Bed& bed, Run& run) {
  std::vector<PuddleQuestion> places;
  for (int i = 0; i < view_width * view_height; ++i) {
    PuddleQuestion q = bed.places[static_cast<std::size_t>(i) % bed.places.size()];
    if ((i / 64) % 5 != 0) q.mask.x = 0.0f;
    places.push_back(q);
  }
  std::vector<double> passes;
  for (int i = 0; i < 12; ++i) {
    if (auto answers = stage.ask(places); !answers) return tl::unexpected(answers.error());
    if (i < 2) continue;
    run.query_ms.push_back(stage.query_ms() + stage.pass_ms());
    passes.push_back(stage.pass_ms());
  }
  run.pass_ms = quantile(passes, 0.5);
  return {};
}

}  // namespace

Result<void> chart_puddles(const ChartRun& run) {
  const StreetPatch patch = make_street_patch();
  const Bed bed = make_bed(patch);
  PuddleStage stage;
  stage.frame.camera.position_m = {4.0, 1.7, 3.0};
  WetMaterialGpu ground{{1.5f, 2.0f, 3.0f, mask_depth_m}, {1.0f, 1.0f, 0.0f, -1.0f}};
  stage.kinds = {WetMaterialGpu{}, ground};
  if (auto loaded = stage.load(); !loaded) return loaded;
  const std::vector<Setting> settings{
      {PuddleRung::masks, "always full", PuddleShape::bowl, 0.0f, minute_s},
      {PuddleRung::filled, "tub", PuddleShape::tub, 0.0f, minute_s},
      {PuddleRung::filled, "paraboloid", PuddleShape::bowl, 0.5f, minute_s},
      {PuddleRung::filled, "bowl, 60 s steps", PuddleShape::bowl, 0.0f, minute_s},
      {PuddleRung::filled, "bowl, 1/60 s steps", PuddleShape::bowl, 0.0f, 1.0 / 60.0}};
  Chart chart;
  chart.name = "puddles";
  chart.effect = "puddles";
  chart.title = "Standing water on 48 m2 of street, an hour of showers";
  chart.device = run.device;
  chart.width = view_width;
  chart.height = view_height;
  chart.error_label = "root mean square error of depth (no water: 1)";
  chart.x_label = "milliseconds for a picture of places, a fifth of it hollows";
  const auto names = puddles_ladder().rungs;
  double done = 0.0;
  for (const Setting& s : settings) {
    auto m = measure(stage, bed, s);
    if (!m) return tl::unexpected(m.error());
    if (auto timed = time(stage, bed, *m); !timed) return timed;
    ChartPoint p;
    p.rung = std::string(names[static_cast<std::size_t>(s.rung)].name);
    p.label = s.label;
    p.ms = quantile(m->query_ms, 0.5);
    p.ms_p5 = quantile(m->query_ms, 0.05);
    p.ms_p95 = quantile(m->query_ms, 0.95);
    p.error = std::sqrt(m->square / m->truth_square);
    p.more = {{"bias_mm", 1e3 * m->bias_m}, {"list_ms", m->pass_ms}, {"step_s", s.step_s}};
    chart.points.push_back(std::move(p));
    done += 1.0 / static_cast<double>(settings.size());
    if (run.progress) run.progress(done);
  }
  return write_chart(run.folder, chart);
}

}  // namespace petrichor
