// Slopes of the ripples at a place. Bind the texture of slot "ripples" to RIPPLE_UNIT (define it before the include) and
// ask nothing of this file where has("ripples") is false.
#ifndef SYSTEMS_RIPPLE_RIPPLE_GLSL
#define SYSTEMS_RIPPLE_RIPPLE_GLSL
#include "systems/frame.glsl"
#include "systems/ripple/ripple_shared.h"

#ifndef RIPPLE_UNIT
#define RIPPLE_UNIT 8
#endif
// Layers: 0 the repeated tile; 1 the rain's in the tile of the world near the eye; 2 drips' rings there.
layout(binding = RIPPLE_UNIT) uniform sampler2DArray ripple_map;
layout(std140, binding = RIPPLE_UNIFORMS_BINDING) uniform RippleBlock { RippleUniforms ripples; };

// Half the extent of a pixel on level water, m: across the view, and along it.
vec2 ripple_footprint(vec3 place) {
  float away = length(place);
  float across = 0.5 * away / frame.lens.z;
  return vec2(across, across * away / max(abs(place.y), 0.02 * away));
}

// Share of a wave's variance that a pixel shows, of waves that run all ways. Along and across the view the mean over the
// pixel takes exp(-(k f)^2) from each; over all directions of crests that is 1 / sqrt of either.
float ripple_shown(vec2 footprint, float wave_number) {
  vec2 f = 0.6 * footprint * wave_number;
  f *= f;
  return inversesqrt((1.0 + f.x) * (1.0 + f.y));
}

struct Ripples {
  vec2 slope;      // dy/dx, dy/dz as far as the pixel shows them
  float variance;  // mean square of what is left out, both ways together: GGX's roughness^2 (alpha^2) grows by it
};

// place: metres relative to the camera; scale, turn_rad: of the object's look-up in the repeated tile (s_o and theta_o
// of Tatarchuk and Isidoro 2006, section 4); open: share of the rain that arrives there (under a roof only drips ring).
Ripples ripples_at(vec3 place, float scale, float turn_rad, float open) {
  vec2 footprint = ripple_footprint(place);
  // The shared tile, turned and scaled.
  vec2 world = place.xz + frame.camera_world_m.xz;
  float c = cos(turn_rad), s = sin(turn_rad);
  vec2 uv = vec2(c * world.x - s * world.y, s * world.x + c * world.y) * (ripples.tile.x / scale);
  float shared_number = ripples.slopes.y / scale;
  float shared_shown = ripple_shown(footprint, shared_number);
  vec2 slope = vec2(0.0);
  float left = ripples.tile.y * (1.0 - shared_shown);
  float near = 0.0, full = 0.0;
  vec2 near_uv = (place.xz - ripples.near_place.xy) * ripples.near_place.z;
  vec2 to_edge = 0.5 - abs(near_uv - 0.5);
  float inside = min(to_edge.x, to_edge.y);
  if (ripples.near_place.w > 0.0 && inside > 0.0) {
    // 14 cells of 256 swallow waves; they are not shown.
    near = smoothstep(0.06, 0.06 + 0.5 * ripples.slopes.w, inside) * ripples.near_place.w;
    vec4 found = textureLod(ripple_map, vec3(near_uv, 1.0), ripples.tile.w);
    full = near * found.z;
    float near_shown = ripple_shown(footprint, ripples.slopes.z);
    // What has just come into the tile has few waves yet: the shared tile fills up, by variance.
    slope += found.xy * sqrt(near * near_shown);
    left = mix(left, 1.0 - near_shown, full);
  }
  if (full < 0.999 && ripples.tile.y > 0.0) {
    vec2 found = textureLod(ripple_map, vec3(uv, 0.0), ripples.tile.w).xy;
    slope += vec2(c * found.x + s * found.y, c * found.y - s * found.x) * sqrt((1.0 - full) * shared_shown);
  }
  slope *= open;
  float variance = left * ripples.slopes.x * open * open;
  if (ripples.tile.z > 0.0 && inside > 0.0) {
    float shown = ripple_shown(footprint, ripples.slopes.z);
    vec2 found = textureLod(ripple_map, vec3(near_uv, 2.0), ripples.tile.w).xy * smoothstep(0.0, 0.08, inside);
    slope += found * sqrt(shown);
    variance += dot(found, found) * (1.0 - shown);
  }
  return Ripples(slope, variance);
}

// dy/dx and dy/dz of the water's surface in the open.
vec2 ripple_slope(vec3 place, float scale, float turn_rad) { return ripples_at(place, scale, turn_rad, 1.0).slope; }
// Mean square slope that the pixel does not show, both ways together.
float ripple_variance(vec3 place, float scale, float turn_rad) {
  return ripples_at(place, scale, turn_rad, 1.0).variance;
}

#endif
