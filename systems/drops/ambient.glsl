// What a drop shows of its surroundings, lamps apart. C++: RainOptics::set_ambient, and the environment at unit 7.
#ifndef SYSTEMS_DROPS_AMBIENT_GLSL
#define SYSTEMS_DROPS_AMBIENT_GLSL
#ifdef ENVIRONMENT
#include "systems/lighting/environment.glsl"
#endif
uniform vec3 ambient[4];  // a drop's radiance, cd/m2, as a cubic in the sine of the view's elevation

// Mean radiance of the disc of a drop that is seen along a unit ray, cd/m2.
vec3 drop_ambient(vec3 ray) {
#if defined(ENVIRONMENT) && defined(SNOW)
  // By the lobes of snow/flake_optics.hpp: the forward one is some 80 degrees wide.
  return 0.7 * environment_radiance(ray, 0.8) + 0.3 * environment_mean();
#elif defined(ENVIRONMENT)
  // A drop shows what lies behind it, inverted and gathered from a lobe about 30 degrees wide (median 25), and a
  // fifteenth of all round it.
  return 0.93 * environment_radiance(ray, 0.55) + 0.0664 * environment_mean();
#else
  return max(ambient[0] + ray.y * (ambient[1] + ray.y * (ambient[2] + ray.y * ambient[3])), vec3(0.0));
#endif
}

#endif
