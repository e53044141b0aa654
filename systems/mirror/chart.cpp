#include <cmath>
#include <string>

#include "engine/core/bench_row.hpp"
#include "systems/mirror/extract.hpp"
#include "systems/mirror/mirror.hpp"
#include "systems/mirror/stage.hpp"
#include "systems/mirror/street.hpp"

namespace petrichor {
namespace {

double squared(const glm::vec3& a, const glm::dvec3& truth) {  // relative, shared physics, section 14
  double sum = 0.0;
  for (int c = 0; c < 3; ++c)
    sum += std::pow(static_cast<double>(a[c]) - truth[c], 2.0) / (truth[c] * truth[c] + 0.01) / 3.0;
  return sum;
}

// After one fixed tone map, L / (L + 3 cd/m2): sharp images of lamps beside dark walls, where a share of a texel would
// else be all that counts (shared physics, section 14).
double toned(const glm::vec3& a, const glm::dvec3& truth) {
  double sum = 0.0;
  for (int c = 0; c < 3; ++c) {
    const double l = static_cast<double>(a[c]);
    sum += std::pow(l / (l + 3.0) - truth[c] / (truth[c] + 3.0), 2.0) / 3.0;
  }
  return sum;
}

void look(Frame& frame, const glm::vec3& eye, const glm::vec3& at) {
  const glm::vec3 back = glm::normalize(eye - at), right = glm::normalize(glm::cross(glm::vec3(0, 1, 0), back));
  frame.camera.position_m = eye;
  frame.camera.orientation = glm::quat_cast(glm::mat3(right, glm::cross(back, right), back));
}

Result<std::unique_ptr<MirrorStage>> make_stage(const ChartRun& run, const std::vector<PassOffer>& passes,
                                                const MirrorStreet& street, double scale,
                                                const std::map<std::string, double>& probes = {}) {
  auto made = MirrorStage::make(passes, run.software, scale, {{"software_share", 1.0}}, probes);
  if (!made) return made;
  Frame& f = (*made)->frame;
  const std::uint32_t model = (*made)->add(box_model(street.boxes));
  for (std::uint32_t i = 0; i < street.boxes.size(); ++i) f.instances.push_back({model, i, true, glm::mat4(1.0f), i});
  f.sky = street.sky;
  f.width = run.software ? 640 : 1024;
  f.height = run.software ? 360 : 768;
  f.camera.vertical_fov_rad = 0.9f;
  return made;
}

struct Errors {
  double drawn = 0.0, shared = 0.0;
  std::vector<double> ms;
};

// Still water with and without ripples, or a pane: every so many pixels' worth of places on it against rays.
Result<void> measure_plane(MirrorStage& stage, const MirrorStreet& street, bool water, bool ripples, Errors& sums) {
  Frame& f = stage.frame;
  auto mirrors = std::make_shared<FrameMirrors>();
  if (water) {
    look(f, {0.3f, 1.6f, 2.0f}, {0.2f, 0.6f, -8.0f});
    auto puddles = std::make_shared<FramePuddles>();
    puddles->puddles.push_back(street.puddle);
    f.puddles = puddles;
    mirrors->water = water_plane(f);
  } else {
    look(f, {1.0f, 1.6f, 0.5f}, {4.9f, 1.7f, -4.5f});
    mirrors->pane = pane_plane(f, std::span(&street.pane, 1));
  }
  f.mirrors = mirrors;
  std::vector<MirrorQuestion> questions;
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 60; ++j) {
      const float u = (static_cast<float>(i) + 0.5f) / 60.0f - 0.5f, v = (static_cast<float>(j) + 0.5f) / 60.0f - 0.5f;
      MirrorQuestion q;
      if (water) {
        q.place_m = {4.0f * u * 0.98f, 0.0f, -6.0f + 12.0f * v * 0.98f};
        if (q.place_m.z > -0.5f) continue;  // out of the picture
        if (ripples)
          q.normal = glm::normalize(glm::vec3(0.03f * std::sin(23.0f * q.place_m.x + 5.0f * q.place_m.z), 1.0f,
                                              0.03f * std::cos(19.0f * q.place_m.z)));
      } else {
        q.place_m = {4.9f, 1.7f + 2.4f * u * 0.98f, -4.5f + 4.0f * v * 0.98f};
        q.normal = {-1, 0, 0};
      }
      q.direction = glm::reflect(glm::normalize(q.place_m - glm::vec3(f.camera.position_m)), q.normal);
      q.roughness = 0.02f;
      questions.push_back(q);
    }
  for (int repeat = 0; repeat < 7; ++repeat) {
    auto answers = stage.ask(questions);
    if (!answers) return tl::unexpected(answers.error());
    if (repeat >= 2) sums.ms.push_back(stage.milliseconds("mirrors"));
    if (repeat > 0) continue;
    for (std::size_t i = 0; i < questions.size(); ++i) {
      const MirrorAnswer& a = (*answers)[i];
      const glm::dvec3 truth = trace_street(street, questions[i].place_m, questions[i].direction).light_cd_m2;
      sums.drawn += toned(glm::mix(glm::vec3(a.environment), glm::vec3(a.mirror), a.mirror.a), truth);
      sums.shared += toned(glm::vec3(a.environment), truth);
    }
  }
  return {};
}

}  // namespace

Result<void> chart_mirrors(const ChartRun& run, const std::vector<PassOffer>& passes) {
  const MirrorStreet street = make_mirror_street();
  const std::pair<double, const char*> sizes[] = {
      {0.125, "an eighth of the picture's width"}, {0.25, "a quarter"}, {0.5, "half"}, {1.0, "all of it"}};
  double done = 0.0;
  for (const auto& [name, title] : {std::pair<std::string, std::string>{"water", "Still water in a street at night"},
                                    {"ripples", "Rippled water in a street at night"},
                                    {"pane", "A shop's pane in a street at night"}}) {
    Chart chart;
    chart.name = "mirrors-" + name;
    chart.effect = "reflections";
    chart.title = title;
    chart.device = run.device;
    chart.error_label = "mean square error against rays, tone mapped (captured surroundings: 1)";
    for (const auto& [scale, label] : sizes) {
      auto stage = make_stage(run, passes, street, scale);
      if (!stage) return tl::unexpected(stage.error());
      chart.width = (*stage)->frame.width;
      chart.height = (*stage)->frame.height;
      Errors sums;
      if (auto done_one = measure_plane(**stage, street, name != "pane", name == "ripples", sums); !done_one)
        return done_one;
      if (chart.points.empty())
        chart.points.push_back({"environment", "captured surroundings", 1e-3, 1e-3, 1e-3, 1.0, 0.0, true, {}});
      chart.points.push_back({"planar",
                              label,
                              quantile(sums.ms, 0.5),
                              quantile(sums.ms, 0.05),
                              quantile(sums.ms, 0.95),
                              sums.drawn / sums.shared,
                              0.0,
                              true,
                              {}});
      done += 1.0 / 12.0;
      if (run.progress) run.progress(done);
    }
    if (auto written = write_chart(run.folder, chart); !written) return written;
  }
  return {};
}

Result<void> chart_probes(const ChartRun& run, const std::vector<PassOffer>& passes) {
  const MirrorStreet street = make_mirror_street();
  const glm::vec3 half(0.8f, 0.6f, 1.9f);  // a car's, about
  constexpr float roughness = 0.25f;
  Chart chart;
  chart.name = chart.effect = "probes";
  chart.title = "What a car mirrors, 3 to 30 m from the eye, roughness 0.25";
  chart.device = run.device;
  chart.error_label = "relative mean square error against rays (the camera's surroundings: 1)";
  for (const double step_m : {2.0, 1.0, 0.5}) {
    auto made = make_stage(run, passes, street, 0.5, {{"step_m", step_m}});
    if (!made) return tl::unexpected(made.error());
    MirrorStage& stage = **made;
    Frame& f = stage.frame;
    look(f, {0.4f, 1.6f, 2.0f}, {0.0f, 0.8f, -20.0f});
    chart.width = f.width;
    chart.height = f.height;
    double probe = 0.0, endless = 0.0, shared = 0.0;
    for (const float away : {3.2f, 8.3f, 15.45f, 28.1f}) {
      const glm::vec3 centre(1.2f, 0.7f, 2.0f - away);
      auto mirrors = std::make_shared<FrameMirrors>();
      FrameMirrors::Probe p;
      p.place_m = centre;
      p.radius_m = 2.2f;
      mirrors->probes = nearest_probes(f, {p});
      f.mirrors = mirrors;
      std::vector<MirrorQuestion> questions;
      for (int i = 0; i < 500; ++i) {
        const float u = 1.0f - 1.6f * (static_cast<float>(i) + 0.5f) / 500.0f, a = 2.39996f * static_cast<float>(i);
        const float s = std::sqrt(1.0f - u * u);
        const glm::vec3 n(s * std::cos(a), u, s * std::sin(a));
        MirrorQuestion q{centre + n * half, glm::normalize(n / half), {}, roughness};
        const glm::vec3 view = glm::normalize(q.place_m - glm::vec3(f.camera.position_m));
        if (glm::dot(view, q.normal) >= 0.0f) continue;
        q.direction = glm::reflect(view, q.normal);
        questions.push_back(q);
      }
      auto answers = stage.ask(questions);
      if (!answers) return tl::unexpected(answers.error());
      for (std::size_t i = 0; i < questions.size(); ++i) {
        const glm::dvec3 view = glm::normalize(f.camera.position_m - glm::dvec3(questions[i].place_m));
        const glm::dvec3 truth =
            trace_lobe(street, questions[i].place_m, questions[i].normal, view, double(roughness), 128);
        probe += squared(glm::vec3((*answers)[i].probe), truth);
        endless += squared(glm::vec3((*answers)[i].endless_probe), truth);
        shared += squared(glm::vec3((*answers)[i].environment), truth);
      }
    }
    // A car at 10 m/s, 30 frames a second.
    std::vector<double> ms;
    for (int frame = 0; frame < 24; ++frame) {
      auto mirrors = std::make_shared<FrameMirrors>();
      FrameMirrors::Probe p;
      p.place_m = {1.2, 0.7, -6.0 - frame / 3.0};
      p.radius_m = 2.2f;
      mirrors->probes = nearest_probes(f, {p});
      f.mirrors = mirrors;
      if (auto drawn = stage.ask({}); !drawn) return tl::unexpected(drawn.error());
      if (frame >= 2) ms.push_back(stage.milliseconds("probes"));
    }
    const double mean = [&] {
      double sum = 0.0;
      for (const double m : ms) sum += m;
      return sum / static_cast<double>(ms.size());
    }();
    if (chart.points.empty())
      chart.points.push_back(
          {"shared", "the camera's surroundings", 1e-3, 1e-3, 1e-3, 1.0, 0.0, true, {{"mean_ms", 1e-3}}});
    const std::string step = step_m == 0.5 ? "0.5 m" : step_m == 1.0 ? "1 m" : "2 m";
    if (step_m == 1.0)
      chart.points.push_back({"moving",
                              "as published: endlessly far",
                              quantile(ms, 0.5),
                              quantile(ms, 0.05),
                              quantile(ms, 0.95),
                              endless / shared,
                              0.0,
                              true,
                              {{"mean_ms", mean}}});
    chart.points.push_back({"moving",
                            "steps of " + step,
                            quantile(ms, 0.5),
                            quantile(ms, 0.05),
                            quantile(ms, 0.95),
                            probe / shared,
                            0.0,
                            true,
                            {{"mean_ms", mean}}});
  }
  if (run.progress) run.progress(1.0);
  return write_chart(run.folder, chart);
}

}  // namespace petrichor
