#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/bench_row.hpp"
#include "systems/splatter/bench.hpp"
#include "systems/splatter/placed.hpp"
#include "systems/splatter/ring_truth.hpp"
#include "systems/splatter/splatter.hpp"
#include "systems/splatter/stage.hpp"
#include "systems/splatter/truth.hpp"

namespace petrichor {
namespace {

FrameLight lamp_at(const glm::vec3& place, float cd) {
  FrameLight lamp{};
  lamp.position_m = place;
  lamp.intensity = glm::vec3(cd);
  lamp.kind = LIGHT_POINT;
  lamp.range_m = 0.0f;
  lamp.lights_rain = true;
  return lamp;
}

// The lamp stands behind, so that the mist is backlit; from the side, over the roof, skimming it, and from far.
struct Shot {
  glm::vec3 from_m, at_m;
};
constexpr float lamp_cd = 400.0f;
const Shot shots[] = {{{0.6f, 1.55f, 5.0f}, {0.0f, 1.2f, 0.0f}},
                      {{3.0f, 2.3f, 2.6f}, {0.0f, 1.1f, 0.0f}},
                      {{4.0f, 1.42f, 0.4f}, {0.0f, 1.25f, 0.0f}},
                      {{2.0f, 1.6f, 8.5f}, {0.0f, 1.1f, 0.0f}}};
const glm::vec3 lamp_m{-2.5f, 3.6f, -5.0f};

Result<std::unique_ptr<SplatterStage>> set_stage(bool software, const Model& model, int width, int height, float rate) {
  auto made = SplatterStage::make(software);
  if (!made) return made;
  SplatterStage& s = **made;
  s.frame.width = width;
  s.frame.height = height;
  s.frame.rain = still_rain(rate);
  s.frame.lights = {lamp_at(lamp_m, lamp_cd)};
  s.frame.camera.exposure_ev100 = 3.0f;
  s.frame.time_s = 20.0;
  s.add(model, glm::mat4(1.0f));
  return made;
}

// Mean over blocks of 2 x 2 pixels: a truth of single droplets is noise between neighbours.
std::vector<double> blocks(const std::vector<double>& picture, int width, int height) {
  std::vector<double> out;
  for (int y = 0; y + 1 < height; y += 2)
    for (int x = 0; x + 1 < width; x += 2) {
      const auto at = std::size_t(y) * std::size_t(width) + std::size_t(x), above = at + std::size_t(width);
      out.push_back(0.25 * (picture[at] + picture[at + 1] + picture[above] + picture[above + 1]));
    }
  return out;
}

struct Setting {
  HaloRung rung;
  const char* name;
  const char* label;
  int steps;
  bool published;
};
const Setting settings[] = {{HaloRung::layer, "layer", "8 steps", 8, false},
                            {HaloRung::layer, "layer", "24 steps", 24, false},
                            {HaloRung::fins, "fins", "", 16, false},
                            {HaloRung::fins, "fins", "as printed", 16, true}};

struct RingSetting {
  const char* label;
  int shells;
  bool published;
};
const RingSetting ring_settings[] = {{"1 shell", 1, false},     {"2 shells", 2, false},       {"3 shells", 3, false},
                                     {"6 shells", 6, false},    {"16 shells", 16, false},     {"2 as printed", 2, true},
                                     {"6 as printed", 6, true}, {"16 as printed", 16, true}};
// Near, and from the side.
const Shot ring_shots[] = {{{0.3f, 2.0f, 1.6f}, {0.0f, 1.2f, 0.4f}}, {{1.5f, 1.9f, 1.2f}, {0.0f, 1.3f, 0.2f}}};
constexpr float ring_view_deg = 30.0f;
constexpr double ring_moments_s[] = {20.0, 20.113, 20.227};

// Of pictures of twice the size.
std::vector<double> halved(const std::vector<double>& picture, int width, int height) {
  return blocks(picture, 2 * width, 2 * height);
}

Result<void> chart_splatter(const ChartRun& run) {
  // Rings are ten pixels wide: under six they fade, under two there are none.
  const int width = 480, height = 270;
  Chart chart;
  chart.name = chart.effect = "splatter";
  chart.title = "Rings of splatter on a car's roof that fills the picture, 50 mm/h";
  chart.device = run.device;
  chart.width = width;
  chart.height = height;
  chart.error_label = "root mean square error of the rings' light (no rings: 1)";
  const Model model = body_model();
  std::vector<std::vector<double>> truth;
  double off = 0.0, true_sum = 0.0;
  auto fine = set_stage(run.software, model, 2 * width, 2 * height, 50.0f);
  if (!fine) return tl::unexpected(fine.error());
  for (const Shot& shot : ring_shots)
    for (const double when : ring_moments_s) {
      SplatterStage& s = **fine;
      s.frame.time_s = when;
      s.frame.techniques.set(Effect::halos, HaloRung::none);
      s.frame.techniques.set(Effect::splatter, SplatterRung::none);
      look(s.frame.camera, shot.from_m, shot.at_m, ring_view_deg);
      if (auto drawn = s.draw(); !drawn) return drawn;
      ShapeStore shapes;
      const auto placed = place_catchers(shapes, s.frame, 2 * width, 2 * height, 1.0f, 0.01f, 0.0f, 1, 1);
      if (placed.empty()) return failure("the chart of splatter sees nothing");
      CatcherGpu gpu = placed[0].gpu;
      gpu.shells.z *= thrown_sections(s.frame.splatter->mist);
      truth.push_back(halved(draw_rings(s.frame, gpu, s.frame.lights[0], 2 * width, 2 * height, s.read_distances(),
                                        s.read_normals(), slot_s),
                             width, height));
      for (const double l : truth.back()) off += l * l, true_sum += l;
    }
  for (const RingSetting& setting : ring_settings) {
    auto own = set_stage(run.software, model, width, height, 50.0f);
    if (!own) return tl::unexpected(own.error());
    SplatterStage& s = **own;
    s.shells = setting.shells;
    s.marks[0].published = setting.published;
    s.frame.techniques.set(Effect::halos, HaloRung::none);
    s.frame.techniques.set(Effect::splatter, SplatterRung::shells);
    double error = 0.0, sum = 0.0;
    std::vector<double> times;
    std::size_t at = 0;
    for (const Shot& shot : ring_shots) {
      look(s.frame.camera, shot.from_m, shot.at_m, ring_view_deg);
      for (const double when : ring_moments_s) {
        s.frame.time_s = when;
        if (auto drawn = s.draw(); !drawn) return drawn;
        const std::vector<float> light = s.read_light();
        const std::vector<double>& right = truth[at++];
        for (std::size_t k = 0; k < right.size(); ++k) {
          error += std::pow(double(light[4 * k]) - right[k], 2);
          sum += light[4 * k];
        }
      }
      auto some = s.time("splatter", run.software ? 8 : 60);
      if (!some) return tl::unexpected(some.error());
      times.insert(times.end(), some->begin(), some->end());
    }
    chart.points.push_back({"shells",
                            setting.label,
                            quantile(times, 0.5),
                            quantile(times, 0.05),
                            quantile(times, 0.95),
                            std::sqrt(error / off),
                            sum / true_sum - 1.0,
                            true,
                            {}});
  }
  return write_chart(run.folder, chart);
}

}  // namespace

Result<void> chart_halos(const ChartRun& run) {
  if (auto rings = chart_splatter(run); !rings) return rings;
  const int width = run.software ? 160 : 320, height = run.software ? 90 : 180;
  const int droplets = run.software ? 60000 : 400000;
  Chart chart;
  chart.name = chart.effect = "halos";
  chart.title = "Mist of splashes on a car's shape, 50 mm/h, backlit";
  chart.device = run.device;
  chart.width = width;
  chart.height = height;
  chart.error_label = "root mean square error of the mist's light (no mist: 1)";
  const Model model = body_model();
  auto made = set_stage(run.software, model, width, height, 50.0f);
  if (!made) return tl::unexpected(made.error());
  SplatterStage& stage = **made;
  const CatcherShape shape = make_shape(model.meshes[0]);

  // What the object hides, from the stage's own depth buffer.
  std::vector<MistView> views;
  std::vector<std::vector<float>> hidden;
  for (const Shot& shot : shots) {
    look(stage.frame.camera, shot.from_m, shot.at_m, 45.0f);
    stage.frame.techniques.set(Effect::halos, HaloRung::none);
    stage.frame.techniques.set(Effect::splatter, SplatterRung::none);
    if (auto drawn = stage.draw(); !drawn) return drawn;
    hidden.push_back(stage.read_distances());
    views.push_back({stage.frame.camera, {}, {}});
  }
  std::vector<MistView> again = views;
  fly_mist(shape, *stage.frame.rain, stage.frame.lights[0], width, height, droplets, 1, hidden, views);
  if (run.progress) run.progress(0.4);
  fly_mist(shape, *stage.frame.rain, stage.frame.lights[0], width, height, droplets, 2, hidden, again);
  if (run.progress) run.progress(0.7);

  // The truth is the mean of both; half their difference is how far that is from itself.
  std::vector<std::vector<double>> truth;
  double off = 0.0, floor = 0.0, true_sum = 0.0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const auto a = blocks(views[i].light, width, height), b = blocks(again[i].light, width, height);
    truth.emplace_back();
    for (std::size_t k = 0; k < a.size(); ++k) {
      const double mean = 0.5 * (a[k] + b[k]);
      truth.back().push_back(mean);
      off += mean * mean;
      floor += 0.25 * (a[k] - b[k]) * (a[k] - b[k]);
      true_sum += mean;
    }
  }
  chart.floor = std::sqrt(floor / off);
  for (const Setting& setting : settings) {
    auto own = set_stage(run.software, model, width, height, 50.0f);
    if (!own) return tl::unexpected(own.error());
    SplatterStage& s = **own;
    s.steps = setting.steps;
    s.marks[0].published = setting.published;
    s.frame.techniques.set(Effect::halos, setting.rung);
    s.frame.techniques.set(Effect::splatter, SplatterRung::none);
    double error = 0.0, sum = 0.0;
    std::vector<double> times;
    for (std::size_t i = 0; i < views.size(); ++i) {
      s.frame.camera = views[i].camera;
      if (auto drawn = s.draw(); !drawn) return drawn;
      const std::vector<float> light = s.read_light();
      std::vector<double> red;
      for (std::size_t k = 0; k < light.size(); k += 4) red.push_back(light[k]);
      const auto seen = blocks(red, width, height);
      for (std::size_t k = 0; k < seen.size(); ++k) {
        error += std::pow(seen[k] - truth[i][k], 2);
        sum += seen[k];
      }
      auto some = s.time("halos", run.software ? 8 : 60);
      if (!some) return tl::unexpected(some.error());
      times.insert(times.end(), some->begin(), some->end());
    }
    // tests/stability/splatter.cpp: HardSilhouettesPop.
    chart.points.push_back({setting.name,
                            setting.label,
                            quantile(times, 0.5),
                            quantile(times, 0.05),
                            quantile(times, 0.95),
                            std::sqrt(error / off),
                            sum / true_sum - 1.0,
                            !setting.published,
                            {}});
    if (run.progress) run.progress(0.7 + 0.3 * double(chart.points.size()) / double(std::size(settings)));
  }
  return write_chart(run.folder, chart);
}

Result<std::vector<BenchRow>> bench_halos(int width, int height, int frames, bool software_gl) {
  const Model model = body_model();
  auto made = set_stage(software_gl, model, width, height, 50.0f);
  if (!made) return tl::unexpected(made.error());
  SplatterStage& s = **made;
  for (int i = 1; i < 4; ++i) {
    glm::mat4 matrix(1.0f);
    matrix[3] = glm::vec4(i & 1 ? 2.4f : -2.4f, 0.0f, -3.0f * static_cast<float>(i), 1.0f);
    s.add(model, matrix);
  }
  for (int i = 0; i < 11; ++i) s.frame.lights.push_back(lamp_at({-5.0f + 10.0f * (i & 1), 4.6f, -4.0f * i}, lamp_cd));
  const std::string size = fmt::format("{}x{}", width, height);
  std::vector<BenchRow> rows;
  const auto row = [&](const std::string& name, std::string_view pass) -> Result<void> {
    auto times = s.time(pass, frames);
    if (!times) return tl::unexpected(times.error());
    BenchRow r{name, std::to_string(s.marks.size()), size, quantile(*times, 0.5), quantile(*times, 0.95), std::nullopt};
    if (!software_gl) r.gpu_median_ms = r.median_ms;
    rows.push_back(std::move(r));
    return {};
  };
  look(s.frame.camera, {0.8f, 1.6f, 5.0f}, {0.0f, 1.0f, 0.0f}, 45.0f);
  s.frame.techniques.set(Effect::splatter, SplatterRung::none);
  for (const HaloRung rung : {HaloRung::layer, HaloRung::fins}) {
    s.frame.techniques.set(Effect::halos, rung);
    if (auto done = row(rung == HaloRung::layer ? "halos/layer" : "halos/fins", "halos"); !done)
      return tl::unexpected(done.error());
  }
  s.frame.techniques.set(Effect::halos, HaloRung::none);
  s.frame.techniques.set(Effect::splatter, SplatterRung::shells);
  for (const bool close : {false, true}) {
    if (close) look(s.frame.camera, {0.3f, 1.9f, 2.0f}, {0.0f, 1.1f, 0.6f}, 45.0f);
    for (const bool published : {false, true}) {
      for (Catcher& c : s.marks) c.published = published;
      const std::string name =
          std::string("splatter/") + (published ? "as_printed" : "shells") + (close ? "/close" : "");
      if (auto done = row(name, "splatter"); !done) return tl::unexpected(done.error());
    }
  }
  return rows;
}

}  // namespace petrichor
