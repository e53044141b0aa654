// Standing water at a place. Pass "puddles" binds the buffers.
#ifndef SYSTEMS_PUDDLE_PUDDLE_GLSL
#define SYSTEMS_PUDDLE_PUDDLE_GLSL
#include "systems/frame.glsl"

struct StandingWater {
  float depth_m;     // 0: none
  float influence;   // of the water's normal against the surface's, 0 to 1 (the paper's p_i with d_i)
  float ripple_scale, ripple_turn_rad;  // s_o, theta_o
  vec3 tint;         // transmittance per metre of what the bottom shows through the water
};

// place: metres relative to the camera; mask: of the G-buffer's water_mask (r: hollow, 0 to 1, g: kind of material).
StandingWater standing_water(vec3 place, vec2 mask) { return StandingWater(0.0, 0.0, 1.0, 0.0, vec3(1.0)); }

#endif
