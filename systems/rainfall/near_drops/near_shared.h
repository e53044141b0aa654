// What near drops' C++ and GLSL share (std430).
#ifndef PETRICHOR_NEAR_SHARED_H
#define PETRICHOR_NEAR_SHARED_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace petrichor {
using glm::uvec4;
using glm::vec4;
#endif

#define NEAR_LIST_BINDING 3
#define NEAR_COMMAND_BINDING 4
#define NEAR_SUMS_BINDING 5      // 4 uints a pixel: radiance times optical depth, rgb, and optical depth
#define NEAR_PROFILES_BINDING 6  // NEAR_COLUMNS means a drop, rgba16f
#define NEAR_CURVE_BINDING 8
#define NEAR_MAPS_BINDING 9
#define NEAR_IMAGES_BINDING 10   // of cells, rgba16f, and their columns
#define NEAR_CELLS_BINDING 11    // stamp a cell, then those to be made anew
#define NEAR_LAMPS_BINDING 12

#define NEAR_LANES 32
#define NEAR_COLUMNS 16
#define NEAR_CURVE 64        // steps of the angle of incidence from 0 to 90 degrees
#define NEAR_ROW 64          // work groups along x of the indirect dispatches
#define NEAR_LAMPS 64
#define NEAR_CUBE_M 10.0f    // edge of the huge cube of maps
// Of a map's pixel: four directions (octahedral, 16 bits each way), four square roots of shares of 8 bits.
#define NEAR_MAP_WORDS 5
#define NEAR_DEPTH_ONE 65536.0f
#define NEAR_RADIANCE_ONE 131072.0f
#define NEAR_RADIANCE_MOST 1024.0f  // output units; times an optical depth of 3.9 at most: seven such drops fit a pixel

// A drop that shows the world.
struct NearDropGpu {
  vec4 from_to;  // pixels, when the shutter opens and closes
  vec4 depths;   // of the depth buffer; z: area times its share of the exposure, w: radius, pixels
  vec4 place;    // relative to the camera, m; w: columns of its profile
  uvec4 bits;    // x: random; y: 0, or 1 + its cell of maps
};

// A lamp seen from the capture.
struct NearLampGpu {
  vec4 position_range;    // relative to the capture, m; w: distance at which it is cut
  vec4 intensity_radius;  // cd, w: source radius, m
  vec4 direction_kind;
  vec4 cone_shadow;       // spot attenuation; z: its index of the chosen lights' shadow, or -1; w: 1 if rain shows it
};

#ifdef __cplusplus
static_assert(sizeof(NearDropGpu) == 64 && sizeof(NearLampGpu) == 64);
}  // namespace petrichor
#endif
#endif
