#pragma once
// Shadow maps of point and spot lights, kept while neither they nor the scene change.

#include <array>
#include <cstdint>
#include <vector>

#include "engine/gpu/objects.hpp"
#include "engine/gpu/shader.hpp"
#include "systems/frame.hpp"
#include "systems/lighting/lighting_shared.h"

namespace petrichor {

struct ShadowMaps {
  struct Tile {
    bool filled = false;
    glm::vec3 position_m{0.0f}, direction{0.0f};
    float outer_cone_rad = 0.0f, reach_m = 0.0f;
    int kind = 0;
    bool same_light(const Tile&) const;
  };
  std::array<Tile, MAXIMUM_SHADOWS> tiles;
  std::uint64_t geometry_version = 0;
  const GpuScene* scene = nullptr;
  std::vector<int> slots;        // per light of the frame: its tile, or -1. Of the last update
  std::uint64_t maps_drawn = 0;  // since start

  Texture face_depth;  // six layers
  std::array<Framebuffer, 6> faces;
  Texture tile;
};

struct ShadowPrograms {
  const Program& depth;    // faces
  const Program& moments;  // faces -> tile
  const Program& pack;     // tile -> atlas
};

// Brings the atlas (rgba32f, SHADOW_TILES_PER_SIDE * SHADOW_TILE square) up to date. fresh: its content is undefined.
// Each map is drawn in coordinates relative to its light, so that it is the same to the bit wherever the camera
// stood when it was drawn.
void update_shadow_maps(ShadowMaps&, const Frame&, const Texture& atlas, bool fresh, const ShadowPrograms&);

}  // namespace petrichor
