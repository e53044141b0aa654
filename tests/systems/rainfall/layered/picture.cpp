// The layered composite as it is drawn: the mean of the rain that it stands for, and the artist's controls.
#include <numeric>

#include "tests/systems/rainfall/layered/bench_layered.hpp"

namespace petrichor {
namespace {

TEST_F(LayeredTest, MeanTransmittanceIsThatOfFogAtEveryDistanceAndRate) {
  for (const float wall_m : {2.0f, 5.0f, 10.0f, 20.0f, 60.0f}) {
    const auto s = stage(white_wall(wall_m));
    for (const float rate : {1.0f, 10.0f, 100.0f}) {
      double sum = 0.0, truth = 0.0;
      constexpr int frames = 6;
      for (int i = 0; i < frames; ++i) {
        Frame frame = layered_camera();
        frame.time_s = 3.0 + 1.37 * i;
        layered_on(frame, layered_rain(rate));
        sum += mean_of(light_of(*s, frame)) / frames;
        truth = wall_transmittance(frame.rain->extinction_per_m, wall_m, frame);
      }
      // The issue asks for 0.5% of the background. Most of what rain takes at a few metres is less than that: so also
      // within 8% of what it takes, which the drops of six frames may stray by, and the picture's half floats, which
      // llvmpipe cuts off: 2^-11 in each of two passes.
      EXPECT_NEAR(sum, truth, 0.005) << wall_m << " m, " << rate << " mm/h";
      EXPECT_NEAR(1.0 - sum, 1.0 - truth, 0.08 * (1.0 - truth) + 1e-3) << wall_m << " m, " << rate << " mm/h";
    }
  }
}

}  // namespace
}  // namespace petrichor
