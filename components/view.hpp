#pragma once
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace petrichor {

// Looks along the entity's -z. exposure_s is the shutter time that streaks are integrated over; the
// picture's brightness is set by exposure_ev100 alone, so that the two can be studied apart.
struct Camera {
  float vertical_fov_deg = 60.0f;
  float near_m = 0.05f;
  float exposure_s = 1.0f / 60.0f;
  float exposure_ev100 = 3.0f;
  float bloom = 0.06f;  // share of the light that the lens scatters
  bool active = true;
};

// Where the camera was at the last two ticks: kept by systems/geometry for interpolation and motion streaks.
// Not for scripts.
struct CameraMotion {
  glm::vec3 previous_position_m{0.0f};
  glm::quat previous_orientation{1.0f, 0.0f, 0.0f, 0.0f};
  glm::vec3 position_m{0.0f};
  glm::quat orientation{1.0f, 0.0f, 0.0f, 0.0f};
  bool moving_known = false;  // false on the first tick and after a jump: no velocity then
};

// One primitive set of a loaded model: which model, and which of its meshes.
struct MeshInstance {
  std::uint32_t model = 0;
  std::uint32_t mesh = 0;
  bool casts_shadow = true;
};

// The person in the sandbox.
struct Walker {
  float eye_height_m = 1.7f;
  float radius_m = 0.3f;
  float walk_mps = 1.5f;
  float run_mps = 4.5f;
  float fly_mps = 10.0f;
  bool flying = false;
  bool on_ground = false;
  glm::vec3 velocity_mps{0.0f};
  float yaw_deg = 0.0f;
  float pitch_deg = 0.0f;
};

}  // namespace petrichor
