#pragma once
// A white wall (or lamps in the dark) before which the layered composite is drawn.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "systems/rainfall/extract.hpp"
#include "systems/rainfall/layered/motion.hpp"
#include "systems/rainfall/stage.hpp"
#include "tests/engine/platform/gl_test.hpp"

namespace petrichor {

class LayeredTest : public test::GlTest {
 protected:
  static std::unique_ptr<RainStage> stage(const StageSet& set) {
    auto made = RainStage::make(context->device().software, set);
    EXPECT_TRUE(made) << (made ? "" : made.error().message);
    return made ? std::move(*made) : nullptr;
  }
  // Drops shine with nothing before it: the picture is the transmittance.
  static StageSet white_wall(float distance_m) {
    StageSet set;
    set.present = false;
    set.wall_cd_m2 = glm::vec3(1.0f);
    set.wall_distance_m = distance_m;
    set.wall_hides = true;
    return set;
  }
};

inline Emitter layered_rain(float mm_per_hour) {
  Emitter emitter;
  emitter.rain_mm_per_hour = mm_per_hour;
  return emitter;
}

inline Frame layered_camera(int width = 160, int height = 90, float fov_deg = 60.0f) {
  Frame frame = stage_frame(width, height, glm::dvec3(3.0, 1.7, -8.0));
  frame.camera.vertical_fov_rad = glm::radians(fov_deg);
  frame.camera.exposure_s = 1.0f / 60;
  frame.sky.zenith_cd_m2 = frame.sky.horizon_cd_m2 = glm::vec3(0.0f);
  frame.time_s = 11.0;
  return frame;
}

// As the systems do it, with steady wind and camera.
inline void layered_on(Frame& frame, const Emitter& emitter, const LayeredComposite& settings = {},
                       const Wind& wind = {}) {
  frame.techniques.set(Effect::rainfall, RainRung::composite);
  frame.rain =
      make_frame_rain(emitter, start_rain_motion(emitter, wind), frame.camera, frame.width, frame.height, frame.time_s);
  frame.rain->techniques = frame.techniques;
  frame.rain->layered = make_frame_layered(settings, frame, frame.time_s);
}

inline std::vector<float> light_of(RainStage& stage, Frame& frame) {
  const auto drawn = stage.draw(frame);
  EXPECT_TRUE(drawn) << (drawn ? "" : drawn.error().message);
  return stage.read_light();
}

inline double mean_of(const std::vector<float>& light, int channel = 0) {
  double sum = 0.0;
  for (std::size_t p = channel; p < light.size(); p += 4) sum += light[p];
  return sum / (static_cast<double>(light.size()) / 4.0);
}

// Mean over the picture of exp(-extinction * length of the ray to a wall across the axis).
inline double wall_transmittance(double extinction, double wall_m, const Frame& frame) {
  const double tall = std::tan(0.5 * frame.camera.vertical_fov_rad);
  double sum = 0.0;
  constexpr int n = 64;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const double u = ((x + 0.5) / n * 2.0 - 1.0) * tall * frame.width / frame.height,
                   v = ((y + 0.5) / n * 2.0 - 1.0) * tall;
      sum += std::exp(-extinction * wall_m * std::sqrt(1.0 + u * u + v * v));
    }
  return sum / (n * n);
}

}  // namespace petrichor
