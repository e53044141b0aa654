// What the passes of light share between C++ and GLSL.
#ifndef SYSTEMS_LIGHTING_LIGHTING_SHARED_H
#define SYSTEMS_LIGHTING_LIGHTING_SHARED_H
#include "systems/frame_shared.h"

#ifdef __cplusplus
namespace petrichor {
#endif

// A light list is one texel of an rgba32ui texture: 112 bits, one a light (more are dropped by importance), and 16
// bits that say which of the shadow casters need no look at their map, because all of the tile is in their light. The
// chosen lights lie in a uniform block, not in the frame's buffer: software GL reads a uniform at once for all lanes,
// but a buffer lane by lane (a third of the whole light loop, measured).
#define MAXIMUM_LIGHTS 112
#define CHOSEN_LIGHTS_BINDING 3  // uniform block (2 is the material's)
#define LIGHT_TILE 8             // pixels per side of a tile

// Tiles sorted by the work they need, so that none pays for what only another one needs. A storage buffer: three
// indirect dispatch commands of 4 uints each, then for each kind a list of tiles, x in the lower 16 bits, y above.
#define TILES_BINDING 7
#define TILES_SKY 0  // no surface
#define TILES_LIT 1  // no shadow map to ask
#define TILES_SHADOWED 2
#define TILES_KINDS 3
#define TILES_HEADER 12  // uints before the lists

// One octahedral map of a shadow-casting light is a square tile of the shadow atlas.
#define SHADOW_TILES_PER_SIDE 4
#define MAXIMUM_SHADOWS 16
#define SHADOW_TILE 512
#define SHADOW_BORDER 16     // texels repeated round a tile, so that filters stay inside
#define SHADOW_BLUR_LEVEL 3  // mip level that the wide blur is made from
#define SHADOW_WARP 40.0f    // exponent of the warped depth; exp(2 * 40) still fits a float
#define SHADOW_FACE 256      // texels of the six depth maps that a tile is made from
#define SHADOW_NEAR_M 0.04f

// The environment: six octahedral tiles, one per step of roughness, a seventh of diffuse light, and below them a
// row of nine SH coefficients.
#define ENVIRONMENT_TILE 64
#define ENVIRONMENT_BORDER 1
#define ENVIRONMENT_LEVELS 6
#define ENVIRONMENT_WIDTH 448  // ENVIRONMENT_TILE * (ENVIRONMENT_LEVELS + 1)
#define ENVIRONMENT_HEIGHT 65
#define ENVIRONMENT_FACE 32

// The shadow casters stand first. cone_shadow.z: tile in the shadow atlas, or -1; cone_shadow.w: metres that the
// tile's map reaches (farther receivers are lit). Positions are relative to the camera, as in the frame's list.
// Pass light_lists fills and binds the block; it stays bound for the passes after it.
struct ChosenLights {
  LightGpu lights[MAXIMUM_LIGHTS];
  uvec4 counts;  // lights, of which casters, 0, 0
};

#ifdef __cplusplus
static_assert(sizeof(ChosenLights) == MAXIMUM_LIGHTS * 64 + 16);
static_assert(sizeof(ChosenLights) <= 16384, "the least size of a uniform block that OpenGL promises");
}  // namespace petrichor
#else
layout(std140, binding = CHOSEN_LIGHTS_BINDING) uniform ChosenLightsBlock {
  ChosenLights chosen;
};
#endif
#endif
