#pragma once
#include <cstdint>
#include <glm/glm.hpp>

namespace petrichor {

enum class LightKind { point, spot, directional };

// KHR_lights_punctual: candela for point and spot, lux for directional; shines along the entity's -z.
struct Light {
  LightKind kind = LightKind::point;
  glm::vec3 colour{1.0f};
  float intensity_cd = 100.0f;
  float range_m = 0.0f;         // 0: endless by definition, cut where it no longer matters
  float inner_cone_deg = 0.0f;  // half angles
  float outer_cone_deg = 45.0f;
  float source_radius_m = 0.08f;  // softens shadows and highlights
  bool casts_shadow = false;
  bool lights_rain = true;
};

// Directs strokes of lightning; brought to life by later work.
struct LightningDirector {
  float flashes_per_minute = 0.0f;
  float distance_m = 1500.0f;
  std::uint32_t seed = 1;
};

}  // namespace petrichor
