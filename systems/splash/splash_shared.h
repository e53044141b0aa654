// What the C++ and GLSL of splashes share (std430). The passes borrow the bindings of the rain's cells, commands and
// streaks, which rebind theirs: both never stand in one shader.
#ifndef PETRICHOR_SPLASH_SHARED_H
#define PETRICHOR_SPLASH_SHARED_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace petrichor {
using glm::ivec4;
using glm::uvec4;
using glm::vec4;
#endif

#define SPLASH_CELLS_BINDING 3
#define SPLASH_COMMAND_BINDING 4
#define SPLASH_LIST_BINDING 8
#define SPLASH_LANDINGS_BINDING 9
#define SPLASH_TILES_BINDING 10
#define SPLASH_CANDIDATES_BINDING 11

#define SPLASH_GROUP 64
#ifdef SOFTWARE
#define SPLASH_CELL_LANES 1   // invocations that share a cell
#define SPLASH_DRAW_LANES 8   // and a splash
#define SPLASH_TILES 16       // a side, of the square of ground that splashes reach over
#else
#define SPLASH_CELL_LANES 16
#define SPLASH_DRAW_LANES 16
#define SPLASH_TILES 40
#endif
#define SPLASH_ROW 128        // work groups along x of the indirect dispatches
#define SPLASH_BINS 64        // of importance, half a power of two each
#define SPLASH_LEAST_LOG -30  // log2 of the least

// The baked crown: layers of an array texture.
#define CROWN_SIDE 64     // texels
#define CROWN_PHASES 16
#define CROWN_VIEWS 4     // elevations of the eye above the surface
#define CROWN_TAKES 2     // of each kind
#define CROWN_KINDS (2 * CROWN_TAKES)  // on a film; a low corona
#define CROWN_REACH 1.5   // half a side of the picture, in greatest radii of the crown

#define SPLASH_CROWN 1u     // the crown is there while the shutter is open
#define SPLASH_FILM 2u      // it stands on a film
#define SPLASH_SPRITE 4u    // as printed: no droplets, the paper's light

// A cell of the field that holds drops which have just landed.
struct SplashCellGpu {
  vec4 corner_edge;
  uvec4 key;      // of its drops; w: count << 16 | number of lights << 12 | layer
  uvec4 lights;   // up to 8 indices of 16 bits
  vec4 slab;      // y of the highest and the lowest surface under the sky, m relative; importance at a metre from the
                  // eye; age of the oldest, s
};

// A tile of ground: what lights the splashes on it.
struct SplashTileGpu {
  uvec4 lights;  // as a cell's
  vec4 light;    // x: how many; y: brightness, as a cell's; z: height of the ground that was asked for, relative, m
};

// A splash that is drawn.
struct SplashGpu {
  vec4 place_radius;  // on the surface, relative to the camera, m; w: greatest radius of its crown, m
  vec4 light_weight;  // output radiance; w: multiplies optical depth
  vec4 axis_age;      // unit normal of the surface; w: age when the shutter closes, s
  vec4 drop;          // diameter m, speed across the surface m/s, life of the crown s, importance (it is thinned by)
  uvec4 bits;         // x: random, y: flags | droplets << 8
};

// A drip that has landed.
struct SplashLandingGpu {
  vec4 place_age;  // relative to the camera; w: s
  vec4 velocity_diameter;
  uvec4 bits;
};

// Indirect commands and counts.
struct SplashCommandGpu {
  uvec4 cell_groups;       // of splash_drops; w: cells
  uvec4 candidate_groups;  // of splash_impacts; w: candidates
  uvec4 draw_groups;  // of splash_draw; w: splashes
  vec4 threshold;     // importance below which they are thinned: x of those listed, y of those drawn; z: drawn, on
                      // average; w: alive by what the columns say, more than there are
  uvec4 expected[SPLASH_BINS / 4];  // 256ths of splashes alive, by importance: by the columns, then those listed
};

#ifdef __cplusplus
static_assert(sizeof(SplashCellGpu) == 64);
static_assert(sizeof(SplashGpu) == 80);
static_assert(sizeof(SplashLandingGpu) == 48);
static_assert(sizeof(SplashTileGpu) == 32);
static_assert(sizeof(SplashCommandGpu) == 64 + SPLASH_BINS * 4);
}  // namespace petrichor
#endif
#endif
