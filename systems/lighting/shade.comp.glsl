#version 450 core
// Lights every surface of the G-buffer: chosen lamps with GGX and Lambert, the captured environment, and what the
// surface itself emits; the sky where there is none. Writes radiance in cd/m2. The loops run over the masks of
// light_lists: first the lamps with shadow maps, then the rest, because software OpenGL executes both sides of a branch.
#define GBUFFER_FIRST_UNIT 0
#include "systems/geometry/gbuffer.glsl"
#include "systems/lighting/facing.glsl"
#include "systems/lighting/environment.glsl"
#include "systems/lighting/lighting_shared.h"
#include "systems/lighting/shadow.glsl"
#include "systems/reflection/mirror_texel.glsl"
#include "systems/sky.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 4) uniform usampler2D light_lists;
layout(binding = 0, rgba16f) uniform writeonly image2D colour;
uniform float diffuse_gain;  // multiplies the environment's diffuse light
uniform float lamps_elsewhere;  // share of the frame whose lamps pass reflections mirrors
uniform float panels_elsewhere;  // and whose windows and signs
layout(std430, binding = TILES_BINDING) readonly buffer Tiles { uint tiles[]; };
uniform uint list_start;  // of this dispatch's kind of tiles; one tile a work group

ivec2 own_texel() {
  uint tile = tiles[list_start + gl_WorkGroupID.x];
  return ivec2(tile & 0xffffu, tile >> 16u) * LIGHT_TILE + ivec2(gl_LocalInvocationID.xy);
}

#ifdef SKY
void main() {
  ivec2 texel = own_texel();
  if (any(greaterThanEqual(texel, ivec2(frame.size.xy)))) return;
  imageStore(colour, texel, vec4(sky_radiance(view_ray(vec2(texel) + 0.5)), 1.0));
}
#else

void main() {
  ivec2 texel = own_texel();
  if (any(greaterThanEqual(texel, ivec2(frame.size.xy)))) return;
  float depth = read_depth(texel);
  Surface surface = read_surface(texel);

  // Ripples finer than a pixel become a wider lobe instead of a flicker.
  float mirrors = panels_elsewhere > 0.0 && depth > 0.0 ? mirror_share(surface.roughness) : 0.0;
  for (int once = 0; once < (mirrors > 0.0 ? 1 : 0); ++once)
    surface.roughness = filtered_roughness(texel, depth, surface.normal, surface.roughness);

  Facing at = facing_of(surface, relative_position(vec2(texel) + 0.5, max(depth, 1e-7)));

  float extinction = frame.mist.x + frame.rain.z;
  vec3 irradiance = vec3(0.0), specular = vec3(0.0);
  uvec4 mask = depth > 0.0 ? texelFetch(light_lists, texel / LIGHT_TILE, 0) : uvec4(0u);
  uint in_light = mask.w >> 16;
  mask.w &= 0xffffu;
#ifdef SHADOWS
  uint casters = mask.x & ((1u << chosen.counts.y) - 1u) & ~in_light;
  mask.x &= ~casters;
  float bias_m = shadow_bias_m(at.place);
  while (casters != 0u) {
    int i = findLSB(casters);
    casters &= casters - 1u;
    LightGpu light = chosen.lights[i];
    float passes = soft_shadow(light.cone_shadow.z, at.place + at.normal * bias_m - light.position_range.xyz,
                               light.cone_shadow.w, light.intensity_radius.w, bias_m);
    add_light(light, at, extinction, passes, irradiance, specular);
  }
#endif
  // One loop over all four words: every loop of its own costs software OpenGL one idle turn.
  while ((mask.x | mask.y | mask.z | mask.w) != 0u) {
    int word = mask.x != 0u ? 0 : mask.y != 0u ? 1 : mask.z != 0u ? 2 : 3;
    uint bits = mask[word];
    mask[word] = bits & (bits - 1u);
    add_light(chosen.lights[word * 32 + findLSB(bits)], at, extinction, 1.0, irradiance, specular);
  }

  vec3 reflected = mirrored_share(at, surface.roughness);
  // Where pass reflections draws the lamps, their highlights are left to it.
  specular *= 1.0 - lamps_elsewhere * mirror_share(surface.roughness);
  // What GGX reflects does not reach the diffuse layer below it.
  vec3 diffuse = surface.albedo * at.dielectric * (1.0 - max(reflected.r, max(reflected.g, reflected.b)));
  vec3 radiance = diffuse * irradiance / PI + specular + surface.emissive;
#ifdef ENVIRONMENT
  float open = mirror_open(at, surface.roughness, surface.occlusion);
  Surroundings around = environment_around(at.mirror, surface.roughness);
  radiance += (diffuse * environment_diffuse(at.normal) * surface.occlusion * diffuse_gain +
               reflected * mix(around.all, around.matt, mirrors * panels_elsewhere) * open) * frame.sky_zenith.w;
#endif
  imageStore(colour, texel, vec4(depth > 0.0 ? radiance : sky_radiance(-at.view), 1.0));
}
#endif
