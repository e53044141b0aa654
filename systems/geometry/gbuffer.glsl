// The thin G-buffer: 20 bytes a pixel, written by pass "gbuffer", read by everything that lights.
//   depth     depth32f        reversed z; 0 is the sky
//   albedo    rgba8           rgb: square root of linear base colour (2 bits more in the darks), a: metallic
//   normal    rgba16 (unorm)  rg: octahedral world normal, b: perceptual roughness, a: ambient occlusion in its upper
//                             11 bits, share under water in its lower 5: whoever reads it whole is off by 1/2048
//   emissive  r11f_g11f_b10f  cd/m2
//   water_mask  rg8  optional: hollow that may hold water (0..1), kind of material (n / 255)
#ifndef SYSTEMS_GEOMETRY_GBUFFER_GLSL
#define SYSTEMS_GEOMETRY_GBUFFER_GLSL
#include "systems/geometry/position.glsl"

// Readers bind the four textures to these units in this order; define another first unit before the include.
#ifndef GBUFFER_FIRST_UNIT
#define GBUFFER_FIRST_UNIT 0
#endif

struct Surface {
  vec3 albedo;      // linear base colour
  float metallic;
  vec3 normal;      // world, unit, towards the viewer
  float roughness;  // perceptual: GGX alpha is its square
  float occlusion;  // 1: open
  float water;      // 0 to 1: share whose first interface is water, which mirrors half as much as stone
  vec3 emissive;    // cd/m2
};

// Octahedral unit vectors (Cigolle et al. 2014, "A Survey of Efficient Representations for Independent Unit
// Vectors", JCGT 3(2)): to and from [-1,1]^2.
vec2 octahedral_from_unit(vec3 n) {
  vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
  vec2 s = vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
  return n.z >= 0.0 ? p : (1.0 - abs(p.yx)) * s;
}

vec3 unit_from_octahedral(vec2 p) {
  vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  float t = max(-n.z, 0.0);
  n.x += n.x >= 0.0 ? -t : t;
  n.y += n.y >= 0.0 ? -t : t;
  return normalize(n);
}

vec4 encode_albedo(Surface s) { return vec4(sqrt(clamp(s.albedo, 0.0, 1.0)), s.metallic); }
vec4 encode_normal(Surface s) {
  float upper = floor(clamp(s.occlusion, 0.0, 1.0) * 2047.0 + 0.5), lower = floor(clamp(s.water, 0.0, 1.0) * 31.0 + 0.5);
  return vec4(octahedral_from_unit(s.normal) * 0.5 + 0.5, s.roughness, (upper * 32.0 + lower) / 65535.0);
}

Surface decode_surface(vec4 albedo, vec4 normal, vec3 emissive) {
  Surface s;
  s.albedo = albedo.rgb * albedo.rgb;
  s.metallic = albedo.a;
  s.normal = unit_from_octahedral(normal.xy * 2.0 - 1.0);
  s.roughness = normal.z;
  float bits = floor(normal.w * 65535.0 + 0.5), upper = floor(bits * (1.0 / 32.0));
  s.occlusion = upper * (1.0 / 2047.0);
  s.water = (bits - upper * 32.0) * (1.0 / 31.0);
  s.emissive = emissive;
  return s;
}

#ifndef GBUFFER_WRITER
layout(binding = GBUFFER_FIRST_UNIT + 0) uniform sampler2D gbuffer_depth;
layout(binding = GBUFFER_FIRST_UNIT + 1) uniform sampler2D gbuffer_albedo;
layout(binding = GBUFFER_FIRST_UNIT + 2) uniform sampler2D gbuffer_normal;
layout(binding = GBUFFER_FIRST_UNIT + 3) uniform sampler2D gbuffer_emissive;

float read_depth(ivec2 texel) { return texelFetch(gbuffer_depth, texel, 0).r; }

Surface read_surface(ivec2 texel) {
  return decode_surface(texelFetch(gbuffer_albedo, texel, 0), texelFetch(gbuffer_normal, texel, 0),
                        texelFetch(gbuffer_emissive, texel, 0).rgb);
}
#endif

#endif
