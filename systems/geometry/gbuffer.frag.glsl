#version 450 core
#define GBUFFER_WRITER
#include "systems/geometry/material.glsl"

layout(location = 0) out vec4 out_albedo;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out vec3 out_emissive;
layout(location = 3) out vec2 out_water_mask;  // hollow, kind: systems/puddle; only where it is asked for

void main() {
  vec4 colour = base_colour();
  vec2 water_mask;
  Surface s = material_surface(colour, water_mask);
#if (MATERIAL_VARIANT & 16) != 0
  if (colour.a < material.emissive_cutoff.w) discard;
#endif
  out_albedo = encode_albedo(s);
  out_normal = encode_normal(s);
  out_water_mask = water_mask;
  out_emissive = min(s.emissive, vec3(60000.0));
}
