// Standing water at a place (Tatarchuk and Isidoro 2006, section 4, "Puddle Placement and Depth"; shared physics,
// section 9). Pass "puddles" binds the buffers: ask nothing of this file where has("puddle_list") is false.
#ifndef SYSTEMS_PUDDLE_PUDDLE_GLSL
#define SYSTEMS_PUDDLE_PUDDLE_GLSL
#include "systems/geometry/gbuffer.glsl"
#include "systems/puddle/puddle_shared.h"
#include "systems/wet_materials.glsl"

layout(std430, binding = PUDDLE_LIST_BINDING) readonly buffer PuddleListBlock {
  PuddleListGpu puddle_list;
  PuddleGpu puddles[];
};
layout(std430, binding = PUDDLE_CELLS_BINDING) readonly buffer PuddleCells { uvec2 puddle_cells[]; };

struct StandingWater {
  float depth_m;     // 0: none
  float influence;   // of the water's normal against the surface's, 0 to 1 (the paper's p_i with d_i)
  float ripple_scale, ripple_turn_rad;  // s_o, theta_o
  vec3 tint;         // transmittance per metre of what the bottom shows through the water
};

// Thickness of the free edge of a puddle, 2 l_c sin(contact angle / 2): from there on its surface is its own.
const float puddle_edge_m = 0.0023;

// place: metres relative to the camera; mask: of the G-buffer's water_mask (r: hollow, 0 to 1, g: kind of material).
StandingWater standing_water(vec3 place, vec2 mask) {
  StandingWater water = StandingWater(0.0, 0.0, 1.0, 0.0, vec3(1.0));
  vec2 at = (place.xz - puddle_list.cells.xy) * puddle_list.cells.z;
  bool asks = (mask.x > 0.0 || puddle_list.counts.w != 0u) && wet_kind(mask) != 0u && puddle_list.counts.z != 0u &&
              all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(puddle_list.counts.xy)));
  // Loops for ifs: software OpenGL leaves a loop that no pixel is in, but walks through both sides of a branch.
  for (int once = 0; once < (asks ? 1 : 0); ++once) {
    WetMaterialGpu material = wet_materials[wet_kind(mask)];
    float below_brim = mask.x * material.absorption_depth.w;
    uvec2 near = puddle_cells[uint(at.y) * puddle_list.counts.x + uint(at.x)];
    vec4 p = vec4(place, 1.0);
    float best = PUDDLE_BELOW_M;  // of how far a puddle's brim lies from the one that the mask speaks of
    uint chosen = 0u;
    float depth = 0.0;
    while (near.x != 0u) {
      uint i = (near.x & 255u) - 1u;
      near.x = near.x >> 8 | near.y << 24;
      near.y >>= 8;
      vec2 along = abs(vec2(dot(puddles[i].row_x, p), dot(puddles[i].row_z, p)));
      float height = dot(puddles[i].row_y, p);
      bool by_height = puddles[i].ripple.w > 0.5;
      float off = by_height ? max(height, -height - puddles[i].size_level.z) : abs(height + below_brim);
      if (along.x < puddles[i].size_level.x && along.y < puddles[i].size_level.y && off < best &&
          (by_height || below_brim > 0.0)) {
        best = off;
        chosen = i + 1u;
        depth = (by_height ? -height : below_brim) - puddles[i].size_level.w;
      }
    }
    if (chosen != 0u && depth > 0.0) {
      vec4 ripple = puddles[chosen - 1u].ripple;
      water.depth_m = depth;
      // As printed the normal blends by d_i, the mask's own value; water hides its bed once it stands over the stones.
      float closed = smoothstep(0.0, puddle_edge_m, depth);
      float d = mix(closed, mask.x > 0.0 ? mask.x : closed, puddle_list.cells.w);
      water.influence = clamp(d * ripple.x * material.ripple.x, 0.0, 1.0);
      water.ripple_scale = ripple.y * material.ripple.y;
      water.ripple_turn_rad = ripple.z + material.ripple.z;
      water.tint = exp(-material.absorption_depth.rgb);
    }
  }
  return water;
}

// What a bed looks like under water. s: the bed, as it looks soaked; view: unit, towards the viewer; slope: of the
// water's surface, dy/dx and dy/dz; roughness: perceptual, of the waves that no pixel shows.
//   Beer and Lambert along the light's way in, (mean slant 2 n^2 (1 - sqrt(1 - 1/n^2)) = 1.205 of diffuse light under
//   water of n = 1.33), and out, where refraction shortens it: cos_t = sqrt(1 - (1 - cos^2) / n^2).
Surface under_water(Surface s, StandingWater water, vec3 view, vec2 slope, float roughness) {
  float across = clamp(view.y, 0.0, 1.0);
  float inside = sqrt(1.0 - (1.0 - across * across) / (1.33 * 1.33));
  float way_m = water.depth_m * (1.205 + 1.0 / inside);
  s.albedo *= pow(water.tint, vec3(way_m));
  vec3 level = normalize(vec3(-slope.x, 1.0, -slope.y));
  s.normal = normalize(mix(s.normal, level, water.influence));
  s.roughness = mix(s.roughness, roughness, water.influence);
  s.metallic *= 1.0 - water.influence;
  s.occlusion = mix(s.occlusion, 1.0, water.influence);
  s.water = max(s.water, clamp(water.depth_m / puddle_edge_m, 0.0, 1.0));
  return s;
}

#endif
