#version 450 core
// A pixel of a drip: what it covers, and what it shows. Laid over the picture: picture * a + rgb.
#define DRIP_STAGE in
#include "systems/drip/drip_over.glsl"
#include "systems/drip/drip_shared.h"
#include "systems/frame.glsl"
#include "systems/drip/drip_optics.glsl"
#ifdef SCENE
layout(binding = 0) uniform sampler2D scene_depth;
#endif
layout(binding = DRIP_NORMALS_UNIT) uniform sampler2D droplet_normals;  // normal.xy, height, opacity
layout(std430, binding = DRIP_LOOKS_BINDING) readonly buffer DripLooks { DripLooksGpu looks[]; };
uniform float lightning;  // k_c (L_1 + L_2)
uniform float reach_m;
layout(location = 0) out vec4 over;

vec3 in_world(vec2 q) {
  vec3 right = vec3(frame.view[0][0], frame.view[1][0], frame.view[2][0]);
  vec3 up = vec3(frame.view[0][1], frame.view[1][1], frame.view[2][1]);
  vec3 w = right * q.x + up * q.y;
  return w - ray * dot(w, ray);
}

// Section 3.2. The printed formula is alpha' = d_p alpha (e_s f + e_b) (1 - 1/2), damaged in print: the text names it
// 1 - l_b / 2, with l_b = 1 + k_c (L_1 + L_2) as in section 3.1. Read so, a drop is half as opaque without any
// lightning, although "particles still maintain their artist-specified transparency in the regular lighting"; so what
// is meant must be what lightning adds, 1 - k_c (L_1 + L_2) / 2, which is the default here. d_p, "the particle
// distance", is to attenuate opacity: read as nearness, 1 at the eye and 0 where drops end; true drops are no thinner
// far away (their image is smaller), so the default leaves it out. published has both as printed.
float billboard_opacity(DripLooksGpu look, float f, float texture_opacity) {
  bool published = look.published.x > 0.5;
  float l_b = 1.0 + lightning;
  float d_p = published ? clamp(1.0 - away_tall.x / reach_m, 0.0, 1.0) : 1.0;
  float by_lightning = published ? 1.0 - 0.5 * l_b : 1.0 - 0.5 * (l_b - 1.0);
  float alpha = texture_opacity * look.opacity.x;
  return clamp(d_p * alpha * (look.opacity.y * f + look.opacity.z) * max(by_lightning, 0.0), 0.0, 1.0);
}

// q: place in the billboard, -1 to 1.
vec4 billboard(DripLooksGpu look, vec2 q, vec2 along, vec2 side, float r, float len) {
  // Pre-blurred and stretched mips, chosen by depth (the image's size) and velocity (how far it falls).
  float level = max(log2(0.5 * float(DRIP_NORMALS) / r), 0.0) + log2(1.0 + 0.5 * len / r);
  vec4 texel = textureLod(droplet_normals, q * 0.5 + 0.5, level);
  vec2 n2 = texel.xy * 2.0 - 1.0;
  float n_v = sqrt(max(1.0 - dot(n2, n2), 0.0));
  vec3 n = normalize(in_world(side * n2.x + along * n2.y) - ray * n_v);
  float f = 0.95 * pow(1.0 - n_v, 4.0) + 0.05;  // section 3.1
  float blur = 0.02 * exp2(level);
  vec3 shown = (1.0 - f) * around(refract(ray, n, 1.0 / 1.333), blur) + f * around(reflect(ray, n), blur);
  shown += even_light + glint_light;
  if (look.published.x > 0.5) shown *= 1.0 + lightning;  // l_b modulates reflection, refraction and specular light
  return vec4(shown, billboard_opacity(look, f, texel.a));
}

void main() {
  over = vec4(0.0, 0.0, 0.0, 1.0);
  vec2 from = from_to.xy, to = from_to.zw, span = to - from;
  float r = depths_kept.z, kept = depths_kept.w, len = length(span);
  vec2 along = len > 1e-3 ? span / len : vec2(0.0, -1.0), side = vec2(-along.y, along.x);
  vec2 offset = gl_FragCoord.xy - from;
  float t = dot(offset, along), x = dot(offset, side);
#ifdef SCENE
  float depth = mix(depths_kept.x, depths_kept.y, len > 1e-3 ? clamp(t / len, 0.0, 1.0) : 0.5);
  if (depth < texelFetch(scene_depth, ivec2(gl_FragCoord.xy), 0).r) return;
#endif
  if (which.y == 1u) {
    DripLooksGpu look = looks[which.x];
    vec2 half_size = vec2(r, r * away_tall.y + 0.5 * len);
    vec2 q = vec2(x, t - 0.5 * len) / half_size;
    float edge = (1.0 - length(q)) * min(half_size.x, half_size.y) + 0.5;  // pixels
    if (edge <= 0.0) return;
    vec4 shown = billboard(look, q, along, side, r, len);
    // The soft edge reaches beyond the ellipse: its mean share of it is pi (1 + 1 / (12 m^2)).
    float m = min(half_size.x, half_size.y), even = m * m / (m * m + 0.0833333);
    float opacity = shown.a * clamp(kept, 0.0, 1.0) * even * min(edge, 1.0);
    over = vec4(shown.rgb * opacity, 1.0 - opacity);
    return;
  }
  // The pixel's share of the time within a disc that moves from one place to the other: as raster.glsl's capsules.
  float coverage, near, far;
  if (len < 0.5) {
    // A disc, or an ellipse: as a disc in its own measure.
    offset = 0.5 * span + side * x + along * ((t - 0.5 * len) / away_tall.y);
    float edge = r + 0.5 - length(offset - 0.5 * span);
    if (edge <= 0.0) return;
    coverage = min(edge, 1.0) * (r * r) / (r * r + 0.0833333);
    near = far = 0.5 * len;
  } else {
    if (abs(x) >= r) return;
    float chord = sqrt(r * r - x * x);
    near = max(t - chord, 0.0);
    far = min(t + chord, len);
    if (far <= near) return;
    coverage = (far - near) / len;
  }
  coverage = min(coverage * kept, 1.0);
  // The part of the drop's image that passes over the pixel: three places of it.
  int places = len < 0.5 ? 1 : 3;
  float area = clamp(max(1.0, (far - near) / float(places)) / (r * r), 1e-4, 3.14159265);
  vec3 shown = even_light;
  for (int i = 0; i < places; ++i) {
    float centre = places == 1 ? near : mix(near, far, (float(i) + 0.5) / 3.0);
    vec2 q = (offset - along * centre) / r;
    float b = min(length(q), 0.999);
    vec3 o = b > 1e-3 ? normalize(in_world(q)) : normalize(in_world(side));
    vec2 g = q - glint_place;
    float width = glint_width(r);
    float glint = exp(-0.5 * dot(g, g) / (width * width));
    shown += (seen_in_drip(ray, o, b, area) + glint_light * glint) / float(places);
  }
  over = vec4(shown * coverage, 1.0 - coverage);
}
