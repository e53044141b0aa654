#pragma once
// Rounded cars of a few shapes. Local frame: +z forward, x to the car's left, y up, ground at 0.

#include "content/city/builder.hpp"

namespace petrichor::city {

struct CarShape {
  float length_m = 3.9f;
  float half_width_m = 0.77f;
  float height_m = 1.43f;
  float bonnet_m = 0.86f;  // height at the foot of the windscreen
  float nose_m = 0.66f;    // height at the front edge
  float boot_m = 0.88f;    // height at the foot of the rear window
  float tail_m = 0.70f;
  float screen_foot = 0.19f;  // along the length from the middle, + forward, as a share of it
  float roof_front = 0.05f;
  float roof_back = -0.24f;
  float rear_foot = -0.39f;
};

enum class CarSign : std::uint8_t { none, taxi };

Mesh car_mesh(const std::string& name, const CarShape&, glm::vec3 paint, bool lights_on, CarSign);

}  // namespace petrichor::city
