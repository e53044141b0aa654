#version 450 core
// Draws the listed drops into sums of optical depth and radiance, 32 invocations a drop. Coverage is that of
// raster.glsl's capsules, so the mean transmittance is the field's.
layout(local_size_x = 32) in;  // NEAR_LANES
#include "systems/rainfall/near_drops/near_list.glsl"
#include "systems/rainfall/near_drops/near_optics.glsl"
#include "systems/rainfall/near_drops/near_maps.glsl"

layout(std430, binding = NEAR_PROFILES_BINDING) readonly buffer NearProfiles { uvec2 profiles[]; };
layout(std430, binding = NEAR_IMAGES_BINDING) readonly buffer NearImages { uvec2 images[]; };
layout(std430, binding = NEAR_SUMS_BINDING) buffer NearSums { uint sums[]; };
#ifdef SCENE
layout(binding = 0) uniform sampler2D scene_depth;
#endif

vec3 unpacked(uvec2 texel) { return vec3(unpackHalf2x16(texel.x), unpackHalf2x16(texel.y).x); }

struct Shown {  // what of a drop does not change from pixel to pixel
  uint index;
  vec3 ray, place;
  bool streak;
  uint image;  // of maps: first texel of its cell
  vec3 image_right, image_up;
};

vec3 column_at(NearDropGpu drop, Shown s, float x) {
  uint first = drop.bits.y != 0u ? s.image + uint(map_pixels * map_pixels) : s.index * uint(NEAR_COLUMNS);
  int n = drop.bits.y != 0u ? map_pixels : int(drop.place.w);
  float at = clamp((x * 0.5 + 0.5) * float(n) - 0.5, 0.0, float(n - 1));
  uint low = uint(at), high = min(low + 1u, uint(n - 1));
  vec3 a = unpacked(drop.bits.y != 0u ? images[first + low] : profiles[first + low]);
  vec3 b = unpacked(drop.bits.y != 0u ? images[first + high] : profiles[first + high]);
  return mix(a, b, at - float(low));
}

vec3 image_at(Shown s, vec2 q) {
  vec2 at = clamp((q * 0.5 + 0.5) * float(map_pixels) - 0.5, vec2(0.0), vec2(float(map_pixels - 1)));
  ivec2 low = ivec2(at), high = min(low + 1, ivec2(map_pixels - 1));
  vec2 t = at - vec2(low);
  vec4 sum = vec4(0.0);
  for (int i = 0; i < 4; ++i) {
    ivec2 p = ivec2((i & 1) == 0 ? low.x : high.x, (i & 2) == 0 ? low.y : high.y);
    uvec2 texel = images[s.image + uint(p.y * map_pixels + p.x)];
    float w = ((i & 1) == 0 ? 1.0 - t.x : t.x) * ((i & 2) == 0 ? 1.0 - t.y : t.y) * unpackHalf2x16(texel.y).y;
    sum += vec4(unpacked(texel), 1.0) * w;
  }
  return sum.w > 0.0 ? sum.rgb / sum.w : vec3(0.0);
}

// Radiance at a place of the disc, in radii along the picture's axes.
vec3 shown_at(NearDropGpu drop, Shown s, vec2 q, float area) {
  float b = length(q);
  if (b > 0.999) q *= 0.999 / b;
  b = clamp(b, 1e-4, 0.999);
  vec3 o = normalize(across(q, s.ray));
  if (drop.bits.y != 0u) return image_at(s, b * vec2(dot(o, s.image_right), dot(o, s.image_up)));
  return seen_in_drop(s.place, s.ray, o, b, area);
}

void add(ivec2 pixel, float coverage, float depth, vec3 light, uint salt) {
#ifdef SCENE
  if (depth < texelFetch(scene_depth, pixel, 0).r) return;
#endif
  uint h = salt + uint(pixel.x) * 0x9e3779b9u + uint(pixel.y) * 0x85ebca6bu;
  h = (h ^ (h >> 16u)) * 0x7feb352du;
  h = (h ^ (h >> 15u)) * 0x846ca68bu;
  float chance = float((h ^ (h >> 16u)) >> 8u) * 5.9604644775390625e-8;  // rounding by chance keeps the mean
  float amount = -log(1.0 - min(coverage, 0.98));
  uint units = uint(amount * NEAR_DEPTH_ONE + chance);
  uvec3 lit = uvec3(min(light * frame.lens.w, vec3(NEAR_RADIANCE_MOST)) * (amount * NEAR_RADIANCE_ONE) + chance);
  uint at = 4u * (uint(pixel.y) * uint(frame.size.x) + uint(pixel.x));
  if (lit.r != 0u) atomicAdd(sums[at], lit.r);
  if (lit.g != 0u) atomicAdd(sums[at + 1u], lit.g);
  if (lit.b != 0u) atomicAdd(sums[at + 2u], lit.b);
  if (units != 0u) atomicAdd(sums[at + 3u], units);
}

void main() {
  uint index = gl_WorkGroupID.y * uint(NEAR_ROW) + gl_WorkGroupID.x;
  if (index >= min(count, capacity)) return;
  NearDropGpu drop = drops[index];
  int lane = int(gl_LocalInvocationIndex);
  vec2 from = drop.from_to.xy, to = drop.from_to.zw;
  float r = max(drop.depths.w, 0.5), kept = drop.depths.z / (3.14159265 * r * r);  // at least a pixel wide
  Shown s;
  s.index = index;
  s.ray = normalize(drop.place.xyz);
  s.place = drop.place.xyz - captured_from;
  s.streak = is_streak(drop);
  s.image = 0u;
  s.image_right = s.image_up = vec3(0.0);
  if (drop.bits.y != 0u) {
    s.image = (drop.bits.y - 1u) * uint(map_pixels * map_pixels + map_pixels);
    image_axes(s.ray, s.image_right, s.image_up);
  }
  vec2 span = to - from;
  float len = length(span), area = min(1.0 / (r * r), 3.14159265);
  if (len < 0.5) {  // stands still: a disc with the edge of a pixel
    vec2 centre = 0.5 * (from + to);
    kept *= r * r / (r * r + 0.0833333);  // whose edge adds to its area
    ivec2 low = ivec2(max(floor(centre - r - 1.0), 0.0));
    ivec2 high = ivec2(min(ceil(centre + r + 1.0), frame.size.xy - 1.0));
    int wide = high.x - low.x + 1, pixels = max(wide, 0) * max(high.y - low.y + 1, 0);
    for (int i = lane; i < pixels; i += NEAR_LANES) {
      ivec2 pixel = low + ivec2(i % wide, i / wide);
      vec2 offset = vec2(pixel) + 0.5 - centre;
      float edge = r + 0.5 - length(offset);
      if (edge <= 0.0) continue;
      add(pixel, kept * min(edge, 1.0), 0.5 * (drop.depths.x + drop.depths.y), shown_at(drop, s, offset / r, area),
          drop.bits.x);
    }
    return;
  }
  vec2 along = span / len, side = lateral_of(drop);
  bool steep = abs(along.y) > abs(along.x);
  float major = steep ? along.y : along.x, minor = steep ? along.x : along.y;
  float start = steep ? from.y : from.x, start_minor = steep ? from.x : from.y, end = steep ? to.y : to.x;
  float limit = steep ? frame.size.y : frame.size.x, limit_minor = steep ? frame.size.x : frame.size.y;
  int first = int(max(floor(min(start, end) - r), 0.0)), last = int(min(ceil(max(start, end) + r), limit - 1.0));
  float half_width = r / abs(major) + r * abs(minor / major);
  for (int i = first + lane; i <= last; i += NEAR_LANES) {
    float centre = start_minor + (float(i) + 0.5 - start) * (minor / major);
    int low = int(max(floor(centre - half_width), 0.0)), high = int(min(ceil(centre + half_width), limit_minor - 1.0));
    for (int j = low; j <= high; ++j) {
      ivec2 pixel = steep ? ivec2(j, i) : ivec2(i, j);
      vec2 offset = vec2(pixel) + 0.5 - from;
      float t = dot(offset, along), x = dot(offset, side);
      if (abs(x) >= r) continue;
      float chord = sqrt(r * r - x * x), near = max(t - chord, 0.0), far = min(t + chord, len);
      if (far <= near) continue;
      vec3 light;
      if (s.streak) {
        light = 0.5 * (column_at(drop, s, (x - 0.25) / r) + column_at(drop, s, (x + 0.25) / r));
      } else {
        // The part of the image that passes over the pixel: three places of it.
        light = vec3(0.0);
        for (int k = 0; k < 3; ++k) {
          float centre_at = mix(near, far, (float(k) + 0.5) / 3.0);
          light += shown_at(drop, s, (offset - along * centre_at) / r, max(area, (far - near) / (3.0 * r * r))) / 3.0;
        }
      }
      add(pixel, kept * (far - near) / len, mix(drop.depths.x, drop.depths.y, clamp(t / len, 0.0, 1.0)), light,
          drop.bits.x);
    }
  }
}
