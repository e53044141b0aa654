// Slopes of the ripples at a place. Bind the texture of slot "ripples" to RIPPLE_UNIT (define it before the include).
#ifndef SYSTEMS_RIPPLE_RIPPLE_GLSL
#define SYSTEMS_RIPPLE_RIPPLE_GLSL
#include "systems/frame.glsl"

#ifndef RIPPLE_UNIT
#define RIPPLE_UNIT 8
#endif
layout(binding = RIPPLE_UNIT) uniform sampler2DArray ripple_map;  // layer 0: the repeated tile, 1: the tile of the world near the eye

// dy/dx and dy/dz of the water's surface. place: metres relative to the camera; scale, turn_rad: of the object's
// look-up in the repeated tile (s_o and theta_o of the paper).
vec2 ripple_slope(vec3 place, float scale, float turn_rad) { return vec2(0.0); }

#endif
