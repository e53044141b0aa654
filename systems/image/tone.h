// From exposed linear light to the display, for C++ (tests) and GLSL.
#ifndef SYSTEMS_IMAGE_TONE_H
#define SYSTEMS_IMAGE_TONE_H

#ifdef __cplusplus
#include <glm/glm.hpp>
#define TONE_FN inline
namespace petrichor::tone {
using glm::clamp, glm::dot, glm::fract, glm::max, glm::min, glm::mix, glm::vec2, glm::vec3, glm::vec4;
#else
#define TONE_FN
#endif

TONE_FN float luminance(vec3 c) {
  return dot(c, vec3(0.2126f, 0.7152f, 0.0722f));
}

// A film print's curve as a ratio of quadratics, its sRGB encoding included (the form of Hejl and Burgess-Dawson,
// GDC 2010, without its black offset): 0 -> 0, 0.18 -> 0.51, 1 -> 0.84, and towards 1 for ever. Its toe is a
// little darker than sRGB's: nights keep their blacks, and no value is crushed.
TONE_FN vec3 film_curve(vec3 x) {
  return (x * (x * 6.2f + 0.5f)) / (x * (x * 6.2f + 1.7f) + 0.06f);
}

// Exposed linear light -> display values in [0, 1). Strong lights bleed into the other channels before the curve,
// so that a neon tube turns pale where it is brightest and keeps its hue around (the idea of Sobotka's AgX).
TONE_FN vec3 tone_map(vec3 exposed) {
  vec3 c = max(exposed, vec3(0.0f));
  float y = luminance(c);
  float bleeding = 0.02f + 0.10f * y / (y + 2.0f);
  return film_curve(mix(c, vec3(y), bleeding));
}

// Interleaved gradient noise (Jimenez 2014, "Next Generation Post Processing in Call of Duty"), in [0, 1): every
// 3x3 block holds an even spread of values, so the grain is fine.
TONE_FN float dither_noise(vec2 pixel) {
  return fract(52.9829189f * fract(dot(pixel, vec2(0.06711056f, 0.00583715f))));
}

// Rounds display values to 8 bits up or down by chance, such that the mean is right. Store as unorm.
TONE_FN vec3 dithered(vec3 display, vec2 pixel) {
  float noise = dither_noise(pixel) - 0.5f;
  return clamp(display + vec3(noise) * (1.0f / 255.0f), vec3(0.0f), vec3(1.0f));
}

#ifdef __cplusplus
}  // namespace petrichor::tone
#endif
#endif
