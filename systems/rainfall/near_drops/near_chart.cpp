#include "systems/rainfall/near_drops/near_chart.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "systems/gpu_scene.hpp"
#include "systems/rainfall/extract.hpp"
#include "systems/rainfall/near_drops/near_street.hpp"
#include "systems/rainfall/near_drops/near_truth.hpp"
#include "systems/rainfall/stage.hpp"

namespace petrichor {
namespace {

constexpr glm::dvec3 eye_m{0.0, 1.6, 0.0};

struct Set {
  std::unique_ptr<RainStage> stage;
  GpuScene scene;
  NearStreet street = make_near_street();
};

Result<std::unique_ptr<Set>> make_set(bool software) {
  auto set = std::make_unique<Set>();
  StageSet stage;
  stage.present = false;
  stage.wall_cd_m2 = glm::vec3(0.05f);
  stage.wall_distance_m = 40.0f;
  stage.wall_hides = true;
  stage.fog = false;
  auto made = RainStage::make(software, stage);
  if (!made) return tl::unexpected(made.error());
  set->stage = std::move(*made);
  return set;
}

Frame rain_frame(Set& set, const Frame* first, int width, int height, float rate, float reach_m, double time_s) {
  Frame f = stage_frame(width, height, eye_m);
  if (first) {
    f.instances = first->instances;
    f.scene = first->scene;
    f.sky = first->sky;
    f.geometry_version = f.lights_version = 1;
  } else {
    enter_street(set.street, set.scene, f);
  }
  f.camera.exposure_ev100 = 3.0f;
  f.time_s = time_s;
  Emitter emitter;
  emitter.rain_mm_per_hour = rate;
  emitter.maximum_drops = 400000000;
  emitter.drawn_distance_m = reach_m;
  f.rain = make_frame_rain(emitter, start_rain_motion(emitter, {}), f.camera, width, height, time_s);
  f.rain->techniques.set(Effect::rainfall, RainRung::near_drops);
  return f;
}

// Milliseconds of the named passes together, of each profiled frame.
Result<std::vector<double>> time_passes(Set& set, Frame& frame, int frames,
                                        std::initializer_list<std::string_view> names) {
  std::vector<double> all;
  FrameTimer& timer = set.stage->timer();
  for (int i = 0; i < frames + 3; ++i) {
    ++frame.number;
    timer.begin_frame(true);
    if (auto drawn = set.stage->draw(frame); !drawn) return tl::unexpected(drawn.error());
    timer.end_frame();
    glFinish();
    const std::vector<Timing> timings = timer.collect();
    double sum = 0.0;
    for (const Timing& t : timings)
      if (std::find(names.begin(), names.end(), t.name) != names.end()) sum += t.milliseconds;
    if (i >= 3 && !timings.empty()) all.push_back(sum);
  }
  return all;
}

struct Setting {
  NearDropRung rung;
  const char* name;
  const char* label;
  int cells, pixels;
  bool published, parallax, stable;
};

}  // namespace

Result<void> chart_near_drops(const ChartRun& run) {
  const int width = run.software ? 320 : 1280, height = run.software ? 180 : 720, drops = run.software ? 40 : 120;
  auto made = make_set(run.software);
  if (!made) return tl::unexpected(made.error());
  Set& set = **made;
  const World world = street_world(set.street);
  Chart chart;
  chart.name = chart.effect = "near_drops";
  chart.title = "Near drops, 100 mm/h, a street at night";
  chart.device = run.device;
  chart.width = width;
  chart.height = height;
  // Hollow: what a test of tests/stability/near_drops.cpp shows to fail.
  const Setting settings[] = {
      {NearDropRung::maps, "maps", "as printed, 20^3 x 32^2", 20, 32, true, true, false},
      {NearDropRung::maps, "maps", "10^3 x 8^2", 10, 8, false, true, true},
      {NearDropRung::maps, "maps", "20^3 x 8^2", 20, 8, false, true, true},
      {NearDropRung::maps, "maps", "20^3 x 16^2", 20, 16, false, true, true},
      {NearDropRung::maps, "maps", "40^3 x 8^2", 40, 8, false, true, true},
      {NearDropRung::closed_form, "closed_form", "world at infinity", 20, 16, false, false, false},
      {NearDropRung::closed_form, "closed_form", "", 20, 16, false, true, true}};
  const Frame first = rain_frame(set, nullptr, width, height, 100.0f, 8.0f, 20.0);
  double off = 0.0, done = 0.0;
  for (const Setting& s : settings) {
    Frame f = rain_frame(set, &first, width, height, 100.0f, 8.0f, 20.0);
    f.camera.exposure_s = 1.0f / 60.0f;
    f.rain->near_drops.least_width_px = run.software ? 0.4f : 1.0f;
    f.rain->near_drops.map_cells = s.cells;
    f.rain->near_drops.map_pixels = s.pixels;
    f.rain->near_drops.published = s.published;
    f.rain->near_drops.parallax = s.parallax;
    f.rain->techniques.set(Effect::near_drops, s.rung);
    if (auto drawn = set.stage->draw(f); !drawn) return tl::unexpected(drawn.error());
    const NearComparison c = compare_columns(world, f, read_near_list(), drops);
    if (s.rung == NearDropRung::closed_form) off = c.off;
    // Cells are kept while the camera stands: it sways by a millimetre, so that they are made anew as when it walks.
    std::vector<double> times;
    for (int i = 0; i < 6; ++i) {
      f.camera.position_m.x = eye_m.x + 1e-3 * (i & 1);
      auto some = time_passes(set, f, 2, {"near_environment", "near_drops"});
      if (!some) return tl::unexpected(some.error());
      times.insert(times.end(), some->begin(), some->end());
    }
    chart.points.push_back({s.name,
                            s.label,
                            quantile(times, 0.5),
                            quantile(times, 0.05),
                            quantile(times, 0.95),
                            c.off > 0.0 ? c.error / c.off : 0.0,
                            c.true_mean > 0.0 ? c.mean / c.true_mean - 1.0 : 0.0,
                            s.stable,
                            {{"drops", static_cast<double>(c.drops)},
                             {"megabytes", s.rung == NearDropRung::maps
                                               ? std::pow(s.cells, 3) * s.pixels * s.pixels * 4e-6 * NEAR_MAP_WORDS
                                               : sizeof(glm::vec4) * (NEAR_CURVE + 1) * 1e-6}}});
    done += 1.0;
    if (run.progress) run.progress(done / std::size(settings));
  }
  // Drops of one colour cost what the field's capsules do: nothing beside it.
  Frame f = rain_frame(set, &first, width, height, 100.0f, 8.0f, 20.0);
  f.rain->techniques.set(Effect::near_drops, NearDropRung::off);
  auto none = time_passes(set, f, 4, {"near_environment", "near_drops"});
  if (!none) return tl::unexpected(none.error());
  chart.points.insert(chart.points.begin(), {"off",
                                             "one colour a drop",
                                             std::max(quantile(*none, 0.5), 1e-3),
                                             1e-3,
                                             1e-3,
                                             off > 0.0 ? 1.0 : 0.0,
                                             0.0,
                                             true,
                                             {{"drops", 0.0}, {"megabytes", 0.0}}});
  return write_chart(run.folder, chart);
}

Result<std::vector<BenchRow>> bench_near_drops(int frames, bool software_gl) {
  const int width = software_gl ? 640 : 1280, height = software_gl ? 360 : 720;
  const std::string size = std::to_string(width) + "x" + std::to_string(height);
  auto made = make_set(software_gl);
  if (!made) return tl::unexpected(made.error());
  Set& set = **made;
  const Frame first = rain_frame(set, nullptr, width, height, 50.0f, 12.0f, 20.0);
  std::vector<BenchRow> rows;
  const auto add = [&](const std::string& name, const std::string& n, const std::vector<double>& times) {
    BenchRow row{name, n, size, quantile(times, 0.5), quantile(times, 0.95), std::nullopt};
    if (!software_gl) row.gpu_median_ms = row.median_ms;
    rows.push_back(std::move(row));
  };
  for (const NearDropRung rung : {NearDropRung::closed_form, NearDropRung::maps})
    for (const bool streaks : {true, false})
      for (const int n : {1000, 5000, 10000, 20000, 50000}) {
        Frame f = rain_frame(set, &first, width, height, 50.0f, 12.0f, 20.0);
        f.camera.exposure_s = streaks ? 1.0f / 60.0f : 1e-4f;
        f.rain->techniques.set(Effect::near_drops, rung);
        // As wide as so many drops are, on average.
        f.rain->near_drops.least_width_px = 0.05f;
        f.rain->near_drops.most_drops = n;
        const std::string name = std::string("near_drops/") + (rung == NearDropRung::maps ? "maps" : "closed_form") +
                                 (streaks ? "/streaks" : "/drops");
        auto times = time_passes(set, f, frames, {"near_drops"});
        if (!times) return tl::unexpected(times.error());
        add(name, std::to_string(near_stats().drops), *times);
      }
  // The camera steps to and fro between two places of the grid: a capture a frame.
  std::vector<double> captures;
  Frame f = rain_frame(set, &first, width, height, 50.0f, 12.0f, 20.0);
  for (int i = 0; i < std::min(frames, 20); ++i) {
    f.camera.position_m.z = (i & 1) ? -2.0 : 0.0;
    set.stage->timer().begin_frame(true);
    if (auto drawn = set.stage->draw(f); !drawn) return tl::unexpected(drawn.error());
    set.stage->timer().end_frame();
    glFinish();
    for (const Timing& t : set.stage->timer().collect())
      if (t.name == "near_environment") captures.push_back(t.milliseconds);
  }
  add("near_drops/capture", "1", captures);
  return rows;
}

}  // namespace petrichor
