#pragma once
// What ripples cost. Needs a current OpenGL context.

#include <vector>

#include "engine/core/bench_row.hpp"
#include "engine/core/result.hpp"

namespace petrichor {

// Rows ripples/RUNG, n: the rate in mm/h (10 and 50): pass `ripples` at 60 frames a second, two ticks each, on 256^2;
// ripples/RUNG/alone: a frame that is drawn alone, with all that it has to make up; its n is the ticks.
Result<std::vector<BenchRow>> bench_ripples(int frames, bool software_gl);

}  // namespace petrichor
