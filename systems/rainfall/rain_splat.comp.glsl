#version 450 core
// Draws the drops of the listed cells: each drop's path over the exposure, by integer atomics.
//
// A drop of projected area A (pixels) whose image moves over L pixels covers A / L of the time and width of a
// line one pixel wide, so the sum of its coverage is A at any exposure and any width that is drawn: the mean
// transmittance stays exp(-extinction * distance). Coverages multiply, so their optical depths
// -ln(1 - coverage) add, in any order.
layout(local_size_x = 64) in;
#include "systems/frame.glsl"
#include "systems/occlusion/occlusion.glsl"
#include "systems/rainfall/field.glsl"

layout(std430, binding = RAIN_CELLS_BINDING) readonly buffer RainCells { RainCellGpu cells[]; };
layout(std430, binding = RAIN_COMMAND_BINDING) buffer RainCommand {
  uint groups_x, groups_y, groups_z, cell_count, drops_drawn;
};
layout(std430, binding = RAIN_OPTICAL_DEPTH_BINDING) buffer RainOpticalDepth { uint optical_depth[]; };
layout(std430, binding = RAIN_RADIANCE_BINDING) buffer RainRadiance { uint radiance[]; };  // 4 per pixel: r, g, b, -
layout(std430, binding = RAIN_OPTICS_BINDING) readonly buffer RainOptics {
  float phase[RAIN_PHASE_BINS];
  vec4 ambient[RAIN_AMBIENT_BINS];
};
layout(binding = 0) uniform sampler2D scene_depth;
uniform uint capacity;
uniform vec3 distances;  // nearest axial distance, start and end of the fade, m
uniform bool use_depth, use_occlusion;

#ifdef COUNT_DROPS
shared uint group_drops;
#endif

vec2 size;
uint dither_state;
vec3 drop_light;  // output radiance from lamps
bool lit;

float dither() {
  dither_state = dither_state * 747796405u + 2891336453u;
  return float(dither_state >> 8u) * 5.9604644775390625e-8;
}

void add(ivec2 pixel, float coverage, float depth) {
  if (uint(pixel.x) >= uint(size.x) || uint(pixel.y) >= uint(size.y)) return;
  float amount = coverage < 0.05 ? coverage * (1.0 + coverage * (0.5 + coverage * 0.3333333))
                                 : -log(1.0 - min(coverage, 0.98));
  // Rounding up or down by chance keeps the mean, and most of what is far too faint costs no atomic.
  float chance = dither();
  uint units = uint(amount * RAIN_DEPTH_ONE + chance);
  vec3 lamp = vec3(0.0);
  if (lit) {
    lamp = amount * drop_light * RAIN_RADIANCE_ONE + chance;
    if (units == 0u && all(lessThan(lamp, vec3(1.0)))) return;
  } else if (units == 0u) {
    return;
  }
  if (use_depth && depth < texelFetch(scene_depth, pixel, 0).r) return;
  uint at = uint(pixel.y) * uint(size.x) + uint(pixel.x);
  if (units > 0u) atomicAdd(optical_depth[at], units);
  if (lit) {
    uvec3 l = uvec3(lamp);
    if (l.r > 0u) atomicAdd(radiance[4u * at], l.r);
    if (l.g > 0u) atomicAdd(radiance[4u * at + 1u], l.g);
    if (l.b > 0u) atomicAdd(radiance[4u * at + 2u], l.b);
  }
}

// Narrower than a pixel: a line one pixel wide.
void draw_line(vec2 from, vec2 to, vec2 depths, float area) {
  vec2 span = to - from;
  bool steep = abs(span.y) > abs(span.x);
  float length_major = max(abs(span.x), abs(span.y));
  if (length_major < 1.0) {
    float t = dither();
    add(ivec2(floor(from + t * span)), area, mix(depths.x, depths.y, t));
    return;
  }
  // a, b: along the longer axis, rising; the other coordinate is linear in it.
  vec2 p = steep ? from.yx : from, q = steep ? to.yx : to;
  if (p.x > q.x) {
    vec2 t = p;
    p = q;
    q = t;
    depths = depths.yx;
  }
  float slope = (q.y - p.y) / (q.x - p.x), deepening = (depths.y - depths.x) / (q.x - p.x);
  float per_pixel = area / length_major;
  float limit = steep ? size.y : size.x;
  int first = int(max(floor(p.x), 0.0)), last = int(min(floor(q.x), limit - 1.0));
  for (int i = first; i <= last; ++i) {
    float low = max(p.x, float(i)), high = min(q.x, float(i) + 1.0);
    float middle = 0.5 * (low + high) - p.x;
    float across = p.y + slope * middle;
    float depth = depths.x + deepening * middle;
    float coverage = per_pixel * (high - low);
#ifdef SMOOTH_LINES
    if (coverage > 0.004) {  // shared between the two nearest pixels
      float place = across - 0.5;
      int j = int(floor(place));
      float share = place - float(j);
      add(steep ? ivec2(j, i) : ivec2(i, j), coverage * (1.0 - share), depth);
      add(steep ? ivec2(j + 1, i) : ivec2(i, j + 1), coverage * share, depth);
      continue;
    }
#endif
    int j = int(floor(across - 0.5 + dither()));  // one of the two, by chance: the same mean
    add(steep ? ivec2(j, i) : ivec2(i, j), coverage, depth);
  }
}

// A disc of radius r that moves from one place to the other: each pixel centre's share of the time inside.
void draw_capsule(vec2 from, vec2 to, vec2 depths, float r) {
  vec2 span = to - from;
  float len = length(span);
  if (len < 0.5) {  // stands still: a disc with the edge of a pixel
    vec2 centre = 0.5 * (from + to);
    ivec2 low = ivec2(max(floor(centre - r - 1.0), 0.0)), high = ivec2(min(ceil(centre + r + 1.0), size - 1.0));
    for (int y = low.y; y <= high.y; ++y) {
      for (int x = low.x; x <= high.x; ++x) {
        float edge = r + 0.5 - distance(vec2(x, y) + 0.5, centre);
        if (edge > 0.0) add(ivec2(x, y), min(edge, 1.0), 0.5 * (depths.x + depths.y));
      }
    }
    return;
  }
  vec2 along = span / len;
  bool steep = abs(along.y) > abs(along.x);
  float major = steep ? along.y : along.x, minor = steep ? along.x : along.y;
  float start = steep ? from.y : from.x, start_minor = steep ? from.x : from.y;
  float end = steep ? to.y : to.x;
  float limit = steep ? size.y : size.x, limit_minor = steep ? size.x : size.y;
  int first = int(max(floor(min(start, end) - r), 0.0)), last = int(min(ceil(max(start, end) + r), limit - 1.0));
  float half_width = r / abs(major) + r * abs(minor / major);
  for (int i = first; i <= last; ++i) {
    float centre = start_minor + (float(i) + 0.5 - start) * (minor / major);
    // The caps reach beyond the band's own ends by less than the band is wide.
    int low = int(max(floor(centre - half_width), 0.0)), high = int(min(ceil(centre + half_width), limit_minor - 1.0));
    for (int j = low; j <= high; ++j) {
      vec2 pixel = (steep ? vec2(j, i) : vec2(i, j)) + 0.5;
      vec2 offset = pixel - from;
      float s = dot(offset, along), h = offset.x * along.y - offset.y * along.x;
      if (abs(h) >= r) continue;
      float chord = sqrt(r * r - h * h);
      float covered = (min(s + chord, len) - max(s - chord, 0.0)) / len;
      if (covered > 0.0) add(ivec2(pixel), covered, mix(depths.x, depths.y, clamp(s / len, 0.0, 1.0)));
    }
  }
}

vec3 lamp_light(RainCellGpu cell, int count, vec3 at) {
  vec3 sum = vec3(0.0);
  float distance_to_eye = length(at);
  for (int i = 0; i < count; ++i) {
    uint pair = cell.lights[i >> 1];
    LightGpu light = lights[(i & 1) == 0 ? pair & 0xffffu : pair >> 16u];
    vec3 from_light = at - light.position_range.xyz;
    float d2 = max(dot(from_light, from_light), 1e-4);
    vec3 direction = from_light * inversesqrt(d2);
    float strength;
    if (light.direction_kind.w == float(LIGHT_DIRECTIONAL)) {
      direction = light.direction_kind.xyz;
      strength = 1.0;
    } else {
      float ratio = d2 / (light.position_range.w * light.position_range.w);
      float window = clamp(1.0 - ratio * ratio, 0.0, 1.0);
      strength = window * window / max(d2, light.intensity_radius.w * light.intensity_radius.w + 0.0025);
      if (light.direction_kind.w == float(LIGHT_SPOT)) {
        float cone = clamp(dot(direction, light.direction_kind.xyz) * light.cone_shadow.x + light.cone_shadow.y, 0.0, 1.0);
        strength *= cone * cone;
      }
    }
    // The turn from the light's direction to the eye's: 0 where the drop stands before the lamp.
    float cosine = -dot(direction, at) / distance_to_eye;
    uint bin = min(uint(sqrt(max(0.5 - 0.5 * cosine, 0.0)) * float(RAIN_PHASE_BINS)), uint(RAIN_PHASE_BINS - 1));
    sum += light.intensity_radius.rgb * (strength * phase[bin]);
  }
  // What mist and undrawn drops leave of it on the way to the eye.
  return sum * exp(-(frame.mist.x + frame.rain.z) * distance_to_eye);
}

// Returns whether any of the drop may be seen.
bool draw_drop(RainCellGpu cell, RainLayerGpu layer, uint m) {
  uint bits;
  vec4 place = drop_of_cell(cell.key.xyz, m, bits);
  vec3 closed = cell.corner_edge.xyz + cell.corner_edge.w * place.xyz;  // when the shutter closed
  float far2 = dot(closed, closed);
  float fade = mix(distances.y, distances.z, place.w);  // where this drop leaves
  if (far2 > fade * fade) return false;

  float exposure_s = frame.camera_velocity_mps.w;
  vec3 opened = closed - layer.velocity_diameter.xyz * exposure_s;
  vec4 c1 = frame.view_projection * vec4(closed, 1.0), c0 = frame.shutter_view_projection * vec4(opened, 1.0);
  // Cut the path at the nearest plane; what is nearer is dealt with by the mean.
  float nearest = distances.x;
  if (max(c0.w, c1.w) <= nearest) return false;
  float kept = 1.0;
  if (c0.w < nearest) {
    float t = (nearest - c0.w) / (c1.w - c0.w);
    c0 = mix(c0, c1, t);
    kept = 1.0 - t;
  } else if (c1.w < nearest) {
    float t = (nearest - c1.w) / (c0.w - c1.w);
    c1 = mix(c1, c0, t);
    kept = 1.0 - t;
  }
  vec2 inverse_w = 1.0 / vec2(c0.w, c1.w);
  vec2 from = (c0.xy * inverse_w.x * 0.5 + 0.5) * size, to = (c1.xy * inverse_w.y * 0.5 + 0.5) * size;

  vec3 middle = 0.5 * (opened + closed);
  float axial = 0.5 * (c0.w + c1.w);
  float across = layer.velocity_diameter.w * frame.lens.z;
  // A sphere's image grows towards the edge of the picture: solid angle over cosine cubed.
  float area = 0.7853981634 * across * across * length(middle) / (axial * axial * axial);
  float r = sqrt(area * 0.3183098862);
  if (any(lessThan(max(from, to) + r, vec2(0.0))) || any(greaterThan(min(from, to) - r, size))) return false;

  // Most hidden drops are wholly hidden, and the middle tells.
  vec2 depths = frame.camera_world_m.w * inverse_w;
  ivec2 pixel = ivec2(clamp(0.5 * (from + to), vec2(0.0), size - 1.0));
  if (use_depth && max(abs(to.x - from.x), abs(to.y - from.y)) < 1.0 &&
      max(depths.x, depths.y) < texelFetch(scene_depth, pixel, 0).r) return false;
  if (use_occlusion && sheltered(middle)) return false;

  dither_state = bits;
  int light_count = int(cell.key.w >> 12u & 15u);
  lit = light_count > 0;
  if (lit) drop_light = min(lamp_light(cell, light_count, middle) * frame.lens.w, vec3(RAIN_RADIANCE_MOST));
  if (r < 0.5) draw_line(from, to, depths, area * kept);
  else draw_capsule(from, to, depths, r);
  return true;
}

void main() {
#ifdef COUNT_DROPS
  if (gl_LocalInvocationIndex == 0u) group_drops = 0u;
  barrier();
#endif
  size = frame.size.xy;
  uint group = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
  uint index = group * uint(RAIN_SPLAT_GROUP / RAIN_LANES) + gl_LocalInvocationIndex / uint(RAIN_LANES);
  uint drawn = 0u;
  if (index < min(cell_count, capacity)) {
    RainCellGpu cell = cells[index];
    RainLayerGpu layer = layers[cell.key.w & 0xfffu];
    uint count = cell.key.w >> 16u;
    for (uint m = gl_LocalInvocationIndex % uint(RAIN_LANES); m < count; m += uint(RAIN_LANES)) {
      if (draw_drop(cell, layer, m)) drawn += 1u;
    }
  }
#ifdef COUNT_DROPS
  if (drawn > 0u) atomicAdd(group_drops, drawn);
  barrier();
  if (gl_LocalInvocationIndex == 0u && group_drops > 0u) atomicAdd(drops_drawn, group_drops);
#endif
}
