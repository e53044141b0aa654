#pragma once
// A wall in the snow.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "systems/rainfall/snow/extract.hpp"
#include "systems/rainfall/snow/passes.hpp"
#include "systems/rainfall/stage.hpp"
#include "tests/engine/platform/gl_test.hpp"

namespace petrichor {

class SnowTest : public test::GlTest {
 protected:
  static std::unique_ptr<RainStage> stage(StageSet set) {
    set.flakes = true;
    auto made = RainStage::make(context->device().software, set);
    EXPECT_TRUE(made) << (made ? "" : made.error().message);
    return made ? std::move(*made) : nullptr;
  }
  // White (or dark), seen through flakes that shine with nothing: the picture is the transmittance.
  static std::unique_ptr<RainStage> wall(float distance_m, float cd_m2 = 1.0f) {
    StageSet set;
    set.present = false;
    set.wall_cd_m2 = glm::vec3(cd_m2);
    set.wall_distance_m = distance_m;
    set.wall_hides = true;
    return stage(set);
  }
};

struct SnowView {
  int width = 160, height = 90;
  float fov_deg = 50.0f, exposure_s = 1.0f / 60;
  glm::dvec3 camera_m{3.0, 1.7, -8.0};
};

inline Frame snow_frame(const SnowView& view, double time_s) {
  Frame frame = stage_frame(view.width, view.height, view.camera_m);
  frame.camera.vertical_fov_rad = glm::radians(view.fov_deg);
  frame.camera.exposure_s = view.exposure_s;
  frame.sky.zenith_cd_m2 = frame.sky.horizon_cd_m2 = glm::vec3(0.0f);
  frame.time_s = time_s;
  return frame;
}

inline Snowfall snow_of(float mm_per_hour, float drawn_m = 12.0f, int most_flakes = 400'000'000) {
  Snowfall s;
  s.snow_mm_per_hour = mm_per_hour;
  s.drawn_distance_m = drawn_m;
  s.maximum_flakes = most_flakes;
  return s;
}

inline void snow_on(Frame& frame, const Snowfall& snowfall, const WindMotion& wind = start_snow_motion({})) {
  frame.snow = make_frame_snow(snowfall, wind, frame.camera, frame.width, frame.height, frame.time_s);
}

inline std::vector<float> light_of(RainStage& stage, Frame& frame) {
  const auto drawn = stage.draw(frame);
  EXPECT_TRUE(drawn) << (drawn ? "" : drawn.error().message);
  return stage.read_light();
}

inline double mean_of(const std::vector<float>& light) {
  double sum = 0.0;
  for (std::size_t p = 0; p < light.size(); p += 4) sum += light[p];
  return sum / (static_cast<double>(light.size()) / 4.0);
}

inline double difference(const std::vector<float>& a, const std::vector<float>& b) {
  double sum = 0.0;
  for (std::size_t p = 0; p < a.size(); p += 4) sum += std::abs(a[p] - b[p]);
  return sum / (static_cast<double>(a.size()) / 4.0);
}

// Mean over the picture of exp(-extinction * length of the ray to the wall).
inline double expected_transmittance(double extinction, double wall_m, const SnowView& view) {
  const double tall = std::tan(0.5 * view.fov_deg * M_PI / 180.0);
  double sum = 0.0;
  constexpr int n = 64;
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const double u = ((x + 0.5) / n * 2.0 - 1.0) * tall * view.width / view.height,
                   v = ((y + 0.5) / n * 2.0 - 1.0) * tall;
      sum += std::exp(-extinction * wall_m * std::sqrt(1.0 + u * u + v * v));
    }
  return sum / (n * n);
}

}  // namespace petrichor
