// What a drip shows of the world, place by place of its disc (shared physics, section 3), and where a lamp glints in it.
#ifndef SYSTEMS_DRIP_OPTICS_GLSL
#define SYSTEMS_DRIP_OPTICS_GLSL
#ifdef ENVIRONMENT
#include "systems/lighting/environment.glsl"
#else
#include "systems/sky.glsl"
#endif

// Mean radiance about a direction, over a solid angle; cd/m2.
vec3 around(vec3 w, float solid_angle) {
#ifdef ENVIRONMENT
  // GGX of roughness r has most of its reflected lobe within about 2 r^2.
  return environment_radiance(w, sqrt(0.5 * sqrt(solid_angle * 0.31831)));
#else
  return sky_radiance(w);
#endif
}

vec3 all_round() {
#ifdef ENVIRONMENT
  return environment_mean();
#else
  return 0.5 * (sky_radiance(vec3(0.0, 0.3, 1.0)) + sky_radiance(vec3(0.0, -1.0, 0.0)));
#endif
}

float water_fresnel(float cos_air, float cos_water) {
  float across = (cos_air - 1.333 * cos_water) / (cos_air + 1.333 * cos_water);
  float within = (1.333 * cos_air - cos_water) / (1.333 * cos_air + cos_water);
  return 0.5 * (across * across + within * within);
}

// d: unit ray from the eye; o: unit, from the disc's centre outwards, across d; b: how far out, 0 to 1; area: that the
// sample stands for, of a disc of area pi. Outer reflection, straight through and one inner reflection: exact
// deviations of a sphere; the rest of the power (0.9%) comes from all round.
vec3 seen_in_drip(vec3 d, vec3 o, float b, float area) {
  b = clamp(b, 0.02, 0.999);
  float sin_water = b / 1.333, cos_air = sqrt(1.0 - b * b), cos_water = sqrt(1.0 - sin_water * sin_water);
  float in_air = asin(b), in_water = asin(sin_water);
  float f = water_fresnel(cos_air, cos_water);
  vec3 share = vec3(f, (1.0 - f) * (1.0 - f), f * (1.0 - f) * (1.0 - f));
  vec3 turn = vec3(3.14159265 - 2.0 * in_air, 2.0 * (in_air - in_water), 3.14159265 + 2.0 * in_air - 4.0 * in_water);
  // Solid angle of what leaves: |sin(turn) d(turn)/db| / b times the area.
  float slope_air = 1.0 / max(cos_air, 0.15), slope_water = 1.0 / (1.333 * cos_water);
  vec3 slope = abs(vec3(2.0 * slope_air, 2.0 * (slope_air - slope_water), 2.0 * slope_air - 4.0 * slope_water));
  vec3 solid = abs(sin(turn)) * max(slope, vec3(0.2)) * (area / b);
  vec3 sum = share.x * around(cos(turn.x) * d + sin(turn.x) * o, solid.x);
  sum += share.y * around(cos(turn.y) * d - sin(turn.y) * o, solid.y);
  sum += share.z * around(cos(turn.z) * d - sin(turn.z) * o, solid.z);
  return sum + (1.0 - share.x - share.y - share.z) * all_round();
}

// Of a lamp's image in the disc, in radii: at least so wide that pixels, and the places along a way, find it.
float glint_width(float r) { return max(0.27, 0.4 / r); }

// The mean of that image over a disc of r pixels with the edge of a pixel, weighted as drips_over.frag.glsl weights
// it: what falls beyond the rim is given back, so that the lamp's light is kept however small the disc.
float glint_mean(float at, float r) {
  float width = glint_width(r), rim = 1.0 + 0.5 / r;
  vec2 sum = vec2(0.0);
  for (int i = 0; i < 12; ++i) {
    float b = rim * (float(i) + 0.5) / 12.0;
    float weight = b * min((rim - b) * r, 1.0);
    for (int j = 0; j < 12; ++j) {
      float turn = 0.2617993878 * (float(j) + 0.5);  // half of the circle: the other is its mirror image
      float away2 = b * b + at * at - 2.0 * b * at * cos(turn);
      sum += weight * vec2(exp(-0.5 * away2 / (width * width)), 1.0);
    }
  }
  return max(sum.x / sum.y, 1e-6);
}

// Where in the disc a lamp is seen whose light turns by `turn` on its way through the drop to the eye: distance from the
// centre, 0 to 1; negative: on the side away from the lamp, where light comes straight through.
float glint_at(float turn) {
  // Through: turn = 2 (asin b - asin(b / n)), up to 82.8 degrees.
  if (turn < 1.44) {
    float low = 0.0, high = 1.0;
    for (int i = 0; i < 10; ++i) {
      float b = 0.5 * (low + high);
      if (2.0 * (asin(b) - asin(b / 1.333)) < turn) low = b; else high = b;
    }
    return -low;
  }
  return cos(0.5 * turn);  // reflected: turn = pi - 2 asin b
}

#endif
