#version 450 core
// Fills the volume of light_volume.glsl: for each piece of a ray the mean radiance that lamps give drops along it, by
// equiangular points about the lamp (Kulla and Fajardo 2012: x = c + h tan eta), so that a lamp within the piece is no
// matter of luck. One invocation a piece.
layout(local_size_x = 8, local_size_y = 8) in;
#define RAIN_LIGHT_WRITER
#include "systems/rainfall/light_volume.glsl"
#include "systems/drops/lamp_light.glsl"

layout(rgba16f, binding = 0) writeonly uniform image2DArray volume;
uniform float least_radiance;  // output units: a lamp that can give less is left out
uniform vec3 ray_corner, ray_x, ray_y;  // ray of a place in the picture (0 to 1): corner + x ray_x + y ray_y

vec3 lamp_on_piece(LightGpu light, vec3 ray, float from, float to, float footprint) {
  float bright = max(light.intensity_radius.r, max(light.intensity_radius.g, light.intensity_radius.b)) * frame.lens.w;
  if (light.direction_kind.w == float(LIGHT_DIRECTIONAL))
    return light.intensity_radius.rgb * drop_phase(-dot(light.direction_kind.xyz, ray));
  vec3 lamp = light.position_range.xyz;
  float c = dot(lamp, ray);
  // A ray stands for all that pass through its pixels: none of them is nearer to the lamp than some of the others.
  float h = max(length(lamp - c * ray), max(light.intensity_radius.w, 0.35 * footprint));
  float away = max(max(from - c, c - to), 0.0), nearest2 = h * h + away * away;
  float range2 = light.position_range.w * light.position_range.w;
  // The phase falls with the turn but for the rainbow; the turn grows along the ray.
  vec2 ends = vec2(from, to) - c;
  vec2 turns = -ends * inversesqrt(h * h + ends * ends);
  float most = max(drop_phase(turns.x), drop_phase(turns.y));
  if (nearest2 > range2 || bright * most < least_radiance * nearest2) return vec3(0.0);
  // b - a without cancelling.
  float a = atan((from - c) / h), width = atan((to - from) * h, h * h + (to - c) * (from - c));
  float sum = 0.0;
  for (int i = 0; i < 3; ++i) {
    const float places[3] = float[](0.1127016654, 0.5, 0.8872983346), weights[3] = float[](0.2777778, 0.4444444, 0.2777778);
    float eta = a + width * places[i], sine = sin(eta), cosine = max(cos(eta), 1e-4);
    float d2 = h * h / (cosine * cosine), ratio = d2 / range2;
    float window = clamp(1.0 - ratio * ratio, 0.0, 1.0);
    vec3 from_lamp = ray * (c + h * sine / cosine) - lamp;
    float cone = clamp(dot(from_lamp, light.direction_kind.xyz) * inversesqrt(max(dot(from_lamp, from_lamp), 1e-6)) *
                       light.cone_shadow.x + light.cone_shadow.y, 0.0, 1.0);
    float spot = light.direction_kind.w == float(LIGHT_SPOT) ? cone * cone : 1.0;
    sum += weights[i] * window * window * spot * drop_phase(-sine);
  }
  return light.intensity_radius.rgb * (sum * width / (h * (to - from)));
}

void main() {
  ivec3 size = imageSize(volume);
  ivec3 at = ivec3(gl_GlobalInvocationID);
  if (any(greaterThanEqual(at, size))) return;
  vec2 place = (vec2(at.xy) + 0.5) / vec2(size.xy);
  vec3 ray = ray_corner + place.x * ray_x + place.y * ray_y;
  float slant = length(ray);
  ray /= slant;
  float from = rain_light_edge(float(at.z), float(size.z)), to = rain_light_edge(float(at.z + 1), float(size.z));
  float middle = 0.5 * (from + to);
  float footprint = middle / slant * length(ray_y) / float(size.y);
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < frame.counts.x; ++i)
    if (lights[i].cone_shadow.w > 0.0) sum += lamp_on_piece(lights[i], ray, from, to, footprint);
  sum *= exp(-(frame.mist.x + frame.rain.z) * middle) * frame.lens.w;
  imageStore(volume, at, vec4(min(sum, vec3(RAIN_RADIANCE_MOST)), 1.0));
}
