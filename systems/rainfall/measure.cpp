#include "systems/rainfall/measure.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/gpu/objects.hpp"
#include "engine/gpu/shader.hpp"
#include "systems/drops/drop_sizes.hpp"
#include "systems/rainfall/extract.hpp"
#include "systems/drops/layers.hpp"

namespace petrichor {
namespace {

constexpr double side_m = 10.0;

class Counter {
 public:
  Counter(const Program& program, std::size_t classes) : program_(program), counts_(classes, 0) {
    buffer_ = make_buffer(classes * sizeof(std::uint32_t));
    clear_buffer(buffer_);
  }

  void count(const FrameRain& rain, const RainLayers& part, const glm::vec3& low, const glm::vec3& high, bool in_box) {
    if (part.layers.empty()) return;
    upload(layers_, std::span<const RainLayerGpu>(part.layers));
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, RAIN_LAYERS_BINDING, layers_.id);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, RAIN_COMMAND_BINDING, buffer_.id);
    program_.use();
    program_.set("layer_count", static_cast<unsigned>(part.layers.size()));
    program_.set("seed", unsigned(rain.seed));
    program_.set("candidates", static_cast<unsigned>(part.candidates));
    program_.set("low", low);
    program_.set("high", high);
    program_.set("in_box", int(in_box));
    const std::uint64_t groups = (part.candidates + 63) / 64, wide = std::min<std::uint64_t>(groups, 16384);
    glDispatchCompute(static_cast<GLuint>(wide), static_cast<GLuint>((groups + wide - 1) / wide), 1);
    glMemoryBarrier(GL_ALL_BARRIER_BITS);
  }

  // Since the last take, by class.
  std::vector<std::uint64_t> take() {
    std::vector<std::uint32_t> now(counts_.size());
    read_buffer(buffer_, now.data(), now.size() * sizeof(std::uint32_t));
    clear_buffer(buffer_);
    return {now.begin(), now.end()};
  }

 private:
  const Program& program_;
  std::vector<std::uint64_t> counts_;
  Buffer layers_, buffer_;
};

}  // namespace

Result<RainMeasurement> measure_rain(const Emitter& emitter, const Wind& wind, double seconds,
                                     const std::function<void(double)>& progress) {
  ShaderLibrary library;
  const auto program = library.load({{"systems/rainfall/rain_measure.comp.glsl"}, {}});
  if (!program) return tl::unexpected(program.error());
  const WindMotion motion = start_rain_motion(emitter, wind);
  const FrameCamera camera;
  const auto rain_at = [&](double t) { return make_frame_rain(emitter, motion, camera, 16, 9, t); };

  RainMeasurement result;
  result.asked_mm_per_hour = emitter.rain_mm_per_hour;
  result.seconds = seconds;
  result.area_m2 = side_m * side_m;
  FrameRain before = rain_at(0.0);
  Counter counter(**program, before.classes.size());

  const int steps = std::max(1, static_cast<int>(std::ceil(seconds / 0.2)));
  const glm::dvec3 low(-0.5 * side_m, 0.0, -0.5 * side_m), high(0.5 * side_m, 0.0, 0.5 * side_m);
  std::vector<std::uint64_t> crossed(before.classes.size(), 0), inside(before.classes.size(), 0);
  for (int i = 1; i <= steps; ++i) {
    FrameRain now = rain_at(seconds * i / steps);
    for (std::size_t k = 0; k < now.classes.size(); ++k) {  // the layers carry the step's displacement
      now.classes[k].velocity_mps = glm::vec3(now.classes[k].origin_m - before.classes[k].origin_m);
    }
    const RainLayers part = layers_in(now, glm::dvec3(0.0), [&](const RainClass& c, RainBox& box) {
      const glm::dvec3 moved(c.velocity_mps);
      box.low = low + glm::min(moved, 0.0);
      box.high = high + glm::max(moved, 0.0);
      return true;
    });
    counter.count(now, part, glm::vec3(low), glm::vec3(high), false);
    before = std::move(now);
    if (i % 16 == 0 || i == steps) {
      const auto some = counter.take();
      for (std::size_t k = 0; k < some.size(); ++k) crossed[k] += some[k];
      if (progress) progress(double(i) / steps);
    }
  }
  // A cube of air above the square, at four moments.
  constexpr int moments = 4;
  for (int i = 0; i < moments; ++i) {
    const FrameRain now = rain_at(seconds * i / moments);
    const RainBox cube{low, high + glm::dvec3(0.0, side_m, 0.0)};
    const RainLayers part = layers_in(now, glm::dvec3(0.0), [&](const RainClass& c, RainBox& box) {
      box = cube;
      return c.drawn;
    });
    counter.count(now, part, glm::vec3(cube.low), glm::vec3(cube.high), true);
    const auto some = counter.take();
    for (std::size_t k = 0; k < some.size(); ++k) inside[k] += some[k];
  }

  double water_m3 = 0.0, smaller_m3 = 0.0, impacts = 0.0, drops = 0.0;
  for (std::size_t k = 0; k < crossed.size(); ++k) {
    const double d = before.classes[k].diameter_mm * 1e-3;
    const double volume = 3.14159265358979 / 6.0 * d * d * d * static_cast<double>(crossed[k]);
    water_m3 += volume;
    result.drops_counted += crossed[k];
    if (before.classes[k].drawn)
      impacts += static_cast<double>(crossed[k]);
    else
      smaller_m3 += volume;
    drops += static_cast<double>(inside[k]);
  }
  const double to_mm_per_hour = 1000.0 * 3600.0 / (result.area_m2 * seconds);
  result.measured_mm_per_hour = water_m3 * to_mm_per_hour;
  result.smaller_drops_mm_per_hour = smaller_m3 * to_mm_per_hour;
  result.impacts_per_m2_s = impacts / (result.area_m2 * seconds);
  result.drops_per_m3 = drops / (moments * side_m * side_m * side_m);
  result.mean_fall_speed_mps = drops > 0.0 ? result.impacts_per_m2_s / result.drops_per_m3 : 0.0;
  return result;
}

Result<RainMeasurement> measure_rain(double rain_mm_per_hour, double wind_mps, double seconds, std::uint32_t seed,
                                     const std::function<void(double)>& progress) {
  Emitter emitter;
  emitter.rain_mm_per_hour = static_cast<float>(rain_mm_per_hour);
  emitter.seed = seed;
  Wind wind;
  wind.velocity_mps.x = static_cast<float>(wind_mps);
  return measure_rain(emitter, wind, seconds, progress);
}

}  // namespace petrichor
