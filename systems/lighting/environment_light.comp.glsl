#version 450 core
// Lights one captured view of the surroundings: six small G-buffers side by side become radiance, with 1 / distance of
// what is seen, 1/m, in its alpha (0: the sky), and apart how much of it is a thing's own light.
#define BRIGHTEST_CAPTURED_CD_M2 30.0
#include "systems/brdf.h"
#include "systems/lighting/lighting_shared.h"
#include "systems/lighting/shadow.glsl"
#include "systems/sky.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
#define GBUFFER_FIRST_UNIT 0
#include "systems/geometry/gbuffer.glsl"
layout(binding = 0, rgba16f) uniform writeonly image2D radiance;
layout(binding = 1, r16f) uniform writeonly image2D own_light;  // luminance, cd/m2

uniform float near_m;  // of the capture

void main() {
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (texel.x >= 6 * ENVIRONMENT_FACE || texel.y >= ENVIRONMENT_FACE) return;
  int face = texel.x / ENVIRONMENT_FACE;
  vec2 inside = (vec2(texel.x % ENVIRONMENT_FACE, texel.y) + 0.5) / float(ENVIRONMENT_FACE);
  vec3 axial = direction_of_face(inside * 2.0 - 1.0, face);
  float depth = read_depth(texel);
  Surface surface = read_surface(texel);
  vec3 place = axial * (near_m / max(depth, 1e-7));

  vec3 irradiance = vec3(0.0);
  for (uint i = 0u; i < chosen.counts.x; ++i) {
    LightGpu light = chosen.lights[i];
    bool directional = light.direction_kind.w == float(LIGHT_DIRECTIONAL);
    vec3 to_light = directional ? -light.direction_kind.xyz * 1e4 : light.position_range.xyz - place;
    float d2 = dot(to_light, to_light);
    vec3 l = to_light * inversesqrt(d2);
    float strength = directional ? 1.0
                                 : distance_attenuation(d2, light.position_range.w) *
                                       spot_attenuation(-dot(l, light.direction_kind.xyz), light.cone_shadow.x,
                                                        light.cone_shadow.y);
#ifdef SHADOWS
    if (light.cone_shadow.z >= 0.0) strength *= plain_shadow(light.cone_shadow.z, -to_light, light.cone_shadow.w);
#endif
    irradiance += light.intensity_radius.rgb * (strength * max(dot(surface.normal, l), 0.0));
  }
  // Metals shine with what they mirror; their base colour stands for it here.
  // Lamp glass and neon shine through their punctual lights already: what is captured of them is no brighter than a
  // lit window, or each lamp would light the street twice.
  vec3 own = depth > 0.0 ? min(surface.emissive, vec3(BRIGHTEST_CAPTURED_CD_M2)) : vec3(0.0);
  vec3 lit = surface.albedo * irradiance / PI + own;
  vec3 result = depth > 0.0 ? lit : sky_radiance(normalize(axial));
  imageStore(radiance, texel, vec4(min(result, vec3(6e4)), depth > 0.0 ? 1.0 / length(place) : 0.0));
  imageStore(own_light, texel, vec4(dot(own, vec3(0.2126, 0.7152, 0.0722)), 0.0, 0.0, 0.0));
}
