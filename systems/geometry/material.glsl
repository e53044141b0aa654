// From a material and interpolated attributes to a Surface. MATERIAL_VARIANT (define) tells which textures there
// are, bits as MaterialVariant in systems/gpu_scene.hpp; 16 handles everything.
#ifndef SYSTEMS_GEOMETRY_MATERIAL_GLSL
#define SYSTEMS_GEOMETRY_MATERIAL_GLSL
#include "systems/geometry/gbuffer.glsl"
#include "systems/material_shared.h"

#if (MATERIAL_VARIANT & 16) != 0
#define MATERIAL_HAS(bit) 1
#else
#define MATERIAL_HAS(bit) ((MATERIAL_VARIANT & bit) != 0)
#endif

layout(std140, binding = MATERIAL_UNIFORMS_BINDING) uniform MaterialBlock { MaterialGpu material; };
layout(binding = MATERIAL_FIRST_UNIT + MATERIAL_BASE_COLOUR) uniform sampler2D base_colour_texture;
layout(binding = MATERIAL_FIRST_UNIT + MATERIAL_SURFACE) uniform sampler2D surface_texture;
layout(binding = MATERIAL_FIRST_UNIT + MATERIAL_NORMAL) uniform sampler2D normal_texture;
layout(binding = MATERIAL_FIRST_UNIT + MATERIAL_OCCLUSION) uniform sampler2D occlusion_texture;
layout(binding = MATERIAL_FIRST_UNIT + MATERIAL_EMISSIVE) uniform sampler2D emissive_texture;
layout(binding = MATERIAL_FIRST_UNIT + MATERIAL_HOLLOW) uniform sampler2D hollow_texture;

layout(location = 0) in vec3 vertex_normal;
layout(location = 1) in vec4 vertex_tangent;
layout(location = 2) in vec4 vertex_uv;  // both sets
layout(location = 3) in vec4 vertex_colour;

vec2 placed_uv(int slot) {
#if (MATERIAL_VARIANT & 16) != 0
  vec2 uv = material.offset_set[slot].z > 0.5 ? vertex_uv.zw : vertex_uv.xy;
#else
  vec2 uv = vertex_uv.xy;
#endif
  vec4 m = material.matrix[slot];
  return vec2(dot(m.xy, uv), dot(m.zw, uv)) + material.offset_set[slot].xy;
}

// Linear, with alpha.
vec4 base_colour() {
  vec4 colour = material.base_colour * vertex_colour;
#if (MATERIAL_VARIANT & 16) != 0
  if (material.water.y > 0.0) colour = material.base_colour * vec4(1.0, 1.0, 1.0, vertex_colour.a);
#endif
#if MATERIAL_HAS(1)
  colour *= texture(base_colour_texture, placed_uv(MATERIAL_BASE_COLOUR));
#endif
  return colour;
}

vec3 unit_or_up(vec3 v) {
  float square = dot(v, v);
  return square > 1e-20 ? v * inversesqrt(square) : vec3(0.0, 1.0, 0.0);
}

// Widens GGX by what the pixel averages over: the change of the shading normal across it (Tokuyoshi and Kaplanyan
// 2019, "Improved Geometric Specular Antialiasing", eq. 4 and listing 2; pixel filter variance 0.25, at most 0.18)
// and, with a normal map, the spread that its mip level lost (Toksvig 2005). Roughness in and out is perceptual.
float widened_roughness(float roughness, vec3 normal, float map_length) {
  vec3 along_x = dFdx(normal), along_y = dFdy(normal);
  float variance = 0.25 * (dot(along_x, along_x) + dot(along_y, along_y));
  float widening = min(2.0 * variance, 0.18);
  // 8-bit maps store lengths to about 0.006; less than that is no spread.
  widening += 2.0 * max((1.0 - map_length) / max(map_length, 0.1) - 0.006, 0.0);
  float alpha = roughness * roughness;
  return sqrt(sqrt(clamp(alpha * alpha + widening, 0.0, 1.0)));
}

// What the G-buffer's water_mask holds: the depth of a hollow, of the material's deepest, and the kind of material.
// relief: 0 to 1, the surface texture's red. Of what a material has not, the weights are 0.
vec2 material_water_mask(float relief) {
  float hollow = material.water.x * vertex_uv.z - material.relief.x * (relief - material.relief.y);
#if (MATERIAL_VARIANT & 16) != 0
  hollow += material.water.y * vertex_colour.r;
  if (material.water.w > 0.0) hollow += texture(hollow_texture, placed_uv(MATERIAL_HOLLOW)).r;
#endif
  return vec2(clamp(hollow, 0.0, 1.0), material.water.z);
}

// At the fragment. Derivatives are taken here: call it in uniform control flow, before any discard.
// water_mask: as material_water_mask.
Surface material_surface(vec4 colour, out vec2 water_mask) {
  Surface s;
  vec3 normal = unit_or_up(vertex_normal);
  // glTF: the back of a double-sided surface is lit with the normal turned round. A back that a single-sided
  // material shows all the same (culling is off in some passes) is left as it is.
  float side = gl_FrontFacing || material.choices.y < 0.5 ? 1.0 : -1.0;
  float map_length = 1.0;
#if MATERIAL_HAS(4)
  vec3 tangent = vertex_tangent.xyz - normal * dot(normal, vertex_tangent.xyz);
  tangent = unit_or_up(tangent);
  vec3 bitangent = cross(normal, tangent) * vertex_tangent.w;
  vec3 mapped = texture(normal_texture, placed_uv(MATERIAL_NORMAL)).xyz * (255.0 / 127.0) - (128.0 / 127.0);
  map_length = clamp(length(mapped), 0.1, 1.0);
  mapped.xy *= material.surface.z;
  normal = unit_or_up(tangent * mapped.x + bitangent * mapped.y + normal * max(mapped.z, 0.02));
#endif
  s.normal = normal * side;
  vec4 orm = vec4(1.0);
#if MATERIAL_HAS(2)
  orm = texture(surface_texture, placed_uv(MATERIAL_SURFACE));
#endif
  water_mask = material_water_mask(orm.r);
  s.metallic = clamp(material.surface.x * orm.b, 0.0, 1.0);
  s.roughness = clamp(material.surface.y * orm.g, 0.04, 1.0);
  s.roughness = widened_roughness(s.roughness, normal, map_length);
  float open = material.choices.x > 0.5 ? orm.r : 1.0;
#if (MATERIAL_VARIANT & 16) != 0
  if (material.choices.x < 0.5) open = texture(occlusion_texture, placed_uv(MATERIAL_OCCLUSION)).r;
#endif
  s.occlusion = 1.0 + material.surface.w * (open - 1.0);
  s.water = 0.0;
  s.emissive = material.emissive_cutoff.rgb;
#if MATERIAL_HAS(8)
  s.emissive *= texture(emissive_texture, placed_uv(MATERIAL_EMISSIVE)).rgb;
#endif
  s.albedo = colour.rgb;
  // KHR_materials_unlit: the base colour is the picture's colour whatever the exposure.
  if (material.choices.z > 0.5) {
    s.emissive = colour.rgb / frame.lens.w;
    s.albedo = vec3(0.0);
    s.metallic = 0.0;
  }
  return s;
}

#endif
