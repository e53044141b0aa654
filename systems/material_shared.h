// A material as the shaders see it; the struct is shared by C++ and GLSL (std140: groups of four only).
#ifndef PETRICHOR_MATERIAL_SHARED_H
#define PETRICHOR_MATERIAL_SHARED_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace petrichor {
using glm::vec4;
#endif

#define MATERIAL_UNIFORMS_BINDING 2  // uniform block MaterialBlock { MaterialGpu material; }, bound per batch
#define MATERIAL_FIRST_UNIT 0        // textures in the order of MaterialGpu::uv_*

#define MATERIAL_BASE_COLOUR 0
#define MATERIAL_SURFACE 1  // metallic (b), roughness (g), perhaps occlusion (r)
#define MATERIAL_NORMAL 2
#define MATERIAL_OCCLUSION 3
#define MATERIAL_EMISSIVE 4
#define MATERIAL_HOLLOW 5  // red: depth of hollows
#define MATERIAL_TEXTURES 6

struct MaterialGpu {
  vec4 base_colour;
  vec4 emissive_cutoff;  // rgb cd/m2, w: alpha below which a fragment is dropped; 0: none is
  vec4 surface;          // metallic, roughness, normal scale, occlusion strength
  vec4 choices;          // x: 1 where occlusion is the surface texture's red, y: 1 where double sided, z: 1 where unlit, w 0
  vec4 water;            // hollows: x weight of TEXCOORD_1.x, y of the vertex colour's red (1: no tint), w of the texture;
                         // z: kind of wet material / 255
  vec4 relief;           // x: height of the surface texture's red, of the deepest hollow, y: its mean, zw 0
  // KHR_texture_transform of each texture: uv' = (dot(xy, uv), dot(zw, uv)) + offset.xy; offset.z: UV set
  vec4 matrix[MATERIAL_TEXTURES];
  vec4 offset_set[MATERIAL_TEXTURES];
};

#ifdef __cplusplus
static_assert(sizeof(MaterialGpu) == (6 + 2 * MATERIAL_TEXTURES) * 16);
}  // namespace petrichor
#endif
#endif
