#include "systems/rainfall/bench.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "systems/rainfall/extract.hpp"
#include "systems/rainfall/stage.hpp"

namespace petrichor {
namespace {

struct Scene {
  const char* name;
  bool lamps, scene;
};
constexpr Scene scenes[] = {{"rain/empty", false, false}, {"rain/lit", true, false}, {"rain/lit_occluded", true, true}};

void add_lamps(Frame& frame) {
  const auto lamp = [&](const glm::vec3& position_m, const glm::vec3& intensity_cd) {
    FrameLight light{};
    light.position_m = position_m;
    light.direction = {0.0f, -1.0f, 0.0f};
    light.intensity = intensity_cd;
    light.source_radius_m = 0.08f;
    light.kind = LIGHT_POINT;
    light.lights_rain = true;
    frame.lights.push_back(light);
  };
  lamp({-4.0f, 4.0f, -10.0f}, glm::vec3(1.0f, 0.7f, 0.4f) * 800.0f);
  lamp({-1.0f, 2.5f, -16.0f}, glm::vec3(0.7f, 0.8f, 1.0f) * 800.0f);
  lamp({3.5f, 4.0f, -14.0f}, glm::vec3(1.0f, 0.75f, 0.45f) * 800.0f);
}

}  // namespace

Result<std::vector<BenchRow>> bench_rain(int drops, int width, int height, int frames, bool software_gl) {
  Emitter emitter;
  emitter.maximum_drops = 400'000'000;  // no budget: every drop to a distance that holds so many
  emitter.rain_mm_per_hour = 10.0f;
  Wind wind;
  wind.velocity_mps = {1.0f, 0.0f, 0.0f};
  const WindMotion motion = start_rain_motion(emitter, wind);
  const Frame view = stage_frame(width, height);
  const auto distance_of_drops = [&] {
    emitter.drawn_distance_m = 5.0f;
    const FrameRain near = make_frame_rain(emitter, motion, view.camera, width, height, 0.0);
    return 5.0f * std::cbrt(static_cast<float>(drops) / near.expected_drops);
  };
  float distance_m = distance_of_drops();
  while (emitter.rain_mm_per_hour < 50.0f && distance_m > 30.0f) {
    emitter.rain_mm_per_hour += 1.0f;
    distance_m = distance_of_drops();
  }
  emitter.drawn_distance_m = distance_m;
  const std::string n = std::to_string(drops), size = std::to_string(width) + "x" + std::to_string(height);

  std::vector<BenchRow> rows;
  for (const Scene& scene : scenes) {
    StageSet set;
    if (scene.scene) {
      set.wall_cd_m2 = glm::vec3(0.01f);
      set.wall_distance_m = 200.0f;
      set.wall_hides = set.map = true;
      set.fog = false;
    }
    auto stage = RainStage::make(software_gl, set);
    if (!stage) return tl::unexpected(stage.error());
    Frame frame = stage_frame(width, height, glm::dvec3(0.0, 1.7, 0.0));
    if (scene.lamps) add_lamps(frame);
    FrameTimer& timer = (*stage)->timer();
    std::vector<double> whole;
    std::map<std::string, std::vector<double>> passes;
    constexpr int warm_up = 4;  // compiles shaders, makes buffers
    // Software OpenGL times passes between glFinishes, which costs: in frames of their own.
    const int total = warm_up + frames + (software_gl ? std::max(1, frames / 4) : 8);
    for (int i = 0; i < total; ++i) {
      const bool profile = i >= warm_up + frames;
      glFinish();
      const auto start = std::chrono::steady_clock::now();
      frame.number = static_cast<std::uint64_t>(i);
      frame.time_s = 10.0 + i / 60.0;
      frame.rain = make_frame_rain(emitter, motion, frame.camera, width, height, frame.time_s);
      timer.begin_frame(profile);
      if (auto drawn = (*stage)->draw(frame); !drawn) return tl::unexpected(drawn.error());
      timer.end_frame();
      glFinish();
      const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
      if (i >= warm_up && !profile) whole.push_back(taken.count());
      const std::vector<Timing> timings = timer.collect();
      if (i >= warm_up)
        for (const Timing& t : timings) passes[t.name].push_back(t.milliseconds);
    }
    BenchRow row{scene.name, n, size, quantile(whole, 0.5), quantile(whole, 0.95), std::nullopt};
    double sum = 0.0;
    for (const auto& [name, samples] : passes) sum += quantile(samples, 0.5);
    if (timer.gpu_times_are_real()) row.gpu_median_ms = sum;
    rows.push_back(row);
    for (const auto& [name, samples] : passes) {
      const double median = quantile(samples, 0.5);
      rows.push_back({std::string(scene.name) + "/" + name, n, size, median, quantile(samples, 0.95),
                      timer.gpu_times_are_real() ? std::optional<double>(median) : std::nullopt});
    }
  }
  return rows;
}

}  // namespace petrichor
