#pragma once
// Rungs of drips against the same drops refracted; and what they cost. Needs a current OpenGL context.

#include <vector>

#include "engine/core/bench_row.hpp"
#include "engine/core/result.hpp"
#include "systems/drip/stage.hpp"

namespace petrichor {

struct DripComparison {
  double error;       // root mean square of luminance; no drips: 1
  double mean_shift;  // of the picture's mean, as a share of that without drips
  double true_shift;  // by which the drips themselves move it
};
// The same drops refracting, at so many times the pixels each way, the mean of so many instants of the exposure:
// luminance, cd/m2.
Result<std::vector<float>> true_drips(DripStage&, const DripSet&, int width, int height, int pixels, int instants);
Result<DripComparison> compare_drips(DripStage&, const std::vector<float>& truth, const DripSet&, DripRung, int width,
                                     int height);

// Rows drips/RUNG, n: drops in the air and hanging, 1 000 and 10 000: the drips' own passes.
Result<std::vector<BenchRow>> bench_drips(int width, int height, int frames, bool software_gl);

}  // namespace petrichor
