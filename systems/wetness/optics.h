// What a film of water does to the look of a surface, one text for C++ (tests, truths) and GLSL.
//
// Sources: the film over a diffuse base, Angstrom's series summed, shared physics, section 9 (Lekner and Dorf 1988);
// water in pores, Twomey, Bohren and Mergenthaler 1986, "Reflectance and albedo differences between wet and dry
// surfaces", Applied Optics 25(3); the published factors, Lagarde 2013, "Water drop 3b - Physically based wet surfaces".
#ifndef SYSTEMS_WETNESS_OPTICS_H
#define SYSTEMS_WETNESS_OPTICS_H

#ifdef __cplusplus
#include <glm/glm.hpp>
#define WETNESS_FN inline
namespace petrichor::wetness {
using glm::clamp, glm::exp, glm::max, glm::min, glm::mix, glm::sqrt, glm::vec3;
#else
#define WETNESS_FN
#endif

const float WATER_RE = 0.0664f;  // reflectance of a smooth water surface to light from everywhere
const float WATER_P = 0.4746f;   // share of diffuse light from below that the surface turns back: 1 - (1 - Re) / n^2
const float WATER_F0 = 0.0200f;  // head-on

// Albedo of a diffuse base of albedo a under a film: (1 - Re)(1 - p) a / (1 - p a).
WETNESS_FN vec3 film_albedo(vec3 a) { return (1.0f - WATER_RE) * (1.0f - WATER_P) * a / (vec3(1.0f) - WATER_P * a); }

// The same before the light that comes in or goes out has met the surface once: what a G-buffer must hold where shading
// takes Fresnel's share away from the diffuse light itself (shade.comp.glsl does, at the angle of view).
WETNESS_FN vec3 film_base_colour(vec3 a) { return (1.0f - WATER_P) * a / (vec3(1.0f) - WATER_P * a); }

// Water in the pores scatters light ahead, so it goes deeper and more of it is absorbed: the similarity (1 - w)/(1 - w g)
// of a deep scattering body, R = (1 - s)/(1 + 1.17 s), with (1 - g) divided by `ahead`.
WETNESS_FN vec3 porous_albedo(vec3 a, float ahead) {
  vec3 s = (vec3(1.0f) - a) / (vec3(1.0f) + 1.17f * a);
  vec3 q = s * s;
  s = sqrt(ahead * q / (vec3(1.0f) + (ahead - 1.0f) * q));
  return (vec3(1.0f) - s) / (vec3(1.0f) + 1.17f * s);
}

// `ahead` of pores that are full, at porosity 1. Lagarde's factor of 0.2 for the most porous stone is for film and pores
// together. The film alone is 0.57 at an albedo of 0.3 (0.50 at 0.05), so the factor would leave the pores 0.35, at any
// albedo; soils, concrete and brick were measured to keep 0.4 to 0.6 of their albedo when wet. With 1.6 a base of 0.3
// keeps 0.42 and one of 0.05 keeps 0.32; at porosity 0 the film model is left as it is.
const float PORES_AHEAD = 1.6f;

// A film so thin already wets: it takes the place of air at the base. m.
const float WETTING_FILM_M = 20e-6f;
WETNESS_FN float wetted_share(float film_m) { return 1.0f - exp(-film_m / WETTING_FILM_M); }

// Share of a rough surface that lies below the water's level, when water of this mean depth fills its valleys. For
// Gaussian heights of deviation s the level z s satisfies h = s (z Phi(z) + phi(z)) and the share is Phi(z), which is
// 1 - exp(-1.7 h/s) within 0.03.
WETNESS_FN float drowned_share(float film_m, float relief_m) {
  return 1.0f - exp(-1.7f * film_m / max(relief_m, 1e-6f));
}

// Deviation of the relief that goes with a dry perceptual roughness: a guess (0.9, coarse asphalt: 0.44 mm; 0.5, planed
// stone: 0.08 mm; 0.2, glazed tile: 5 um).
WETNESS_FN float relief_m(float roughness) { return 0.6e-3f * roughness * roughness * roughness; }

// Deviation of the relief of normal maps (bumps of stone, pores of asphalt): a guess.
const float MAPPED_RELIEF_M = 0.8e-3f;

// Lagarde's guess of how porous a dielectric is: saturate(((1 - gloss) - 0.5) / 0.4).
WETNESS_FN float porosity_of_roughness(float roughness) { return clamp((roughness - 0.5f) / 0.4f, 0.0f, 1.0f); }

// How far a surface is matte enough for water to darken it at all. Paint, glazed tile and glass are seen through an
// interface of their own already, and water beads on them.
WETNESS_FN float takes_film(float roughness, float metallic) {
  float t = clamp((roughness - 0.2f) / 0.25f, 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t) * (1.0f - metallic);
}

// Albedo of a surface of which `wetted` has a film and whose pores are filled to `soaked` (0 to 1).
WETNESS_FN vec3 wet_albedo(vec3 dry, float porosity, float soaked, float wetted) {
  vec3 base = porous_albedo(dry, 1.0f + (PORES_AHEAD - 1.0f) * porosity * soaked);
  return mix(base, film_albedo(base), wetted);
}
// The same for the G-buffer (see film_base_colour).
WETNESS_FN vec3 wet_base_colour(vec3 dry, float porosity, float soaked, float wetted) {
  vec3 base = porous_albedo(dry, 1.0f + (PORES_AHEAD - 1.0f) * porosity * soaked);
  return mix(base, film_base_colour(base), wetted);
}

// Lagarde's factors as printed: diffuse *= lerp(1, f, wet), gloss = lerp(1, gloss, lerp(1, f, 0.5 wet)),
// f = lerp(1, 0.2, (1 - metal) porosity).
WETNESS_FN float published_factor(float porosity, float metallic) { return 1.0f - 0.8f * (1.0f - metallic) * porosity; }
WETNESS_FN float published_gloss(float gloss, float factor, float wet) {
  return 1.0f + (gloss - 1.0f) * (1.0f + (factor - 1.0f) * 0.5f * wet);
}

// Root mean square slope that drops keep up on a film: for a puddle at 10 and 50 mm/h 0.03 and 0.07, in the middle of
// what shared physics, section 5, estimates (five-fold uncertain); waves of a few centimetres die on films much
// thinner than a millimetre.
WETNESS_FN float film_slope_rms(float rain_mm_per_hour, float film_m) {
  return 0.01f * sqrt(max(rain_mm_per_hour, 0.0f)) * clamp(film_m * 1e3f, 0.0f, 1.0f);
}

#ifdef __cplusplus
}  // namespace petrichor::wetness
#endif
#endif
