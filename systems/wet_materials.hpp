#pragma once
// How the materials of a model take water, from their glTF extras:
//
//   "extras": { "water": {
//     "hollow": "texcoord_1",        depth of hollows, 0 to 1: TEXCOORD_1.x, "vertex_colour" (its red, which then is
//                                    no tint) or "texture" (the red of "texture": {"index": 3, "texCoord": 0})
//     "maximum_depth_mm": 30,        depth where that is 1
//     "relief_mm": 14,               height of the relief in the red of the metallic-roughness texture: joints fill
//     "relief_mean": 0.5,            first, tops stay dry; the mean is what the mesh stands for
//     "porosity": 0.6,               0 to 1; without it, by the roughness of each texel (Lagarde 2013)
//     "tint": [0.8, 0.75, 0.6],      colour of white seen through 100 mm of the water that stands on it
//     "ripple_influence": 1,         p_i, 0 to 1: of the water's normal against the surface's own
//     "ripple_scale": 1,             s_o
//     "ripple_turn_deg": 0 } }       theta_o (Tatarchuk and Isidoro 2006, section 4)
//
// "water": false: it never gets wet. Without extras: wets, holds no water, porosity by roughness.

#include <cstdint>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/core/result.hpp"
#include "systems/wet_material_shared.h"

namespace petrichor {

enum class Hollow : std::uint8_t { none, texcoord_1, vertex_colour, texture };

struct MaterialWater {
  bool wets = true;
  Hollow hollow = Hollow::none;
  float relief = 0.0f;  // of the deepest hollow
  float relief_mean = 0.5f;
  WetMaterialGpu gpu{{1.5f, 2.0f, 3.0f, 0.0f}, {1.0f, 1.0f, 0.0f, -1.0f}};  // slightly turbid street water
};

// One for each material of the model. The error names the file, the material and the field.
Result<std::vector<MaterialWater>> read_material_water(const Model&);

}  // namespace petrichor
