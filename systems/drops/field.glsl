// The drop field: which drops a cell holds and where. The one definition that drawing and measuring share.
#ifndef SYSTEMS_DROPS_FIELD_GLSL
#define SYSTEMS_DROPS_FIELD_GLSL
#include "engine/core/random.glsl"
#include "systems/drops/rain_shared.h"

layout(std430, binding = RAIN_LAYERS_BINDING) readonly buffer RainLayers { RainLayerGpu layers[]; };
uniform uint layer_count;
uniform uint seed;

// The layer that candidate cell `index` belongs to.
uint find_layer(uint index) {
  uint low = 0u, high = layer_count - 1u;
  while (low < high) {
    uint middle = (low + high + 1u) / 2u;
    if (layers[middle].box.w <= index) low = middle; else high = middle - 1u;
  }
  return low;
}

uvec3 cell_in_box(RainLayerGpu layer, uint index) {
  uint i = index - layer.box.w;
  return uvec3(i % layer.box.x, i / layer.box.x % layer.box.y, i / (layer.box.x * layer.box.y));
}

// How many drops a cell holds now, and the key of their places. The count is the inverse of the Poisson
// distribution at one number that the cell keeps for ever, so that it grows with the rate drop by drop: drops
// that are there stay, and at any one rate the field is Poisson.
uint drops_of_cell(RainLayerGpu layer, uvec3 cell, out uvec3 key) {
  ivec3 place = layer.first_cell.xyz + ivec3(cell);
  uint salt = uint(layer.first_cell.w) ^ (seed * 0x9e3779b9u);
  uvec4 bits = random_bits4(uvec4(uint(place.x), uint(place.y), uint(place.z), salt));
  key = bits.yzw;
  return poisson_count(unit_float(bits.x), layer.expected.x, layer.expected.y, 255u);
}

// Place of drop m within its cell, in [0,1)^3, a mark in [0,1) and 32 more random bits.
vec4 drop_of_cell(uvec3 key, uint m, out uint bits) {
  uvec4 b = random_bits4(uvec4(key.xy, m, key.z));
  bits = b.w;
  return vec4(unit_float(b.x), unit_float(b.y), unit_float(b.z), float(((b.x & 255u) << 8u) | (b.y & 255u)) / 65536.0);
}

#endif
