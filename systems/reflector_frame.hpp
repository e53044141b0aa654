#pragma once
// What wet ground mirrors, as simple stand-ins: lit panels (windows, signs, neon) and dark posts. Filled by
// systems/reflection. Lamps are not among them: they are the frame's lights.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace petrichor {

enum class ReflectorKind : std::uint8_t {
  panel,    // a rectangle that shines to the side of cross(half_across, half_up)
  lantern,  // shines to all sides: a rectangle that turns to whoever looks
  post,     // dark and upright; turns about its axis
};

struct Reflector {
  ReflectorKind kind = ReflectorKind::panel;
  glm::vec3 centre_m{0.0f};  // world
  glm::vec3 half_across{0.0f};
  glm::vec3 half_up{0.0f};
  glm::vec3 radiance{0.0f};  // cd/m2, mean over the rectangle; of a post its base colour
};

struct FrameReflectors {
  std::vector<Reflector> all;
};

}  // namespace petrichor
