#pragma once
// The double cone (Wang and Wade 2004), as the frame sees it: for falling rain, and another for snow. Filled by
// systems/rainfall/cone. The defaults stand for calm rain before a still camera.

#include <array>
#include <glm/glm.hpp>

#include "components/techniques.hpp"

namespace petrichor {

// Layer i of the cone stands for the precipitation from edge[i] to edge[i + 1] metres from the eye. Each layer covers
// two slices of the volume of lamplight (systems/rainfall/light_volume.glsl), whose edges grow by 128^(1/12).
constexpr int cone_layers = 4;
constexpr std::array<float, cone_layers + 1> cone_edges_m{0.7492f, 1.6818f, 3.7755f, 8.4757f, 19.0273f};

struct FrameCone {
  bool published = false;  // as printed: lengths and scroll by frame time, no hand-over near the apex, no depth
  ConeTexture texture = ConeTexture::automatic;
  glm::vec3 axis{0.0f, -1.0f, 0.0f};       // unit, world: the way the precipitation moves past the camera
  glm::vec3 side{1.0f, 0.0f, 0.0f};        // unit, across the axis: where the textures begin
  float speed_mps = 6.5f;                  // along the axis
  float shear_rad_per_m = 0.0f;            // turn of the streaks about the axis, by the camera's own turning
  float apex_fade = 0.0f;                  // 1: nothing moves past the camera: even extinction instead of streaks
  std::array<float, cone_layers> phase{};  // of each layer's texture along the axis, wrapped to [0, 1)
  std::array<float, cone_layers> elongation{1.0f, 1.0f, 1.0f, 1.0f};  // streak length over that of the texture
  std::array<float, cone_layers> farther{1.0f, 1.0f, 1.0f, 1.0f};     // times as far as it is each layer looks
  float far_m = cone_edges_m[cone_layers];                            // the outermost layer stands for rain to here
};

}  // namespace petrichor
