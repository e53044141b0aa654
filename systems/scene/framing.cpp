#include "systems/scene/framing.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

namespace petrichor {

FramingCamera framing_camera(const Model& model, float aspect) {
  constexpr double yaw_deg = 35.0, pitch_deg = 20.0, fov_deg = 45.0, margin = 1.06;
  glm::vec3 low(-1.0f), high(1.0f);
  model_bounds(model, low, high);
  const glm::dvec3 centre = (glm::dvec3(low) + glm::dvec3(high)) * 0.5;
  const glm::dvec3 half = glm::max((glm::dvec3(high) - glm::dvec3(low)) * 0.5, glm::dvec3(0.0));

  const double yaw = glm::radians(yaw_deg), pitch = glm::radians(pitch_deg);
  const glm::dvec3 back(std::sin(yaw) * std::cos(pitch), std::sin(pitch), std::cos(yaw) * std::cos(pitch));
  const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), back));
  const glm::dvec3 up = glm::cross(back, right);

  // A corner (x, y, z) along right, up and back is in the picture if |x| and |y| are at most (distance - z)
  // times the tangents of the half angles.
  const double tan_y = std::tan(glm::radians(fov_deg) * 0.5) / margin;
  const double tan_x = tan_y * std::clamp(static_cast<double>(aspect), 0.01, 100.0);
  double distance = 0.0, foremost = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::dvec3 p = half * glm::dvec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
    const double z = glm::dot(p, back);
    distance = std::max({distance, z + std::abs(glm::dot(p, right)) / tan_x, z + std::abs(glm::dot(p, up)) / tan_y});
    foremost = std::max(foremost, z);
  }
  // A single point has no size: a thousandth of its distance from the origin, or a metre at the origin.
  if (!(distance > 0.0)) distance = std::max(glm::length(centre) * 1e-3, 1.0);

  FramingCamera out;
  out.transform.position_m = centre + back * distance;
  out.transform.orientation = glm::quat(glm::quat_cast(glm::dmat3(right, up, back)));
  out.camera.vertical_fov_deg = static_cast<float>(fov_deg);
  // Rain falls in front of the model too, so near stays small where the model is far.
  out.camera.near_m = static_cast<float>(std::clamp((distance - foremost) * 0.25, 1e-5, 0.05));
  return out;
}

}  // namespace petrichor
