// Structs that the sprites' C++ and GLSL share (std430).
#ifndef PETRICHOR_SPRITES_SHARED_H
#define PETRICHOR_SPRITES_SHARED_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace petrichor {
using glm::ivec4;
using glm::uvec4;
using glm::vec4;
#endif

#define SPRITES_BINDING 3
#define SPRITE_CLASSES_BINDING 9
#define SPRITE_LIGHTS_BINDING 10
#define SPRITE_STATES_BINDING 11
#define SPRITE_GROUP 64

// A size class: its particles stand one after another.
struct SpriteClassGpu {
  vec4 origin_speed;       // xyz: the class's frame relative to the box's lower corner, in boxes, the whole ones cut off;
                           // w: fall speed, m/s
  vec4 velocity_diameter;  // m/s; m
  ivec4 numbers;           // x: how many whole boxes were cut off y, y: first particle, z: the class's number,
                           // w: share of N(D) up to and with this class, of 2^24 (published)
};

// A particle that the view sees.
struct SpriteGpu {
  vec4 place_diameter;  // when the shutter closes, relative to the camera, m; m
  uvec4 velocity_bits;  // m/s, the bits of floats; random bits
};

// Which lamps light a cell of the box.
struct SpriteLightsGpu {
  uvec4 lights;  // up to 8 indices of 16 bits
  uvec4 count;   // x
};

// published: what a particle keeps from frame to frame.
struct SpriteStateGpu {
  uvec4 place_class;          // world, m, in single precision as his, the bits of floats; the class's place in the list
  uvec4 velocity_generation;  // m/s, the bits of floats; how often it was spawned
};

#ifdef __cplusplus
static_assert(sizeof(SpriteClassGpu) == 48);
static_assert(sizeof(SpriteGpu) == 32);
static_assert(sizeof(SpriteLightsGpu) == 32);
static_assert(sizeof(SpriteStateGpu) == 32);
}  // namespace petrichor
#endif
#endif
