// What a drop shows, by the deviations of its rays as curves of the angle of incidence (shared physics, 3a and 3c).
#ifndef SYSTEMS_RAINFALL_NEAR_OPTICS_GLSL
#define SYSTEMS_RAINFALL_NEAR_OPTICS_GLSL
#include "systems/rainfall/near_drops/near_shared.h"

// x: deviation straight through, rad; y, z, w: shares of the outer reflection, straight through, one inner reflection.
layout(std430, binding = NEAR_CURVE_BINDING) readonly buffer NearCurve { vec4 curve[NEAR_CURVE + 1]; };
layout(binding = 1) uniform samplerCube near_world;  // cd/m2; a: 1 / distance of what is seen, 1/m
uniform vec3 captured_from;  // relative to the camera, m
uniform int world_is;        // 0 at infinity, 1 where the capture saw it, 2 on the cube of NEAR_CUBE_M about the camera
uniform float texel_sr;      // of near_world, on average
uniform float coarsest;      // its last level

vec3 towards(vec3 from, vec3 w, float level) {
  if (world_is == 0) return w;
  if (world_is == 2) {
    vec3 faces = (sign(w) * (0.5 * NEAR_CUBE_M) - from) / max(abs(w), vec3(1e-6)) * sign(w);
    return from + w * max(min(faces.x, min(faces.y, faces.z)), 0.0);
  }
  // Where the ray from the drop meets what the capture saw: once along the ray, once towards that guess.
  float along = dot(from, w), square = dot(from, from);
  vec3 seen = w;
  for (int i = 0; i < 2; ++i) {
    float away = 1.0 / max(textureLod(near_world, seen, level).a, 1e-3);
    seen = from + w * max(sqrt(max(along * along - square + away * away, 0.0)) - along, 0.0);
  }
  return seen;
}

// Radiance that reaches a place near the capture from a unit direction, as the mean over a solid angle.
vec3 world_seen(vec3 from, vec3 w, float solid_angle) {
  float level = clamp(0.5 * log2(max(solid_angle, 1e-9) / texel_sr), 0.0, coarsest);
  return textureLod(near_world, towards(from, w, level), level).rgb;
}

// place: of the drop, relative to the capture; d: unit ray from the eye; o: unit, from the disc's centre outwards,
// across d; b: distance from the centre, 0 to 1; area: what the sample stands for, of a disc of area pi.
vec3 seen_in_drop(vec3 place, vec3 d, vec3 o, float b, float area) {
  b = min(b, 0.9998);
  float in_angle = asin(b);
  float at = in_angle * (float(NEAR_CURVE) / 1.5707963268);
  int i = min(int(at), NEAR_CURVE - 1);
  vec4 c = mix(curve[i], curve[i + 1], at - float(i));
  float through = c.x, inside = in_angle - 0.5 * through;
  vec3 angle = vec3(3.1415926536 - 2.0 * in_angle, through, through + 3.1415926536 - 2.0 * inside);
  // Solid angle of the outgoing bundle: |sin(angle) d(angle)/db| / b times the area.
  float cos_in = sqrt(1.0 - b * b), cos_inside = 1.333 * cos(inside);
  vec3 slope = vec3(2.0, 2.0 - 2.0 * cos_in / cos_inside, 2.0 - 4.0 * cos_in / cos_inside) / max(cos_in, 0.15);
  vec3 solid = abs(sin(angle) * max(abs(slope), vec3(0.2))) * (area / max(b, 0.02));
  vec3 sum = c.y * world_seen(place, cos(angle.x) * d + sin(angle.x) * o, solid.x);
  sum += c.z * world_seen(place, cos(angle.y) * d - sin(angle.y) * o, solid.y);
  sum += c.w * world_seen(place, cos(angle.z) * d - sin(angle.z) * o, solid.z);
  // Two inner reflections and more, 0.9% of the power, come from all round.
  return sum + (1.0 - c.y - c.z - c.w) * textureLod(near_world, d, coarsest).rgb;
}

#endif
