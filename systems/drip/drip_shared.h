// What drips' C++ and GLSL share (std430).
#ifndef PETRICHOR_DRIP_SHARED_H
#define PETRICHOR_DRIP_SHARED_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace petrichor {
using glm::uvec4;
using glm::vec4;
#endif

#define DRIPS_BINDING 9
#define DRIP_CLUSTERS_BINDING 10
#define DRIP_LOOKS_BINDING 11
#define DRIP_LAMPS_BINDING 12
#define DRIP_NORMALS_UNIT 3
#define DRIP_NORMALS 64  // texels a side
#define DRIP_GROUP 64
#ifdef SOFTWARE
#define DRIP_LANES 1
#else
#define DRIP_LANES 16  // invocations that share a streak
#endif

// A drop. Its image is a disc that moves along the velocity while the shutter is open; what it is higher than wide is
// part of that way. One that hangs has no velocity and is an ellipse.
struct DripGpu {
  vec4 place_width;       // where that way ends, relative to the camera, m; w: width, m
  vec4 velocity_stretch;  // that way over the exposure, m/s; w: height over width
  uvec4 bits;             // random; cluster; source; 1: a billboard
};

// One source's billboards.
struct DripLooksGpu {
  vec4 opacity;    // alpha, e_s, e_b; w: elongation
  vec4 published;  // x: 1 or 0
};

// Which lamps light a cluster: as sprites' cells.
struct DripLampsGpu {
  uvec4 lights;
  uvec4 count;
};

#ifdef __cplusplus
static_assert(sizeof(DripGpu) == 48 && sizeof(DripLooksGpu) == 32 && sizeof(DripLampsGpu) == 32);
}  // namespace petrichor
#endif
#endif
