#pragma once
// Whole frames of rain in an empty scene, and nothing else. Needs a current OpenGL context.

#include <vector>

#include "engine/core/bench_row.hpp"
#include "engine/core/result.hpp"

namespace petrichor {

// Rain of 10 mm/h to the distance that holds that many drops, on average, in a view of 60 degrees; where that is
// farther than 30 m, heavier rain to 30 m, up to 50 mm/h. For three scenes - dark, lit by three lamps, lit with a depth
// buffer and an occlusion map that each drop is tested against - the whole frame ("rain/lit": extraction to 8-bit
// picture, wall time around glFinish) and each pass ("rain/lit/rain_splat").
Result<std::vector<BenchRow>> bench_rain(int drops, int width, int height, int frames, bool software_gl);

}  // namespace petrichor
