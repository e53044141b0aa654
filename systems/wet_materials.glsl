// The table of wet materials, for passes that read the G-buffer's water_mask.
#ifndef SYSTEMS_WET_MATERIALS_GLSL
#define SYSTEMS_WET_MATERIALS_GLSL
#include "systems/wet_material_shared.h"

layout(std430, binding = WET_MATERIALS_BINDING) readonly buffer WetMaterials { WetMaterialGpu wet_materials[]; };

// mask: of the G-buffer's water_mask.
uint wet_kind(vec2 mask) { return uint(mask.y * 255.0 + 0.5); }  // 0: never wet

// Share of its volume that water can fill. dry_roughness: perceptual, of the texel.
float porosity_of(WetMaterialGpu material, float dry_roughness) {
  float by_roughness = clamp((dry_roughness - 0.5) / 0.4, 0.0, 1.0);  // Lagarde 2013: ((1 - gloss) - 0.5) / 0.4
  return material.ripple.w < 0.0 ? by_roughness : material.ripple.w;
}

#endif
