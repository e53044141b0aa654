// The frame's constants and lights, for every shader. Bound by FrameGpu before the first pass.
#ifndef SYSTEMS_FRAME_GLSL
#define SYSTEMS_FRAME_GLSL
#include "systems/frame_shared.h"

layout(std140, binding = FRAME_UNIFORMS_BINDING) uniform FrameBlock { FrameUniforms frame; };
layout(std430, binding = LIGHTS_BINDING) readonly buffer LightBlock { LightGpu lights[]; };

// Optical depth over a distance of the rain and snow that is not drawn drop by drop and flake by flake.
float undrawn_rain_depth(float distance_m) {
  float depth = frame.rain.z * distance_m;
  for (uint i = 0u; i < frame.counts.z; ++i) {
    vec4 o = frame.rain_onsets[i];
    depth += o.x * max(distance_m - o.y, 0.0) + o.z * max(distance_m - o.w, 0.0);
  }
  return depth;
}

#endif
