// What splatter and halos share between C++ and GLSL.
#ifndef PETRICHOR_SPLATTER_SHARED_H
#define PETRICHOR_SPLATTER_SHARED_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace petrichor {
using glm::mat4;
using glm::uvec4;
using glm::vec4;
#endif

#define SPLATTER_CATCHER_BINDING 9  // uniform block
#define SPLATTER_LAMPS 8
#define SPLATTER_SHELLS 16          // at most
#define SPLATTER_RADII 32           // of the baked rings
#define SPLATTER_AGES 64
// The baked crown, in diameters and in seconds of a drop of 2 mm at 6.5 m/s; others by D and D / V.
#define SPLATTER_REACH 7.5          // diameters: no ring is wider
#define SPLATTER_LIFE 75.0          // of D / V
#define SPLATTER_HEIGHT 3.0         // diameters: of the crown's rim at its highest

// One marked object. Local: its own axes, scaled to metres.
struct CatcherGpu {
  mat4 local_from_relative;
  vec4 low;        // xyz of its box, local; w: scale of y from object space
  vec4 high;       // w: 1 where its up is the world's or nearly
  vec4 mist;       // extinction at the surface 1/m, height m, droplet m, speed m/s
  vec4 crown;      // impacts 1/(m2 s), diameter m, speed m/s, lifetime of the mean crown s
  vec4 shells;     // number, height of the highest m, opacity, share of the rings that is drawn (distance)
  uvec4 key;       // entity, seed of the rain, lamps, published
  uvec4 lamps[2];  // indices of the frame's lights
};

// One quad of mist along an outline.
struct FinGpu {
  vec4 a_depth, b_depth;      // ends, relative to the camera; w: optical depth along the ray there
  vec4 a_normal, b_normal;    // ways it is pulled out, unit, world; w: texture coordinate along the edge, m
  vec4 struck;                // the face that rain strikes; w: share of this edge in the outline
};

#ifdef __cplusplus
static_assert(sizeof(CatcherGpu) == 64 + 8 * 16);
static_assert(sizeof(FinGpu) == 80);
}  // namespace petrichor
#endif
#endif
