#version 450 core
// ToyShop's impostors as printed (Tatarchuk and Isidoro 2006, section 6.3): each reflector a billboard, upside down under
// the ground, "dynamically stretched view-dependently toward the viewer in the vertex shader. The amount of stretching
// varies depending on the distance of the object to the viewer."
#include "systems/reflection/reflection_shared.h"
#include "systems/frame.glsl"

layout(std140, binding = REFLECTORS_BINDING) uniform ReflectorsBlock { ReflectorsGpu reflectors; };
uniform float ground_m;       // height of the mirroring plane, relative to the camera
uniform float stretch;        // metres that the near end is drawn out by, a metre of distance
uniform float saturation;     // of the simplified materials
layout(location = 0) out vec2 inside;  // -1 to 1
layout(location = 1) flat out vec4 shine;  // rgb, a: how much it hides
layout(location = 2) flat out float rounded;

void main() {
  ReflectorGpu q = reflectors.all[gl_InstanceID];
  inside = vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1)) * 2.0 - 1.0;
  vec3 to = q.centre_kind.xyz;
  vec3 across = normalize(vec3(-to.z, 0.0, to.x) + vec3(1e-6, 0.0, 0.0)) * max(length(q.across_seen.xyz), 0.03);
  float tall = max(length(q.up_reach.xyz), 0.03), distance_m = q.radiance.w;
  // Far lamps are narrower than a texel of the half-size buffer and would fall between two: a texel wide, dimmed alike.
  float texel_m = 1.2 * distance_m / frame.lens.z, wide = length(across);
  float narrower = min(wide / texel_m, 1.0);
  across /= narrower;
  // Mirrored: what was its top is its lower end, which is drawn out towards the viewer.
  float drawn_out = stretch * distance_m;
  float top_m = 2.0 * ground_m - (to.y - tall), low_m = 2.0 * ground_m - (to.y + tall) - drawn_out;
  vec3 place = vec3(to.x, inside.y > 0.0 ? top_m : low_m, to.z) + across * inside.x;
  gl_Position = frame.view_projection * vec4(place, 1.0);
  bool post = q.centre_kind.w == float(REFLECTOR_POST);
  // "the reflections materials shaders strongly saturate the dominant colors". What is drawn out is thinned.
  float grey = dot(q.radiance.rgb, vec3(0.2126, 0.7152, 0.0722));
  vec3 saturated = max(mix(vec3(grey), q.radiance.rgb, saturation), vec3(0.0));
  float thinner = narrower * 2.0 * tall / (2.0 * tall + drawn_out);
  shine = vec4(saturated * thinner, q.across_seen.w * (post ? 0.9 * narrower : thinner));
  shine.rgb *= q.across_seen.w;
  rounded = q.centre_kind.w == float(REFLECTOR_LAMP) ? 1.0 : 0.0;
}
