#version 450 core
// Puts what is really mirrored in the place of the captured surroundings that pass shade put there, on every pixel that
// mirrors: what a planar mirror or a moving thing's own capture shows, else rays and stand-ins.
#define GBUFFER_FIRST_UNIT 0
#include "systems/reflection/mirror_texel.glsl"
#include "systems/lighting/facing.glsl"
#include "systems/reflection/reflection_shared.h"
#include "systems/reflection/streak.h"
#include "systems/lighting/environment.glsl"
#ifdef WITH_MIRRORS
#include "systems/mirror/mirror.glsl"
uniform float planar_share;
#endif
#ifdef WITH_PROBES
#include "systems/mirror/probe.glsl"
#endif

layout(local_size_x = 8, local_size_y = 8) in;
layout(std430, binding = REFLECTION_TILES_BINDING) readonly buffer Tiles { uint tiles[]; };
layout(binding = 0, rgba16f) uniform image2D colour;
layout(binding = 4) uniform sampler2D reflections;
#ifdef TOYSHOP
layout(binding = 5) uniform sampler2D streaks;
uniform float toyshop_share;
uniform float distortion;     // of the place on screen, of its height, by the normal's tilt
#endif
uniform float drawn_share;      // of the rungs that fill `reflections`: pass shade left their panels to them
uniform float edge_exponent;    // f_o
uniform float published_edges;  // 1: k_a for all rungs

// The four texels about a pixel, each as far as it belongs to the same surface: no light leaks over edges.
vec4 reflection_at(ivec2 texel, float depth) {
  vec2 place = vec2(texel) * 0.5;  // texel 2k of the picture is texel k
  ivec2 first = ivec2(floor(place));
  vec2 part = place - vec2(first);
  ivec2 last = textureSize(reflections, 0) - 1;
  vec4 sum = vec4(0.0);
  float weights = 1e-6;
  for (int i = 0; i < 4; ++i) {
    ivec2 step = ivec2(i & 1, i >> 1), from = min(first + step, last);
    float near = (step.x == 1 ? part.x : 1.0 - part.x) * (step.y == 1 ? part.y : 1.0 - part.y) + 1e-3;
    ivec2 stands = picture_texel(from);
    float other = read_depth(stands);
    float same = max(1.0 - abs(other - depth) / (0.05 * depth), 0.0) + 1e-4;
    sum += texelFetch(reflections, from, 0) * (near * same);
    weights += near * same;
  }
  return sum / weights;
}

// What pass shade put there: without the windows and signs that are drawn as themselves.
vec3 surroundings(Facing at, float roughness) {
  Surroundings around = environment_around(at.mirror, roughness);
  return mix(around.all, around.matt, drawn_share) * frame.sky_zenith.w;
}

void lay_over(ivec2 texel, float depth, float mirrors) {
  Surface surface = read_surface(texel);
  Facing at = facing_of(surface, relative_position(vec2(texel) + 0.5, depth));
  vec3 reflected = mirrored_share(at, surface.roughness) * mirror_open(at, surface.roughness, surface.occlusion);
  vec3 change = reflection_at(texel, depth).rgb;
#ifdef TOYSHOP
  // Artists' control of edges: f = (1 - n.v)^f_o, k_a = saturate(1 - f^2).
  float k_a = edge_attenuation(at.n_dot_v, edge_exponent);
  // Sampled at the pixel's own place on screen, moved by the normal (section 6.3). Of level ground the tangent frame is
  // that of the world, seen from the camera.
  vec3 right = vec3(frame.view[0][0], frame.view[1][0], frame.view[2][0]);
  vec3 ahead = normalize(cross(vec3(0.0, 1.0, 0.0), right));
  vec3 tangent = surface.normal - vec3(0.0, surface.normal.y > 0.7 ? 1.0 : 0.0, 0.0);
  vec2 moved = vec2(dot(tangent, right) * frame.size.y * frame.size.z, dot(tangent, ahead)) * distortion;
  vec2 uv = (vec2(texel) + 0.5) * frame.size.zw + (surface.normal.y > 0.7 ? moved : vec2(0.0));
  vec4 s = textureLod(streaks, uv, 0.0) * (surface.normal.y > 0.7 ? 1.0 : 0.0);
  vec3 all = environment_around(at.mirror, surface.roughness).all * frame.sky_zenith.w;
  change += toyshop_share * (k_a * (s.rgb + (1.0 - s.a) * all) - all);
#else
  const float toyshop_share = 0.0;
#endif
  for (int once = 0; once < (published_edges > 0.0 ? 1 : 0); ++once) {
    float attenuation = edge_attenuation(at.n_dot_v, edge_exponent) - 1.0;
    change += (1.0 - toyshop_share) * published_edges * attenuation * (change + surroundings(at, surface.roughness));
  }
#ifdef WITH_PROBES
  bool near = false;
  for (int i = 0; i < int(probes.counts.x); ++i)
    near = near || distance(at.place, probes.place_radius[i].xyz) < probes.place_radius[i].w;
  for (int once = 0; once < (near ? 1 : 0); ++once) {
    vec4 probe = probe_radiance(at.place, at.mirror, surface.roughness);
    change = mix(change, probe.rgb - surroundings(at, surface.roughness), probe.a);
  }
#endif
#ifdef WITH_MIRRORS
  bool flat_here = max(mirror_applies(0, at.place, at.normal), mirror_applies(1, at.place, at.normal)) > 0.0;
  for (int once = 0; once < (flat_here ? 1 : 0); ++once) {
    vec4 mirrored = mirror_radiance(at.place, at.normal, surface.roughness, at.mirror);
    change = mix(change, mirrored.rgb - surroundings(at, surface.roughness), mirrored.a * planar_share);
  }
#endif
  vec4 light = imageLoad(colour, texel);
  imageStore(colour, texel, vec4(max(light.rgb + mirrors * reflected * change, vec3(0.0)), light.a));
}

void main() {
  uint listed = tiles[uint(REFLECTION_TILES_HEADER) + gl_WorkGroupID.x / 4u];
  ivec2 quarter = ivec2(gl_WorkGroupID.x & 1u, (gl_WorkGroupID.x >> 1u) & 1u);
  ivec2 texel = ivec2(listed & 0xffffu, listed >> 16u) * (2 * REFLECTION_TILE) + quarter * 8 +
                ivec2(gl_LocalInvocationID.xy);
  if (any(greaterThanEqual(texel, ivec2(frame.size.xy)))) return;
  float depth = read_depth(texel);
  float mirrors = depth > 0.0 ? mirror_share(texelFetch(gbuffer_normal, texel, 0).z) : 0.0;
  // A loop for an if: software OpenGL leaves a loop that no pixel is in, but walks through both sides of a branch.
  for (int once = 0; once < (mirrors > 0.0 ? 1 : 0); ++once) lay_over(texel, depth, mirrors);
}
