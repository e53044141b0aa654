// From a drop of a cell to its streak on the picture.
#ifndef SYSTEMS_RAINFALL_STREAK_GLSL
#define SYSTEMS_RAINFALL_STREAK_GLSL
#include "systems/frame.glsl"
#ifdef SCENE
#include "systems/occlusion/occlusion.glsl"
layout(binding = 0) uniform sampler2D scene_depth;
uniform bool use_occlusion;
#endif
#include "systems/drops/field.glsl"

#ifdef LAMPS
#include "systems/drops/lamp_light.glsl"
#endif
uniform vec3 distances;  // nearest axial distance, start and end of the fade, m

struct Streak {
  vec2 from, to;   // pixels, when the shutter opens and closes
  vec2 depths;     // of the depth buffer
  float area;      // of the drop's image times its share of the exposure, pixels
  float radius;    // pixels
  vec3 middle;     // relative to the camera, m
};

// False: not seen.
bool project(vec3 closed, float mark, float reach, vec3 velocity, float diameter, out Streak s) {
  float fade = reach * mix(distances.y, distances.z, mark);  // where this drop leaves
  bool seen = dot(closed, closed) <= fade * fade;
  vec3 opened = closed - velocity * frame.camera_velocity_mps.w;
  vec4 c1 = frame.view_projection * vec4(closed, 1.0), c0 = frame.shutter_view_projection * vec4(opened, 1.0);
  // The path is cut at the nearest plane; what is nearer is dealt with by the mean.
  float nearest = distances.x;
  seen = seen && max(c0.w, c1.w) > nearest;
  float cut0 = c0.w < nearest ? (nearest - c0.w) / (c1.w - c0.w) : 0.0;
  float cut1 = c1.w < nearest ? (nearest - c1.w) / (c0.w - c1.w) : 0.0;
  vec4 a = mix(c0, c1, cut0), b = mix(c1, c0, cut1);
  vec2 inverse_w = 1.0 / vec2(a.w, b.w);
  s.from = (a.xy * inverse_w.x * 0.5 + 0.5) * frame.size.xy;
  s.to = (b.xy * inverse_w.y * 0.5 + 0.5) * frame.size.xy;
  s.middle = 0.5 * (opened + closed);
  float axial = 0.5 * (a.w + b.w);
  float across = diameter * frame.lens.z;
  // A sphere's image grows towards the edge of the picture: solid angle over cosine cubed.
  float area = 0.7853981634 * across * across * length(s.middle) / (axial * axial * axial);
  s.radius = sqrt(area * 0.3183098862);
  s.area = area * (1.0 - cut0 - cut1);
  s.depths = frame.camera_world_m.w * inverse_w;
  return seen && all(greaterThan(max(s.from, s.to) + s.radius, vec2(0.0))) &&
         all(lessThan(min(s.from, s.to) - s.radius, frame.size.xy));
}

bool hidden(Streak s, vec3 velocity) {
#ifdef SCENE
  // A drop whose image is small is hidden where its middle is; long streaks are tested along their way.
  ivec2 pixel = ivec2(clamp(0.5 * (s.from + s.to), vec2(0.0), frame.size.xy - 1.0));
  vec2 span = abs(s.to - s.from);
  if (max(span.x, span.y) < 1.0 && max(s.depths.x, s.depths.y) < texelFetch(scene_depth, pixel, 0).r) return true;
  return use_occlusion && sheltered(s.middle, velocity);
#else
  return false;
#endif
}

#ifdef LAMPS
// Radiance that one lamp gives a drop at a place, cd/m2.
vec3 lamp_light(LightGpu light, vec3 at, float distance_to_eye) {
  vec3 from_light = at - light.position_range.xyz;
  float d2 = max(dot(from_light, from_light), 1e-4);
  bool directional = light.direction_kind.w == float(LIGHT_DIRECTIONAL);
  vec3 direction = directional ? light.direction_kind.xyz : from_light * inversesqrt(d2);
  float ratio = d2 / (light.position_range.w * light.position_range.w);
  float window = clamp(1.0 - ratio * ratio, 0.0, 1.0);
  float strength = window * window / max(d2, light.intensity_radius.w * light.intensity_radius.w + 0.0025);
  float cone = clamp(dot(direction, light.direction_kind.xyz) * light.cone_shadow.x + light.cone_shadow.y, 0.0, 1.0);
  strength *= light.direction_kind.w == float(LIGHT_SPOT) ? cone * cone : 1.0;
  strength = directional ? 1.0 : strength;
  // The turn from the light's direction to the eye's: 0 where the drop stands before the lamp.
  float cosine = -dot(direction, at) / distance_to_eye;
  return light.intensity_radius.rgb * (strength * drop_phase(cosine));
}

// The same after mist and undrawn drops on the way to the eye, in output units.
vec3 seen_light(vec3 sum, float distance_to_eye) {
  sum *= exp(-(frame.mist.x + frame.rain.z) * distance_to_eye) * frame.lens.w;
  return min(sum, vec3(RAIN_RADIANCE_MOST));
}
#endif

#endif
