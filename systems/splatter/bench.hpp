#pragma once
// What splatter and halos cost. Needs a current OpenGL context.

#include <vector>

#include "engine/core/bench_row.hpp"
#include "engine/core/result.hpp"

namespace petrichor {

// Rows halos/layer, halos/fins, splatter/shells, splatter/as_printed, and both /close (a body fills the
// picture); n: marked objects in view.
Result<std::vector<BenchRow>> bench_halos(int width, int height, int frames, bool software_gl);

}  // namespace petrichor
