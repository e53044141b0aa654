#include "systems/wetness/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "components/water.hpp"
#include "engine/core/bench_row.hpp"
#include "systems/drops/drop_physics.hpp"
#include "systems/drops/drop_sizes.hpp"
#include "systems/wetness/history.hpp"
#include "systems/wetness/optics.h"
#include "systems/wetness/stage.hpp"
#include "systems/wetness/wetness.hpp"
#include "systems/wind_motion.hpp"

namespace petrichor {
namespace {

constexpr float dry_albedo = 0.2f, dry_roughness = 0.5f;  // by its roughness it takes a film, and has no pores
constexpr double long_s = 600.0, short_s = 90.0;          // of rain in the first wind; then in the second
constexpr int gust_moments = 24, every = 5;               // pixels that are traced

struct Rain {
  Emitter emitter;
  Wind wind;
};

struct Fall {
  glm::vec3 velocity_mps;
  double water;  // share
};

std::vector<Fall> all_falls(const Rain& rain) {
  std::vector<double> responses;
  const auto classes = make_drop_classes(rain.emitter);
  for (const DropClass& c : classes) responses.push_back(wind_response_s(c.fall_speed_mps));
  const WindMotion motion = start_wind_motion(rain.wind, responses);
  std::vector<Fall> falls;
  double water = 0.0;
  for (int i = 0; i < gust_moments; ++i) {
    for (std::size_t k = 0; k < classes.size(); ++k) {
      const glm::dvec3 wind = drift_at(motion, k, 100.0 + 3.7320508 * i).velocity_mps;
      falls.push_back(
          {glm::vec3(wind - glm::dvec3(0.0, classes[k].fall_speed_mps, 0.0)), rain_mm_per_hour(classes[k])});
      water += falls.back().water;
    }
  }
  for (Fall& f : falls) f.water /= water;
  return falls;
}

double exposure_of(const std::vector<Fall>& falls, const WetTruth::Sheltered& sheltered, const glm::vec3& place,
                   const glm::vec3& normal) {
  double sum = 0.0;
  for (const Fall& f : falls) {
    const float facing = -glm::dot(normal, f.velocity_mps) / -f.velocity_mps.y;
    if (facing > 0.0f && !sheltered(place, f.velocity_mps)) sum += f.water * facing;
  }
  return sum;
}

// In steps of 10 ms.
double fine_film_m(double film_m, double supply_mps, double drain, double seconds) {
  constexpr double step_s = 0.01;
  for (long i = 0; i < std::lround(seconds / step_s); ++i)
    film_m = std::max(film_m + step_s * (supply_mps - drain * film_m * film_m * film_m), 0.0);
  return film_m;
}

double fresnel_from_water(double cosine) {
  const double sine = 1.333 * std::sqrt(1.0 - cosine * cosine);
  if (sine >= 1.0) return 1.0;
  const double t = std::sqrt(1.0 - sine * sine);
  const double s = (1.333 * cosine - t) / (1.333 * cosine + t), p = (1.333 * t - cosine) / (1.333 * t + cosine);
  return 0.5 * (s * s + p * p);
}

// Light that is under a smooth film comes out of it again: share, by photons.
double traced_base(double albedo) {
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double out = 0.0;
  constexpr int photons = 200000;
  for (int i = 0; i < photons; ++i) {
    for (double weight = 1.0; weight > 1e-6;) {
      weight *= albedo;
      const double back = fresnel_from_water(std::sqrt(unit(random)));
      out += weight * (1.0 - back);
      weight *= back;
    }
  }
  // Shading takes the surface's share of what goes out away by the angle of view (optics.h).
  return out / photons / (1.0 - wetness::WATER_RE);
}

struct View {
  glm::dvec3 eye;
  glm::vec3 at;
};

struct Traced {
  std::size_t view, pixel;
  double film_m, shade;  // wet over dry
};

void look(Frame& frame, const View& view) {
  frame.camera.position_m = view.eye;
  const glm::vec3 ahead = glm::normalize(view.at - glm::vec3(view.eye));
  frame.camera.orientation = glm::quatLookAt(ahead, glm::vec3(0.0f, 1.0f, 0.0f));
  frame.camera.vertical_fov_rad = 1.0f;
}

struct Setting {
  WetnessRung rung;
  OcclusionRung shelter;
  bool published, stable;
  const char *name, *label;
};

constexpr std::array<Setting, 7> settings{
    {{WetnessRung::none, OcclusionRung::tilted, false, true, "none", ""},
     {WetnessRung::everywhere, OcclusionRung::tilted, true, true, "everywhere", "as published"},
     {WetnessRung::everywhere, OcclusionRung::tilted, false, true, "everywhere", ""},
     {WetnessRung::sheltered, OcclusionRung::vertical, false, false, "sheltered", "by a vertical map"},
     {WetnessRung::sheltered, OcclusionRung::tilted, false, true, "sheltered", "by one map"},
     {WetnessRung::sheltered, OcclusionRung::jittered, false, true, "sheltered", "by eight maps"},
     {WetnessRung::flowing, OcclusionRung::tilted, false, true, "flowing", "by one map"}}};

void set_weather(Frame& frame, const WetnessHistory& history, const WetGround& ground, double time_s) {
  auto wet = std::const_pointer_cast<FrameWetness>(make_frame_wetness(history, ground, time_s));
  frame.rain = wet->rain;  // as it falls now
  frame.wind = history.wind;
  frame.wetness = wet;
  frame.time_s = time_s;
}

Result<void> chart_weather(const ChartRun& run, const WetTruth& truth, WetStage& stage,
                           const std::vector<Rain>& weather, const std::string& name, const std::string& title,
                           double from, double to) {
  const std::array<View, 2> views{{{{9.0, 2.2, 7.0}, {0.0f, 0.5f, 0.0f}}, {{14.0, 4.0, -16.0}, {2.0f, 1.0f, -27.0f}}}};
  WetGround ground;
  ground.initial_wetness = 0.0f;
  const std::array<double, 2> seconds{long_s, short_s};
  WetnessHistory history = start_wetness(weather[0].emitter, weather[0].wind, ground, 0.0);
  double time_s = 0.0;
  for (std::size_t i = 0; i < weather.size(); ++i)
    for (const double end = time_s + seconds[i]; time_s < end;)
      follow_rain(history, weather[i].emitter, weather[i].wind, ground, time_s += 0.5);

  // The truth, for every few pixels.
  stage.frame.techniques.set(Effect::wetness, WetnessRung::none);
  stage.frame.wetness.reset();
  const auto sheltered = truth.rays(stage.models(), stage.frame.instances);
  std::vector<std::vector<Fall>> falls;
  for (const Rain& r : weather) falls.push_back(all_falls(r));
  const double under_film = traced_base(dry_albedo) / dry_albedo;
  std::vector<Traced> traced;
  double off = 0.0, off_film = 0.0;
  for (std::size_t v = 0; v < views.size(); ++v) {
    look(stage.frame, views[v]);
    const auto dry = stage.draw();
    if (!dry) return tl::unexpected(dry.error());
    for (int y = 2; y < dry->height; y += every) {
      for (int x = 2; x < dry->width; x += every) {
        const auto at = static_cast<std::size_t>(y * dry->width + x);
        if (!(dry->depth[at] > 0.0f)) continue;
        const glm::vec2 ndc(2.0f * (static_cast<float>(x) + 0.5f) / static_cast<float>(dry->width) - 1.0f,
                            2.0f * (static_cast<float>(y) + 0.5f) / static_cast<float>(dry->height) - 1.0f);
        const glm::vec4 h = stage.frame.uniforms.inverse_view_projection * glm::vec4(ndc, dry->depth[at], 1.0f);
        const glm::vec3 place = glm::vec3(views[v].eye) + glm::vec3(h) / h.w;
        const glm::vec2 o = glm::vec2(dry->normal[at]) * 2.0f - 1.0f;
        glm::vec3 n(o, 1.0f - std::abs(o.x) - std::abs(o.y));
        const float fold = std::max(-n.z, 0.0f);
        n = glm::normalize(n + glm::vec3(n.x >= 0.0f ? -fold : fold, n.y >= 0.0f ? -fold : fold, 0.0f));
        const double drain = film_law(0, 0).drain_per_m2s / film_slopes[0] *
                             std::max(std::sqrt(1.0 - n.y * n.y), double(film_slopes[0]));
        double film = 0.0;
        for (std::size_t i = 0; i < weather.size(); ++i)
          film = fine_film_m(
              film, exposure_of(falls[i], sheltered, place, n) * weather[i].emitter.rain_mm_per_hour * 1e-3 / 3600.0,
              drain, seconds[i]);
        const double wetted = wetness::wetted_share(static_cast<float>(film));
        traced.push_back({v, at, film, 1.0 + wetted * (under_film - 1.0)});
        off += std::pow(1.0 - traced.back().shade, 2);
        off_film += film * film;
      }
    }
  }

  Chart chart;
  chart.name = name;
  chart.effect = "wetness";
  chart.title = title;
  chart.device = run.device;
  chart.width = stage.frame.width;
  chart.height = stage.frame.height;
  for (const Setting& s : settings) {
    stage.frame.techniques.set(Effect::wetness, s.rung);
    stage.frame.techniques.set(Effect::occlusion, s.shelter);
    ground.published = s.published;
    set_weather(stage.frame, history, ground, time_s);
    double sum = 0.0, sum_film = 0.0;
    std::vector<double> ms;
    for (std::size_t v = 0; v < views.size(); ++v) {
      look(stage.frame, views[v]);
      const auto got = stage.draw();
      if (!got) return tl::unexpected(got.error());
      for (const Traced& t : traced) {
        if (t.view != v) continue;
        const double stored = got->albedo[t.pixel].x;
        sum += std::pow(stored * stored / dry_albedo - t.shade, 2);
        sum_film += std::pow(1e-3 * got->water[t.pixel].y - t.film_m, 2);
      }
      if (s.rung == WetnessRung::none) continue;
      const auto some = stage.time(12, run.software);
      if (!some) return tl::unexpected(some.error());
      ms.insert(ms.end(), some->begin(), some->end());
    }
    if (ms.empty()) ms.push_back(0.0);
    chart.points.push_back({s.name,
                            s.label,
                            quantile(ms, 0.5),
                            quantile(ms, 0.05),
                            quantile(ms, 0.95),
                            std::sqrt(sum / off),
                            0.0,
                            s.stable,
                            {{"film_error", std::sqrt(sum_film / off_film)}}});
    if (run.progress)
      run.progress(from +
                   (to - from) * static_cast<double>(chart.points.size()) / static_cast<double>(settings.size()));
  }
  return write_chart(run.folder, chart);
}

}  // namespace

Result<void> chart_wetness(const ChartRun& run, const WetTruth& truth) {
  auto street = std::make_shared<Model>(*truth.street);
  for (Material& m : street->materials) {
    m.base_colour = glm::vec4(glm::vec3(dry_albedo), 1.0f);
    m.roughness = dry_roughness;
    m.metallic = 0.0f;
  }
  WetStage stage;
  stage.add(street);
  stage.frame.width = run.software ? 320 : 1024;
  stage.frame.height = run.software ? 180 : 768;
  if (auto loaded = stage.load(truth.passes, 9); !loaded) return loaded;
  Rain rain;
  rain.emitter.rain_mm_per_hour = 10.0f;
  rain.wind.velocity_mps = {5.0f, 0.0f, 0.0f};
  rain.wind.gust_mps = 1.5f;
  Rain turned = rain;
  turned.wind.velocity_mps.x = -5.0f;
  if (auto done = chart_weather(run, truth, stage, {rain}, "wetness",
                                "Wet surfaces by awnings, ten minutes of 10 mm/h in 5 m/s of wind", 0.0, 0.5);
      !done)
    return done;
  return chart_weather(run, truth, stage, {rain, turned}, "wetness-turned",
                       "The same, and 90 s after the wind has turned round", 0.5, 1.0);
}

}  // namespace petrichor
