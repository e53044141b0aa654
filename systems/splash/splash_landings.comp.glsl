#version 450 core
// Splashes of drips, where the simulation of drips says that they landed.
layout(local_size_x = 64) in;
#define LISTS
#include "systems/splash/splash.glsl"

layout(std430, binding = SPLASH_LANDINGS_BINDING) readonly buffer SplashLandings { SplashLandingGpu landings[]; };
uniform uint landing_count;

void main() {
  uint index = gl_GlobalInvocationID.x;
  if (index >= landing_count) return;
  SplashLandingGpu landing = landings[index];
  vec3 velocity = landing.velocity_diameter.xyz;
  Impact i;
  i.place = landing.place_age.xyz;
  i.age = landing.place_age.w;
  if (!meet_surface(velocity, i)) return;
  i.age = landing.place_age.w;  // when it landed is known; only the place is moved onto what is drawn
  if (splash_random(landing.bits.x, 4u) >= float(landing.bits.y) / 65536.0) return;
  SplashGpu s;
  if (!begin_splash(i, velocity, landing.velocity_diameter.w, landing.bits.x, reach.w > 0.0, 1.0, s)) return;
  vec3 from = above(i);
  float distance_to_eye = length(from);
  vec3 sum = vec3(0.0);
  for (uint n = 0u; n < frame.counts.x; ++n)
    if (lights[n].cone_shadow.w != 0.0) sum += lamp_light(lights[n], from, distance_to_eye);
  light_splash(s, sum);
  list_splash(s);
}
