// What a drop does when it strikes a surface: one text for C++ (tests, ledgers) and GLSL. SI units.
// Sources by shared physics, section 6: Mundo et al. 1995 (dry, rough), Cossali et al. 1997 (film), Bai and Gosman 1995
// (wetted), Stow and Hadfield 1981 (smooth), Yarin and Weiss 1995 (radius of the crown).
#ifndef SYSTEMS_SPLASH_IMPACT_H
#define SYSTEMS_SPLASH_IMPACT_H

#ifdef __cplusplus
#include <glm/glm.hpp>
#define IMPACT_FN inline
namespace petrichor::impact {
using glm::clamp, glm::exp, glm::log, glm::max, glm::min, glm::pow, glm::sqrt, glm::vec2, glm::vec3;
using uint = unsigned;
#else
#define IMPACT_FN
#endif

const float WATER_DENSITY = 998.0f;          // kg/m3
const float WATER_TENSION = 0.0728f;         // N/m
const float WATER_VISCOSITY = 1.0e-3f;       // Pa s
const float IMPACT_GRAVITY = 9.81f;
const float SMOOTH_ROUGHNESS = 0.25f;  // perceptual: paint, polished stone and glass are below
const float TOP_ROUGHNESS = 0.85f;     // where nobody knows: asphalt

// The speed is the component across the surface: an oblique drop splashes no more than a slow one.
IMPACT_FN float weber(float diameter, float speed) { return WATER_DENSITY * speed * speed * diameter / WATER_TENSION; }
IMPACT_FN float reynolds(float diameter, float speed) { return WATER_DENSITY * speed * diameter / WATER_VISCOSITY; }
IMPACT_FN float ohnesorge(float diameter) {
  return WATER_VISCOSITY / sqrt(WATER_DENSITY * WATER_TENSION * max(diameter, 1e-6f));
}
IMPACT_FN float mundo_k(float diameter, float speed) {
  return ohnesorge(diameter) * pow(reynolds(diameter, speed), 1.25f);
}

// Each threshold as a ratio: above 1 the drop splashes, below it spreads.
IMPACT_FN float splash_on_dry(float diameter, float speed) { return mundo_k(diameter, speed) / 57.7f; }
IMPACT_FN float splash_on_film(float diameter, float speed, float film) {
  float h = clamp(film / diameter, 0.1f, 1.0f);  // what Cossali measured
  return weber(diameter, speed) * pow(ohnesorge(diameter), -0.4f) / (2100.0f + 5880.0f * pow(h, 1.44f));
}
IMPACT_FN float splash_on_wetted(float diameter, float speed) {
  float oh = ohnesorge(diameter);
  return weber(diameter, speed) / (1320.0f * pow(1.0f / (oh * oh), -0.18f));
}
IMPACT_FN float splash_on_smooth(float diameter, float speed) {
  return pow(reynolds(diameter, speed), 0.31f) * pow(weber(diameter, speed), 0.69f) / 7000.0f;
}
// film: m of water on the surface, standing or running; roughness: perceptual.
IMPACT_FN float splash_number(float diameter, float speed, float film, float roughness) {
  if (film >= 0.1f * diameter) return splash_on_film(diameter, speed, film);
  // A wet street is smooth to the eye, too: only where the film is next to nothing is it the polish that counts.
  if (roughness < SMOOTH_ROUGHNESS && film < 0.02f * diameter) return splash_on_smooth(diameter, speed);
  if (film > 2e-6f) return splash_on_wetted(diameter, speed);
  return splash_on_dry(diameter, speed);
}

// Seconds that a crown lives: it rises and falls back in the capillary time of its drop, and half as long again.
IMPACT_FN float splash_life(float diameter) {
  return 1.5f * sqrt(WATER_DENSITY * diameter * diameter * diameter / WATER_TENSION);
}
// The crown's radius grows as R/D = (2/3)^(1/4) (h/D)^(-1/4) sqrt(V t/D), on films of 0.1 to 1 D, until it stops.
const float CROWN_STOPS = 16.0f;  // V t / D, or the capillary time if that comes first
IMPACT_FN float crown_radius(float diameter, float speed, float film, float t) {
  float h = clamp(film / diameter, 0.1f, 1.0f);
  float stops = min(CROWN_STOPS, sqrt(weber(diameter, speed)));
  return diameter * 0.9036f * pow(h, -0.25f) * sqrt(clamp(speed * t / diameter, 0.0f, stops));
}
// Where there is no film a low corona stands at the rim of the lamella, whose spread is We^(1/4) D at most.
IMPACT_FN float corona_radius(float diameter, float speed) {
  return 0.5f * diameter * pow(weber(diameter, speed), 0.25f);
}

// Secondary droplets: 10 to 100 of 0.05 to 0.25 D at 0.1 to 1 V, the slower the larger, 30 to 70 degrees up.
IMPACT_FN uint secondary_count(float diameter, float speed) {
  return uint(10.0f + 90.0f * clamp((mundo_k(diameter, speed) - 57.7f) / 800.0f, 0.0f, 1.0f));
}
// q: the droplet's place in the order of sizes, (number + random) / count. Of a hundred droplets the cubes of the
// diameters sum to a quarter of the drop's, and to no more than a quarter and the largest one's 1/64.
IMPACT_FN float secondary_diameter(float diameter, float q) {
  return 0.05f * diameter * pow(5.0f, q * sqrt(q));
}
IMPACT_FN float secondary_speed(float speed, float diameter, float droplet) {
  return 0.1f * speed * pow(0.25f * diameter / droplet, 1.43068f);  // 1 V at 0.05 D
}
IMPACT_FN float droplet_fall_speed(float droplet) {  // terminal, m/s; 2.8% above 0.5 mm and never negative
  return 9.40f * (1.0f - exp(-1570.0f * pow(droplet, 1.15f)));
}
// Metres along its first direction, and metres fallen, so long after a droplet left: quadratic drag along the way out
// and on the way down, each in closed form, as if they did not know of one another.
IMPACT_FN vec2 secondary_way(float speed, float droplet, float t) {
  float v = droplet_fall_speed(droplet);
  float drag = IMPACT_GRAVITY / (v * v);
  float x = IMPACT_GRAVITY * t / v;
  // ln cosh x without overflow.
  float fallen = v * v / IMPACT_GRAVITY * (x + log(0.5f + 0.5f * exp(-2.0f * x)));
  return vec2(log(1.0f + drag * speed * t) / drag, fallen);
}
const float SECONDARY_LIFE = 0.16f;  // s: by then most have landed

#ifdef __cplusplus
}  // namespace petrichor::impact
#endif
#endif
