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

// Where the rain's techniques without classes begin among the onsets, and where the snow does, whose last is its cone.
const uint first_other_onset = 5u, first_snow_onset = 8u;

// The same in two groups, extinction and mean onset each: of the fields, whose drops and flakes leave one by one, class
// by class, over a long way; and of the techniques that end at one distance. Order of the onsets: update_onsets().
void undrawn_rain_groups(out vec2 fields, out vec2 others) {
  fields = others = vec2(0.0);
  for (uint i = 0u; i < 2u * frame.counts.z; ++i) {
    vec2 onset = (i & 1u) == 0u ? frame.rain_onsets[i >> 1u].xy : frame.rain_onsets[i >> 1u].zw;
    vec2 weighed = vec2(onset.x, onset.x * onset.y);
    bool ends_at_once = (i >= first_other_onset && i < first_snow_onset) || i == 2u * uint(RAIN_ONSET_PAIRS) - 1u;
    if (ends_at_once) others += weighed;
    else fields += weighed;
  }
  fields.y = fields.x > 0.0 ? fields.y / fields.x : 0.0;
  others.y = others.x > 0.0 ? others.y / others.x : 0.0;
}

#endif
