#pragma once
// The layered composite (Tatarchuk and Isidoro 2006, section 3.1), as the frame sees it. Filled by
// systems/rainfall/layered. The defaults stand for calm rain before a still camera.

#include <array>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace petrichor {

// Shell i holds the rain from edge[i] to edge[i + 1] metres from the eye; what is nearer than the first is evenly
// spread. From the second on they are whole slices of the volume of lamplight (systems/rainfall/light_volume.glsl).
constexpr int layered_shells = 4;
constexpr std::array<float, layered_shells + 1> layered_edges_m{0.3f, 1.1225f, 2.5198f, 5.6569f, 19.0273f};

struct FrameLayered {
  bool published = false;  // as printed: glued to the screen, before everything, and its steps times the time so far
  // Turns (0, -1, 0) to the way the rain moves past the camera; carried along, so that the patterns do not spin.
  glm::quat turn{1.0f, 0.0f, 0.0f, 0.0f};
  float speed_mps = 6.5f;    // of the rain past the camera, along that way
  double travelled_m = 0.0;  // along it so far, wrapped at layered_wrap_m
  float strength = 1.0f, milk = 0.0f;
  float lightning = 0.0f;  // k_c (L_1 + L_2)
  float far_m = layered_edges_m[layered_shells];
  // Of the published setting: the artist's v_r, m/s in the world; p_r; and the time that its steps are multiplied with.
  glm::vec3 direction_mps{0.0f, -6.5f, 0.0f};
  float parallax = 1.0f;
  double time_s = 0.0;
};

}  // namespace petrichor
