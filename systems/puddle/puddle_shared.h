// The list of puddles as the shaders see it (std430).
#ifndef PETRICHOR_PUDDLE_SHARED_H
#define PETRICHOR_PUDDLE_SHARED_H

#ifdef __cplusplus
#include <cstdint>
#include <glm/glm.hpp>
namespace petrichor {
using glm::uvec4;
using glm::vec4;
#endif

#define PUDDLE_LIST_BINDING 21   // buffer PuddleList { PuddleListGpu; PuddleGpu puddles[]; }
#define PUDDLE_CELLS_BINDING 22  // buffer, two uints a cell: the numbers (from 1) of up to 8 puddles, a byte each
#define PUDDLES_AT_MOST 255              // at most
#define PUDDLE_CELLS 64          // along a side, at most
#define PUDDLE_CELL_M 2.0f       // at least
#define PUDDLE_FARTHEST_M 150.0f
#define PUDDLE_BELOW_M 0.1f      // ground that far above the brim or below the bottom is another floor

struct PuddleListGpu {
  vec4 cells;    // x, z of the first cell's corner relative to the camera, 1 / edge of a cell, share of rung masks
  uvec4 counts;  // cells along x and z, puddles, 1 where one goes by height
};

struct PuddleGpu {
  vec4 row_x, row_y, row_z;  // camera-relative place (x, y, z, 1) -> m along the puddle's x, above its brim, along its z
  vec4 size_level;           // half size x, z; depth of its brim, of its level below the brim, m
  vec4 ripple;               // p_i, s_o, theta_o in rad, 1: depth by height
};

#ifdef __cplusplus
static_assert(sizeof(PuddleListGpu) == 32 && sizeof(PuddleGpu) == 80);
}  // namespace petrichor
#endif
#endif
