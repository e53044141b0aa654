// What a lamp gives a falling drop.
#ifndef SYSTEMS_DROPS_LAMP_LIGHT_GLSL
#define SYSTEMS_DROPS_LAMP_LIGHT_GLSL
#include "systems/frame.glsl"
#include "systems/drops/rain_shared.h"

layout(std430, binding = RAIN_OPTICS_BINDING) readonly buffer RainOptics {
  float phase[RAIN_PHASE_BINS];
};

// Radiance of a drop's disc per irradiance on it, 1/sr; cosine of the turn from the light's direction to the eye's: 1
// where the drop stands before the lamp.
float drop_phase(float cosine) {
  return phase[min(uint(sqrt(max(0.5 - 0.5 * cosine, 0.0)) * float(RAIN_PHASE_BINS)), uint(RAIN_PHASE_BINS - 1))];
}

#endif
