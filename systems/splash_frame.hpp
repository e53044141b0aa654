#pragma once
// The splashes of one frame. Filled by systems/splash.

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

namespace petrichor {

// A patch of a surface that shines by itself and is no light of the scene: a window, a shop front, a neon tube.
struct SplashGlow {
  glm::vec3 place_m;    // world
  glm::vec3 normal;     // unit; 0: it shines to all sides
  glm::vec3 intensity;  // cd head on: radiance times area
};

struct FrameSplashes {
  float reach_m = 20.0f;               // single splashes out to here
  float secondary_reach_m = 3.0f;      // with their droplets out to here
  std::int32_t most_splashes = 20000;  // alive at once, on average; beyond it the less important are left out
  bool published = false;              // of SplashRung::random: as printed
  // The artist's (section 3.3: size and transparency at random; 3.2: e_s and e_b of the opacity).
  float size = 1.0f, size_variation = 0.25f;
  float opacity = 1.0f, opacity_variation = 0.3f;
  float edge_strength = 0.8f, edge_bias = 0.55f;
  float backlight = 1.0f;  // multiplies the light of lamps behind a splash; 1 is true
  std::vector<SplashGlow> glows;
};

}  // namespace petrichor
