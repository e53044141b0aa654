#pragma once
// Tariq's published path (2007), beside the drop field and the engine's own sprites. Needs a current OpenGL context.

#include <vector>

#include "engine/core/bench_row.hpp"
#include "engine/core/result.hpp"

namespace petrichor {

// In one run, of one rain (10 to 50 mm/h, 45 degrees high as in his Table 2, 1/60 s, three lamps, no depth buffer):
//   tariq/animate_transform_feedback  his particles, moved by a vertex shader and streamed out
//   tariq/draw_geometry_shader        the same as quads of a geometry shader, blended over the picture; a fragment
//   reads
//                                     four textures of an array for each lamp
//   tariq/draw_simple_shader          with his simple shader instead, which reads none (his Table 2)
//   tariq/total                       the first two
//   tariq/drop_field                  the very same drops, as many in view: rain_cells and rain_splat
//   tariq/drop_field_composite        and laid over the picture, which his blending does too
// and, of as many particles in a box about the camera (his Table 2), of which the view sees some:
//   tariq/box_total                   his path
//   tariq/sprites                     rain_sprites: animated and drawn by compute
//   tariq/sprites_composite           and laid over the picture
// Times are of GPU timers; in software OpenGL of the wall between glFinishes.
Result<std::vector<BenchRow>> bench_tariq(int drops, int width, int height, int frames, bool software_gl);

}  // namespace petrichor
