#pragma once
// What each technique of falling rain costs. Needs a current OpenGL context.

#include <vector>

#include "engine/core/bench_row.hpp"
#include "engine/core/result.hpp"

namespace petrichor {

// Rows rungs/NAME, n: the rate in mm/h (1, 10 and 100), before a wall with three lamps (systems/rainfall/studio.hpp),
// as the device's budget of drops has it: the rain's own passes alone. And rungs/NAME/PASS for each of them.
Result<std::vector<BenchRow>> bench_rungs(int width, int height, int frames, bool software_gl, int affordable_drops);

}  // namespace petrichor
