#version 450 core
// Lights the capture: six small G-buffers side by side become a cube of radiance, with 1 / distance in its alpha. Lamps
// are discs of the illuminance that they give at the capture: through a drop they are its brightest spots.
#include "systems/brdf.h"
#ifdef SHADOWS
#include "systems/lighting/shadow.glsl"
#else
#include "systems/lighting/octahedral.glsl"
#endif
#include "systems/sky.glsl"
#include "systems/rainfall/near_drops/near_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
#define GBUFFER_FIRST_UNIT 0
#include "systems/geometry/gbuffer.glsl"
layout(rgba16f, binding = 0) writeonly uniform imageCube near_world;
layout(std430, binding = NEAR_LAMPS_BINDING) readonly buffer NearLamps { NearLampGpu lamps[]; };
uniform int face_texels, capture_texels, lamp_count;  // a side: of the level that is written, of the capture
uniform float near_m;         // of the capture
uniform vec3 all_round;       // mean radiance, cd/m2: what surfaces get apart from lamps
uniform float brightest;      // of surfaces that shine, cd/m2: lamps themselves are drawn from their own intensity
uniform bool lamp_discs;
uniform vec3 capture_offset;  // capture minus camera, m

// OpenGL's cube faces (specification 4.5, table 8.19).
vec3 direction_of_texel(ivec3 texel) {
  vec2 p = (vec2(texel.xy) + 0.5) * (2.0 / float(face_texels)) - 1.0;
  if (texel.z == 0) return vec3(1.0, -p.y, -p.x);
  if (texel.z == 1) return vec3(-1.0, -p.y, p.x);
  if (texel.z == 2) return vec3(p.x, 1.0, p.y);
  if (texel.z == 3) return vec3(p.x, -1.0, -p.y);
  if (texel.z == 4) return vec3(p.x, -p.y, 1.0);
  return vec3(-p.x, -p.y, -1.0);
}

#ifdef SHADOWS
// Of the light lists' lamps, which are relative to the camera, those that stand where ours do: tile of the shadow atlas
// (or -1) and reach of its map.
shared vec2 shadows[NEAR_LAMPS];

void find_shadow(uint i) {
  shadows[i] = vec2(-1.0, 0.0);
  for (uint j = 0u; int(i) < lamp_count && j < chosen.counts.y; ++j) {
    vec3 apart = chosen.lights[j].position_range.xyz - capture_offset - lamps[i].position_range.xyz;
    if (dot(apart, apart) < 1e-4) shadows[i] = chosen.lights[j].cone_shadow.zw;
  }
}
#endif

// Illuminance at a place from a lamp, across its rays, lx.
vec3 given(NearLampGpu lamp, vec3 place, out vec3 to_lamp) {
  bool directional = lamp.direction_kind.w == float(LIGHT_DIRECTIONAL);
  to_lamp = directional ? -lamp.direction_kind.xyz * 1e4 : lamp.position_range.xyz - place;
  float d2 = max(dot(to_lamp, to_lamp), 1e-6);
  if (directional) return lamp.intensity_radius.rgb;
  float cone = spot_attenuation(-dot(to_lamp, lamp.direction_kind.xyz) * inversesqrt(d2), lamp.cone_shadow.x,
                                lamp.cone_shadow.y);
  float radius = lamp.intensity_radius.w;
  return lamp.intensity_radius.rgb *
         (distance_attenuation(max(d2, radius * radius + 0.0025), lamp.position_range.w) * cone);
}

void main() {
#ifdef SHADOWS
  find_shadow(gl_LocalInvocationIndex);
  barrier();
#endif
  ivec3 texel = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(texel.xy, ivec2(face_texels)))) return;
  vec3 w = direction_of_texel(texel), unit = normalize(w);
  vec3 strip = face_from_direction(w);
  ivec2 at = ivec2(strip.xy * float(capture_texels)) + ivec2(int(strip.z) * capture_texels, 0);
  float depth = read_depth(at);
  vec3 place = w * (near_m / max(depth, 1e-7));
  float away = depth > 0.0 ? length(place) : 1e6;
  vec3 light;
  if (depth > 0.0) {
    Surface surface = read_surface(at);
    vec3 irradiance = PI * all_round * surface.occlusion;
    for (int i = 0; i < lamp_count; ++i) {
      vec3 to_lamp, illuminance = given(lamps[i], place, to_lamp);
      float cosine = dot(surface.normal, to_lamp) * inversesqrt(max(dot(to_lamp, to_lamp), 1e-6));
      illuminance *= max(cosine, 0.0);
      if (max(illuminance.r, max(illuminance.g, illuminance.b)) < 1e-3) continue;
#ifdef SHADOWS
      if (shadows[i].x >= 0.0) illuminance *= plain_shadow(shadows[i].x, -to_lamp, shadows[i].y);
#endif
      irradiance += illuminance;
    }
    light = surface.albedo * irradiance / PI + min(surface.emissive, vec3(brightest));
  } else {
    light = sky_radiance(unit);
  }
  float texel_rad = 1.5707963 / float(face_texels);
  for (int i = 0; i < (lamp_discs ? lamp_count : 0); ++i) {
    if (lamps[i].cone_shadow.w == 0.0) continue;
    vec3 to_lamp, illuminance = given(lamps[i], vec3(0.0), to_lamp);
    float d = length(to_lamp), radius = lamps[i].intensity_radius.w;
    if (d < 1e-3) continue;  // the capture is in the lamp: it has no direction
    float width = max(2.0 * texel_rad, 1.7 * radius / max(d, radius));
    float turn2 = 2.0 - 2.0 * dot(unit, to_lamp / d);  // squared angle, about
    if (turn2 >= width * width || away < d - radius - 0.5) continue;
    float share = 1.0 - turn2 / (width * width);
    light += illuminance * (3.0 / (PI * width * width) * share * share);  // (1 - x^2)^2 over its disc is pi w^2 / 3
    away = min(away, d);
  }
  imageStore(near_world, texel, vec4(min(light, vec3(6e4)), 1.0 / away));
}
