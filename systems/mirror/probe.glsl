// What objects mirror that have a cube map of their own (Tatarchuk and Isidoro 2006, section 6.3: "dynamic cubemap
// environment reflections for animated objects"). Pass "probes" binds the block; bind the texture of slot "probes" to
// PROBES_UNIT and ask only where has("probes").
#ifndef SYSTEMS_MIRROR_PROBE_GLSL
#define SYSTEMS_MIRROR_PROBE_GLSL
#include "systems/lighting/lighting_shared.h"
#include "systems/lighting/octahedral.glsl"
#include "systems/mirror_shared.h"

#ifndef PROBES_UNIT
#define PROBES_UNIT 10
#endif
layout(binding = PROBES_UNIT) uniform sampler2DArray probe_maps;
layout(std140, binding = PROBES_BINDING) uniform ProbesBlock { ProbesGpu probes; };

// A tile of the octahedral layout (environment.glsl): rgb cd/m2, a 1 / distance, 1/m.
vec4 probe_tile(int probe, vec3 direction, float level) {
  const float inner = float(ENVIRONMENT_TILE - 2 * ENVIRONMENT_BORDER);
  vec2 texel = vec2(level * float(ENVIRONMENT_TILE), 0.0) + float(ENVIRONMENT_BORDER) +
               square_from_direction(direction) * inner;
  return textureLod(probe_maps, vec3(texel / vec2(ENVIRONMENT_WIDTH, ENVIRONMENT_HEIGHT), float(probe)), 0.0);
}

// Where a ray meets a sphere about the origin that it starts in; nearly the start where it starts outside.
vec3 ray_on_sphere(vec3 from, vec3 direction, float radius) {
  float b = dot(from, direction), c = dot(from, from);
  radius = max(radius, 1.05 * sqrt(c));
  return from + direction * (sqrt(max(b * b + radius * radius - c, 0.0)) - b);
}

// Mean radiance over the GGX lobe about a ray that leaves a place (metres relative to the camera) within some probe's
// radius, rgb cd/m2; a: how much of the place is in it. The ray is followed to where it meets what the cube map saw:
// first a sphere at the distance of what is seen that way, then again from there (parallax).
vec4 probe_radiance(vec3 place, vec3 mirror_direction, float roughness) {
  int best = -1;
  float within = 0.0;
  for (int i = 0; i < int(probes.counts.x); ++i) {
    vec4 p = probes.place_radius[i];
    float here = probes.more[i].x * (1.0 - smoothstep(0.85, 1.0, length(place - p.xyz) / p.w));
    if (here > within) {
      within = here;
      best = i;
    }
  }
  if (best < 0) return vec4(0.0);
  vec3 from = place - probes.place_radius[best].xyz, seen = mirror_direction;
  for (int i = 0; i < 3; ++i) {
    float inverse = probe_tile(best, seen, 0.0).a;
    seen = ray_on_sphere(from, mirror_direction, 1.0 / max(inverse, 1e-3));
  }
  float level = clamp(roughness, 0.0, 1.0) * float(ENVIRONMENT_LEVELS - 1);
  float below = min(floor(level), float(ENVIRONMENT_LEVELS - 2));
  vec3 light = mix(probe_tile(best, seen, below).rgb, probe_tile(best, seen, below + 1.0).rgb, level - below);
  return vec4(light, within);
}

#endif
