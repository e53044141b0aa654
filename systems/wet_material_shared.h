// How materials take water: a table that every pass may read, shared by C++ and GLSL (std430, groups of four).
#ifndef PETRICHOR_WET_MATERIAL_SHARED_H
#define PETRICHOR_WET_MATERIAL_SHARED_H

#ifdef __cplusplus
#include <glm/glm.hpp>
namespace petrichor {
using glm::vec4;
#endif

// buffer WetMaterials { WetMaterialGpu wet_materials[]; }, bound once a frame with the instances. The index is the
// kind in the G-buffer's water_mask (g x 255); 0 is what never gets wet.
#define WET_MATERIALS_BINDING 20
#define WET_MATERIAL_KINDS 256

struct WetMaterialGpu {
  vec4 absorption_depth;  // rgb: of the water that stands on it, 1/m; w: depth of a hollow whose mask is 1, m
  vec4 ripple;            // p_i, s_o, theta_o in rad (Tatarchuk and Isidoro 2006, section 4); w: porosity 0 to 1,
                          // -1: by the dry roughness of each texel (Lagarde 2013)
};

#ifdef __cplusplus
static_assert(sizeof(WetMaterialGpu) == 32);
}  // namespace petrichor
#endif
#endif
