// What the passes of ripples share between C++ and GLSL.
#ifndef PETRICHOR_RIPPLE_SHARED_H
#define PETRICHOR_RIPPLE_SHARED_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace petrichor {
using glm::uvec4;
using glm::vec4;
#endif

#define RIPPLE_UNIFORMS_BINDING 8  // uniform block RippleBlock, bound by pass `ripples`; stays for the passes after it
// Storage of the pass's own shaders.
#define RIPPLE_STATE_BINDING 13
#define RIPPLE_NEXT_BINDING 14
#define RIPPLE_STAMPS_BINDING 15
#define RIPPLE_SEEDS_BINDING 12
#define RIPPLE_TABLE_BINDING 11

#define RIPPLE_GROUP 16        // cells per side of a work group
#define RIPPLE_STAMP_LANES 64
#define RIPPLE_BLOCK 16        // cells per side of a block that has its list of rings

// Seeds are summed as whole numbers of this many to the metre, so that their order does not matter and a seed's sum is
// exactly 0.
#define RIPPLE_STAMP_ONE 1073741824.0

#define RIPPLE_SEED_RING 0u       // zero-sum crater
#define RIPPLE_SEED_WAKE 1u       // what moves pushes water up before it and leaves a hollow behind
#define RIPPLE_SEED_PUBLISHED 2u  // dampened sine, Tatarchuk and Isidoro 2006, section 4

#define RIPPLE_TABLE_RADII 256
#define RIPPLE_TABLE_TIMES 192

struct RippleSeedGpu {
  vec4 place;  // x, y in cells; amplitude, m; reach, cells
  vec4 way;    // of a wake: unit; z: kind
};

// A ring in closed form.
struct RippleRingGpu {
  vec4 place_age;  // x, y, m from the layer's corner; age, s; amplitude, m
};

struct RippleUniforms {
  vec4 near_place;  // xy: from the camera to the near tile's corner, x and z, m; z: 1 / its edge, 1/m; w: share, 0 none
  vec4 tile;        // x: 1 / edge of the shared tile, 1/m; y: its share; z: share of drips' rings; w: level of the
                    // texture that is filled
  vec4 slopes;      // x: mean square slope of rain's ripples; y: wave number of their peak, 1/m, in the shared tile, z in
                    // the near one; w: half an inverse of the edge in which the near tile fades
};

#ifdef __cplusplus
static_assert(sizeof(RippleSeedGpu) == 32);
static_assert(sizeof(RippleUniforms) == 48);
}  // namespace petrichor
#endif
#endif
