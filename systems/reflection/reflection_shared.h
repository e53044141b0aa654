// What the passes of reflections share between C++ and GLSL.
#ifndef SYSTEMS_REFLECTION_REFLECTION_SHARED_H
#define SYSTEMS_REFLECTION_REFLECTION_SHARED_H
#include "systems/frame_shared.h"

#ifdef __cplusplus
namespace petrichor {
#endif

#define REFLECTORS_BINDING 9           // uniform block: software GL reads it at once for all lanes
#define REFLECTORS_STORAGE_BINDING 19  // the same buffer, while what is seen of each is written
#define MAXIMUM_REFLECTORS 128         // bits of a tile's mask
#define REFLECTION_TILE 8              // texels of the half-size buffer per side of a tile

// Tiles that have work: two indirect dispatches of 4 uints (of the half-size buffer, of the picture), then the tiles, x in
// the lower 16 bits, y above.
#define REFLECTION_TILES_BINDING 18
#define REFLECTION_TILES_HEADER 8

#define REFLECTOR_PANEL 0
#define REFLECTOR_LANTERN 1
#define REFLECTOR_POST 2
#define REFLECTOR_LAMP 3  // of the published rung alone: others take lamps from the chosen lights

// Nearest to the camera first. Camera-relative metres.
struct ReflectorGpu {
  vec4 centre_kind;  // w: REFLECTOR_*
  vec4 across_seen;  // xyz half the rectangle's width, w: share that nothing hides, 0 to 1
  vec4 up_reach;     // xyz half its height, w: half its diagonal, m
  vec4 radiance;     // cd/m2; w: distance to the camera, m
};

struct ReflectorsGpu {
  ReflectorGpu all[MAXIMUM_REFLECTORS];
  uvec4 counts;  // in use, 0, 0, 0
};

#ifdef __cplusplus
static_assert(sizeof(ReflectorGpu) == 64);
static_assert(sizeof(ReflectorsGpu) == MAXIMUM_REFLECTORS * 64 + 16);
static_assert(sizeof(ReflectorsGpu) <= 16384, "the least size of a uniform block that OpenGL promises");
}  // namespace petrichor
#endif
#endif
