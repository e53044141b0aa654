#version 450 core
// Blended surfaces over the lit picture (cd/m2, premultiplied alpha): a thin pane reflects the sky and lets the rest
// through; what the base colour's alpha covers is lit as a matt film on it (dirt, decals, leaves).
#define GBUFFER_WRITER
#include "systems/geometry/material.glsl"
#include "systems/sky.glsl"
#ifdef ENVIRONMENT
#include "systems/lighting/environment.glsl"
#endif
#ifdef MIRRORS
#include "systems/mirror/mirror.glsl"
#endif

const float PI = 3.14159265;

layout(location = 4) in vec3 vertex_position;
layout(location = 0) out vec4 out_colour;

// Reflectance of a pane: both faces and all bounces between them, unpolarised, from one face's Fresnel term
// (Schlick, n = 1.5): F + (1-F)^2 F / (1-F^2) = 2F / (1+F).
float pane_reflectance(float cosine) {
  float f = 0.04 + 0.96 * pow(1.0 - cosine, 5.0);
  return 2.0 * f / (1.0 + f);
}

// What comes from a direction, and what falls on a surface from all round.
vec3 surroundings(vec3 direction, float roughness) {
#ifdef ENVIRONMENT
  return environment_radiance(direction, roughness) * frame.sky_zenith.w;
#else
  return sky_radiance(direction) * frame.sky_zenith.w;
#endif
}

vec3 ambient_illuminance(vec3 normal) {
#ifdef ENVIRONMENT
  vec3 mean = environment_diffuse(normal);
#else
  vec3 mean = 0.25 * (sky_radiance(normal) + sky_radiance(vec3(0.0, 1.0, 0.0)) + 2.0 * frame.sky_horizon.rgb);
#endif
  return PI * mean * frame.sky_zenith.w;
}

// matters: how much of what falls on the film is seen. On clear glass that is nothing, and lamps are not asked
// (no iteration where no pixel of a group needs one).
vec3 film_illuminance(vec3 position, vec3 normal, float matters) {
  vec3 sum = ambient_illuminance(normal);
  uint count = matters > 0.03 ? frame.counts.x : 0u;
  for (uint i = 0u; i < count; ++i) {
    LightGpu light = lights[i];
    vec3 to = light.position_range.xyz - position;
    float attenuation = 1.0;
    if (int(light.direction_kind.w) == LIGHT_DIRECTIONAL) {
      to = -light.direction_kind.xyz;
    } else {
      float square = max(dot(to, to), 1e-4);
      float x = square / (light.position_range.w * light.position_range.w);
      float window = clamp(1.0 - x * x, 0.0, 1.0);
      to *= inversesqrt(square);
      float cone = clamp(dot(-to, light.direction_kind.xyz) * light.cone_shadow.x + light.cone_shadow.y, 0.0, 1.0);
      attenuation = window * window * cone * cone / square;
    }
    // A film is thin: light from behind shows through it.
    sum += light.intensity_radius.rgb * attenuation * abs(dot(normal, to));
  }
  return sum;
}

void main() {
  vec4 colour = base_colour();
  vec2 no_mask;
  Surface s = material_surface(colour, no_mask);
  float distance_m = length(vertex_position);
  vec3 view = -vertex_position / max(distance_m, 1e-6);
  vec3 normal = dot(s.normal, view) < 0.0 ? -s.normal : s.normal;

  // Only smooth surfaces are panes; a rough one (a leaf, a poster) shows no sky.
  float smoothness = clamp(1.0 - 2.0 * s.roughness, 0.0, 1.0);
  float reflectance = smoothness * pane_reflectance(clamp(dot(normal, view), 0.0, 1.0));
  float cover = clamp(colour.a, 0.0, 1.0);
  float matters = cover * max(s.albedo.r, max(s.albedo.g, s.albedo.b));
  vec3 film = s.albedo / PI * film_illuminance(vertex_position, normal, matters) + s.emissive;
  vec3 mirrored = reflect(-view, normal);
  vec3 sky = surroundings(mirrored, s.roughness);
#ifdef MIRRORS
  float applies = mirror_applies(1, vertex_position, normal);
  if (applies > 0.0) {
    vec4 seen = mirror_lobe(1, vertex_position, mirrored, s.roughness);
    sky = mix(sky, seen.rgb, seen.a * applies);
  }
#endif

  // Mist between here and the pane hides what the pane does.
  float clear = exp(-distance_m * (frame.mist.x + frame.rain.z));
  vec3 light = (film * cover * (1.0 - reflectance) + sky * reflectance) * clear;
  float opacity = (1.0 - (1.0 - cover) * (1.0 - reflectance)) * clear;
  out_colour = vec4(min(light, vec3(60000.0)), opacity);
}
