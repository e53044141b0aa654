#version 450 core
// Splatter on a marked object, shell by shell along each pixel's ray: the shells lie over the surface that the pixel
// shows, so no geometry is drawn again (section 3.4's extruded shells, mended: shells.vert.glsl has them as printed).
layout(local_size_x = 8, local_size_y = 8) in;
#include "systems/geometry/position.glsl"
#include "systems/splatter/rings.glsl"
#include "systems/occlusion/occlusion.glsl"
uniform bool use_occlusion;

layout(binding = 0) uniform sampler2D scene_depth;
layout(binding = 1) uniform sampler2D scene_normal;
layout(rgba16f, binding = 0) uniform image2D colour;
uniform ivec2 first_pixel, last_pixel;

vec3 unit_from_octahedral(vec2 p) {
  vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  float t = max(-n.z, 0.0);
  n.x += n.x >= 0.0 ? -t : t;
  n.y += n.y >= 0.0 ? -t : t;
  return normalize(n);
}

vec3 own_place, own_normal;
float struck_here() { return use_occlusion ? deposit(own_place, own_normal) : max(own_normal.y, 0.0); }

void main() {
  ivec2 texel = first_pixel + ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThan(texel, last_pixel))) return;
  float depth = texelFetch(scene_depth, texel, 0).r;
  if (depth <= 0.0) return;
  vec3 place = relative_position(vec2(texel) + 0.5, depth);
  vec3 at = local_place(place);
  const float margin = 0.01;
  if (any(lessThan(at, catcher.low.xyz - margin)) || any(greaterThan(at, catcher.high.xyz + margin))) return;
  vec3 world_normal = unit_from_octahedral(texelFetch(scene_normal, texel, 0).xy * 2.0 - 1.0);
  float distance_m = length(place);
  vec3 view = -place / distance_m;
  float facing = dot(world_normal, view);
  // Thinner than a pixel a ring is only haze, which is less than the eye sees: it fades out.
  float ring_px = 2.0 * float(SPLATTER_REACH) * catcher.crown.y * frame.lens.z / distance_m;
  float near = smoothstep(fade_px.x, fade_px.y, ring_px) * catcher.shells.w;
  if (facing <= 0.02 || near <= 0.0) return;
  own_place = place;
  own_normal = world_normal;
  vec3 normal = local_way(world_normal);
  // What a metre of height moves the place that a ray crosses, seen along the normal.
  vec3 slide = local_way(view) / max(facing, 0.1) - normal;
  int shells = int(catcher.shells.x);
  float thickness = catcher.shells.y / float(shells);
  float sum = rings(at, normal, slide, 0.5 * thickness, shells, thickness, thickness / max(facing, 0.25));
  if (sum <= 0.0) return;
  sum *= near;
  float opacity = 1.0 - exp(-sum);
  vec3 light = drop_ambient(-view) + droplet_lamps(place);
  vec3 behind = imageLoad(colour, texel).rgb;
  imageStore(colour, texel, vec4(min(mix(behind, light, opacity), vec3(60000.0)), 1.0));
}
