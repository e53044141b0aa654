// The frame's constants and lights, for every shader. Bound by FrameGpu before the first pass.
#ifndef SYSTEMS_FRAME_GLSL
#define SYSTEMS_FRAME_GLSL
#include "systems/frame_shared.h"

layout(std140, binding = FRAME_UNIFORMS_BINDING) uniform FrameBlock { FrameUniforms frame; };
layout(std430, binding = LIGHTS_BINDING) readonly buffer LightBlock { LightGpu lights[]; };

#endif
