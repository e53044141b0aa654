#version 450 core
// Which lamps' airlight can be seen in each tile of 8x8 airlight pixels. The bound: the angle by which light must
// turn to reach the eye is at least the angle between lamp and ray, and the phase function falls with it.
#include "systems/atmosphere/airlight.h"
#include "systems/geometry/position.glsl"
#include "systems/lighting/lighting_shared.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 0, rgba32ui) uniform writeonly uimage2D lists;
uniform ivec2 tiles;
uniform float tile_pixels;  // of the output image
uniform float forward;
uniform float threshold;

void main() {
  ivec2 tile = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(tile, tiles))) return;
  vec3 ray = view_ray((vec2(tile) + 0.5) * tile_pixels);
  vec3 corner = view_ray(vec2(tile) * tile_pixels);
  float half_cosine = clamp(dot(ray, corner), 0.0, 1.0);
  float half_sine = sqrt(1.0 - half_cosine * half_cosine);
  float extinction = frame.mist.x + frame.rain.x + frame.rain.z;

  uvec4 mask = uvec4(0u);
  for (uint i = 0u; i < chosen.counts.x; ++i) {
    LightGpu light = chosen.lights[i];
    if (light.direction_kind.w == float(LIGHT_DIRECTIONAL)) continue;
    vec3 to_light = light.position_range.xyz;
    float d = max(length(to_light), 1e-2);
    float cosine = dot(to_light, ray) / d;
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    // The least angle between the lamp and a ray of the tile.
    bool inside = cosine >= half_cosine;
    float least_cosine = inside ? 1.0 : cosine * half_cosine + sine * half_sine;
    float least_sine = inside ? 0.0 : sine * half_cosine - cosine * half_sine;
    float nearest = cosine > 0.0 || inside ? max(d * least_sine, light.intensity_radius.w) : d;
    float candela = max(light.intensity_radius.r, max(light.intensity_radius.g, light.intensity_radius.b));
    float bound = extinction * candela / nearest * 3.1415927 * phase_hg(least_cosine, forward) *
                  exp(-(frame.mist.x + frame.rain.z) * d);
    if (bound * frame.lens.w > threshold) mask[i >> 5] |= 1u << (i & 31u);
  }
  imageStore(lists, tile, mask);
}
