// Structs that the rain's C++ and GLSL share (std430).
#ifndef PETRICHOR_RAIN_SHARED_H
#define PETRICHOR_RAIN_SHARED_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace petrichor {
using glm::ivec4;
using glm::uvec4;
using glm::vec4;
#endif

#define RAIN_LAYERS_BINDING 2
#define RAIN_CELLS_BINDING 3
#define RAIN_COMMAND_BINDING 4
#define RAIN_OPTICAL_DEPTH_BINDING 5
#define RAIN_RADIANCE_BINDING 6
#define RAIN_OPTICS_BINDING 7
#define RAIN_STREAKS_BINDING 8

#define RAIN_LANES 32            // invocations that share a cell
#define RAIN_SPLAT_GROUP 64
#define RAIN_COMMAND_WIDTH 256   // work groups along x of the indirect dispatch
#ifdef SOFTWARE
#define RAIN_CELL_LIGHTS 4
#else
#define RAIN_CELL_LIGHTS 8
#endif
#define RAIN_LENGTHS 7            // lists of streaks by length, a factor of two each (software OpenGL)
#define RAIN_LISTS 15
#define RAIN_STREAK_CAPACITY 262144
#define RAIN_LONG_PIXELS 16.0      // GPUs: streaks at least this long, and capsules, are drawn by several invocations
#define RAIN_LONG_CAPACITY 524288  // lines, and as many capsules; what is over is drawn where it is found
#define RAIN_LINE_LANES 16        // invocations that share a line
#define RAIN_CAPSULE_LANES 32
#define RAIN_LINES_GROUP 64
#define RAIN_PHASE_BINS 256

// Sums in fixed point. Optical depth: 16 bits a pixel, two rows in a word; 1 is 2^12, so a pixel holds 16 e-folds: a
// drop adds at most 3.9, all the rain of a downpour to 100 m adds 0.5. Radiance times optical depth: 32 bits, in
// output units (1 is white); 1 is 2^14, so a pixel holds 262,144 times white. No clamp below that: half of a lamp's
// halo is drops hundreds of times brighter than white that each cover a thousandth of a pixel's time.
#define RAIN_DEPTH_ONE 4096.0
#define RAIN_RADIANCE_ONE 16384.0
#define RAIN_RADIANCE_MOST 16384.0  // a single drop's radiance ends here; together with its depth (3.9 at most) 64,000

// One layer of one class: a box of cells that may be seen.
struct RainLayerGpu {
  vec4 corner_edge;        // xyz: lowest corner of the box, relative to the camera, m; w: edge of a cell, m
  ivec4 first_cell;        // xyz: index of that cell in the class's frame; w: class << 8 | layer
  uvec4 box;               // cells along x, y and z; w: number of cells in the boxes before this one
  vec4 velocity_diameter;  // m/s; w: m
  vec4 expected;           // x: mean drops in a cell now, y: exp(-x), z: the class's share of the drawn distance
};

// A cell that is seen and holds drops.
struct RainCellGpu {
  vec4 corner_edge;
  uvec4 key;     // of its drops; w: count << 16 | number of lights << 12 | layer
  uvec4 lights;  // up to 8 indices of 16 bits
};

// A streak that waits to be drawn.
struct RainStreakGpu {
  vec4 from_to;      // pixels
  vec4 depths_area;  // z: area, w: radius, pixels
  vec4 light;        // output radiance from lamps
  uvec4 bits;        // x: random, yzw: bands of the lamplight along it (streaks/bands.glsl)
};

#ifdef __cplusplus
static_assert(sizeof(RainLayerGpu) == 80);
static_assert(sizeof(RainCellGpu) == 48);
}  // namespace petrichor
#endif
#endif
