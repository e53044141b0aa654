#include "systems/occlusion/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "engine/core/bench_row.hpp"
#include "engine/core/log.hpp"
#include "engine/core/paths.hpp"
#include "systems/occlusion/section.hpp"
#include "systems/occlusion/stage.hpp"
#include "systems/occlusion/street.hpp"

namespace petrichor {
namespace {

struct Setting {
  OcclusionRung rung;
  int maps;
  std::string name, label;
};

const std::vector<Setting>& settings() {
  static const std::vector<Setting> all{
      {OcclusionRung::vertical, 1, "vertical", ""},       {OcclusionRung::tilted, 1, "tilted", ""},
      {OcclusionRung::jittered, 1, "jittered", "K = 1"},  {OcclusionRung::jittered, 2, "jittered", "K = 2"},
      {OcclusionRung::jittered, 4, "jittered", "K = 4"},  {OcclusionRung::jittered, 8, "jittered", "K = 8"},
      {OcclusionRung::jittered, 16, "jittered", "K = 16"}};
  return all;
}

constexpr std::array<double, 4> times_s{2.0, 6.1, 11.3, 17.9};  // moments of the wind at which the maps are judged
constexpr int truth_moments = 40;

struct Case {
  std::string name;  // of the column
  std::vector<ShelterQuestion> places;
  std::vector<float> truth;    // share of the water kept away
  std::vector<float> deposit;  // that settles
};

void find_truth(Case& c, const ShelterRays& rays, const std::vector<FallTruth>& falls) {
  for (const ShelterQuestion& q : c.places) {
    float kept = 0.0f, settled = 0.0f;
    for (const FallTruth& f : falls) {
      const float facing = -glm::dot(q.normal, f.velocity_mps) / -f.velocity_mps.y;
      const bool hidden = facing <= 0.0f || rays.sheltered(q.place_m, f.velocity_mps);
      kept += hidden ? f.water : 0.0f;
      settled += hidden ? 0.0f : f.water * facing;
    }
    c.truth.push_back(kept);
    c.deposit.push_back(settled);
  }
}

double rms(const std::vector<double>& squares) {
  double sum = 0.0;
  for (const double s : squares) sum += s;
  return squares.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(squares.size()));
}

struct Measured {
  std::vector<double> shelter, deposit;  // a case each: root mean square error
  double drops = 0.0;                    // share of single drops misjudged
  double redraws_per_s = 0.0;
};

struct Weather {
  const RainAt& rain_at;
  Emitter emitter;
  Wind wind;
  void set(Frame& frame, double time_s) const {
    frame.time_s = time_s;
    frame.wind = wind;
    frame.rain = rain_at(emitter, wind, time_s);
  }
};

// Drops of all drawn classes in the air over the places, as they fall at a moment: are they where a ray says?
double misjudged_drops(OcclusionStage& stage, const ShelterRays& rays, const std::vector<ShelterQuestion>& below) {
  std::vector<ShelterQuestion> drops;
  std::vector<double> weights;
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  for (const ShelterQuestion& q : below) {
    for (const RainClass& c : stage.frame.rain->classes) {
      if (!c.drawn || random() % 4 != 0) continue;
      drops.push_back({q.place_m + glm::vec3(0, 2.9f * unit(random), 0), q.normal, c.velocity_mps});
      weights.push_back(c.drops_per_m3);
    }
  }
  const auto answers = stage.ask(drops);
  if (!answers) return NAN;
  double wrong = 0.0, all = 0.0;
  for (std::size_t i = 0; i < drops.size(); ++i) {
    all += weights[i];
    if ((*answers)[i].sheltered_velocity != rays.sheltered(drops[i].place_m, drops[i].velocity_mps))
      wrong += weights[i];
  }
  return wrong / all;
}

Result<void> load(OcclusionStage& stage, const Setting& setting, int texels) {
  stage.frame.techniques.set(Effect::occlusion, setting.rung);
  return stage.load(texels, setting.rung == OcclusionRung::jittered ? setting.maps : 1,
                    {{"maps", static_cast<double>(setting.maps)}});
}

Result<Measured> measure(OcclusionStage& stage, const Setting& setting, const Weather& weather, const ShelterRays& rays,
                         const std::vector<Case>& cases, int texels) {
  if (auto loaded = load(stage, setting, texels); !loaded) return tl::unexpected(loaded.error());
  Measured m;
  for (const Case& c : cases) {
    std::vector<double> shelter, deposit;
    for (const double time_s : times_s) {
      weather.set(stage.frame, time_s);
      const auto answers = stage.ask(c.places);
      if (!answers) return tl::unexpected(answers.error());
      for (std::size_t i = 0; i < c.places.size(); ++i) {
        const ShelterAnswer& a = (*answers)[i];
        shelter.push_back(std::pow(double(a.shelter_normal) - c.truth[i], 2));
        deposit.push_back(std::pow(double(a.deposit) - c.deposit[i], 2));
      }
    }
    m.shelter.push_back(rms(shelter));
    m.deposit.push_back(rms(deposit));
  }
  for (const double time_s : times_s) {
    weather.set(stage.frame, time_s);
    m.drops += misjudged_drops(stage, rays, cases.front().places) / times_s.size();
  }
  // How often gusts make them stale, at 30 frames a second.
  constexpr int frames = 300;
  for (int i = 0; i < frames; ++i) {
    weather.set(stage.frame, 20.0 + i / 30.0);
    if (auto asked = stage.ask({cases.front().places.front()}); !asked) return tl::unexpected(asked.error());
    if (i > 0) m.redraws_per_s += stage.redrawn() * 30.0 / (frames - 1);
  }
  return m;
}

Result<void> chart_scene(const ChartRun& run, OcclusionStage& stage, const Weather& weather, std::vector<Case> cases,
                         const std::string& name, const std::string& title, double from, double to) {
  const auto rays = stage.rays();
  const std::vector<FallTruth> falls = falls_over_time(weather.rain_at, weather.emitter, weather.wind, truth_moments);
  for (Case& c : cases) find_truth(c, rays, falls);
  Chart chart;
  chart.name = name;
  chart.effect = "occlusion";
  chart.device = run.device;
  chart.width = chart.height = 1024;
  std::vector<double> off;
  for (const float t : cases.front().truth) off.push_back(double(t) * t);
  chart.title = title;
  chart.x_label = "milliseconds to redraw the maps";
  chart.error_label =
      fmt::format("root mean square error of the share of rain kept away (no shelter: {:.2f})", rms(off));
  double done = from;
  for (const Setting& s : settings()) {
    auto m = measure(stage, s, weather, rays, cases, chart.width);
    if (!m) return tl::unexpected(m.error());
    ChartPoint p;
    p.rung = s.name;
    p.label = s.label;
    p.error = m->shelter.front();
    // tests/stability/occlusion.cpp: TheVerticalMapFailsAsTheWindRises, OneTiltedMapLetsSmallDropsUnderAnAwning.
    p.stable = s.rung == OcclusionRung::jittered;
    p.more = {
        {"maps", s.maps}, {"ns_per_place", 0.0}, {"redraws_per_s", m->redraws_per_s}, {"drops_misjudged", m->drops}};
    for (std::size_t i = 0; i < cases.size(); ++i) {
      p.more.emplace_back("shelter_" + cases[i].name, m->shelter[i]);
      p.more.emplace_back("deposit_" + cases[i].name, m->deposit[i]);
    }
    chart.points.push_back(std::move(p));
    done += (to - from) / static_cast<double>(settings().size());
    if (run.progress) run.progress(done);
  }
  // By turns, so that whatever else the machine does falls on all alike.
  std::vector<std::vector<double>> maps(settings().size()), queries(settings().size());
  for (int round = 0; round < 5; ++round) {
    for (std::size_t i = 0; i < settings().size(); ++i) {
      if (auto loaded = load(stage, settings()[i], chart.width); !loaded) return loaded;
      const auto cost = stage.time(cases.front().places, 3);
      if (!cost) return tl::unexpected(cost.error());
      maps[i].insert(maps[i].end(), cost->maps_ms.begin(), cost->maps_ms.end());
      queries[i].insert(queries[i].end(), cost->query_ns.begin(), cost->query_ns.end());
    }
  }
  for (std::size_t i = 0; i < chart.points.size(); ++i) {
    ChartPoint& p = chart.points[i];
    p.ms = quantile(maps[i], 0.5);
    p.ms_p5 = quantile(maps[i], 0.05);
    p.ms_p95 = quantile(maps[i], 0.95);
    p.more[1].second = quantile(queries[i], 0.5);
  }
  return write_chart(run.folder, chart);
}

// Places on the ground, roofs and sills of the town that face up, found by rays from above a part of its streets.
std::vector<ShelterQuestion> city_places(const ShelterRays& rays, glm::vec2 low, glm::vec2 high, int count) {
  std::vector<ShelterQuestion> places;
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  for (int tries = 0; static_cast<int>(places.size()) < count && tries < 20 * count; ++tries) {
    const glm::vec3 from(low.x + (high.x - low.x) * unit(random), 0.6f + 5.0f * unit(random),
                         low.y + (high.y - low.y) * unit(random));
    const float down = rays.distance_m(from, {0, -1, 0});
    if (!(down < 8.0f)) continue;
    const glm::vec3 at = from - glm::vec3(0, down, 0);
    // Level ground alone, and none inside a house: the same height a little further, and the sky not walled in.
    const auto height = [&](float x, float z) { return down - rays.distance_m(from + glm::vec3(x, 0, z), {0, -1, 0}); };
    if (std::abs(height(0.1f, 0)) > 0.01f || std::abs(height(0, 0.1f)) > 0.01f) continue;
    int open = 0;
    for (int i = 0; i < 16; ++i) {
      const float a = 0.3927f * static_cast<float>(i);
      open += std::isinf(
          rays.distance_m(at + glm::vec3(0, 0.3f, 0), glm::normalize(glm::vec3(std::cos(a), 0.5f, std::sin(a)))));
    }
    if (open > 1) places.push_back({at});
  }
  return places;
}

}  // namespace

std::vector<FallTruth> falls_over_time(const RainAt& rain_at, const Emitter& emitter, const Wind& wind, int moments) {
  std::vector<FallTruth> falls;
  float water = 0.0f;
  for (int i = 0; i < moments; ++i) {
    const FrameRain rain = rain_at(emitter, wind, 100.0 + 3.7320508 * i);
    for (const RainClass& c : rain.classes) {
      falls.push_back(
          {c.velocity_mps, c.drops_per_m3 * c.diameter_mm * c.diameter_mm * c.diameter_mm * c.fall_speed_mps});
      water += falls.back().water;
    }
  }
  for (FallTruth& f : falls) f.water /= water;
  return falls;
}

Result<void> chart_occlusion(const ChartRun& run, const RainAt& rain_at) {
  Weather weather{rain_at, {}, {}};
  weather.emitter.rain_mm_per_hour = 10.0f;
  weather.wind.velocity_mps = {5.0f, 0.0f, 0.0f};
  weather.wind.gust_mps = 1.5f;
  weather.wind.swirl_mps = 0.75f;
  {
    OcclusionStage stage;
    stage.add_placed(shelter_street());
    std::vector<Case> cases;
    for (const char* where : {"awning", "house", "walls", "bridge", "arcade"})
      cases.push_back({where, shelter_places(where, 0.31f), {}, {}});
    if (auto done = chart_scene(run, stage, weather, std::move(cases), "occlusion",
                                "Shelter under a roof at 3 m, rain of 10 mm/h in 5 m/s of wind with gusts", 0.0, 0.5);
        !done)
      return done;
    weather.set(stage.frame, times_s.front());
    const auto falls = falls_over_time(rain_at, weather.emitter, weather.wind, 12);
    if (auto drawn = draw_shelter_section(run, stage, falls); !drawn) return drawn;
  }
  const auto file = find_data("content/city.glb");
  if (!file) {
    log_warn("no content/city.glb: the chart of the town is left out");
    return {};
  }
  auto model = load_model(*file);
  if (!model) return tl::unexpected(model.error());
  OcclusionStage stage;
  stage.add_placed(std::make_shared<const Model>(std::move(*model)));
  stage.frame.camera.position_m = {8.0, 1.7, 0.0};
  std::vector<Case> cases{{"town", city_places(stage.rays(), {-14.0f, -30.0f}, {32.0f, 30.0f}, 3000), {}, {}}};
  return chart_scene(run, stage, weather, std::move(cases), "occlusion-city",
                     "Shelter in the streets of the town, rain of 10 mm/h in 5 m/s of wind with gusts", 0.5, 1.0);
}

}  // namespace petrichor
