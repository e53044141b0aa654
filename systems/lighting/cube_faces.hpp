#pragma once
// The six cameras of a cube, as octahedral.glsl reads their pictures: +x -x +y -y +z -z, right-handed.

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace petrichor {

struct CubeFace {
  glm::vec3 right, up, forward;
};

inline CubeFace cube_face(int face) {
  static constexpr glm::vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  switch (face) {
    case 0:
      return {z, y, x};
    case 1:
      return {-z, y, -x};
    case 2:
      return {x, z, y};
    case 3:
      return {-x, z, -y};
    case 4:
      return {-x, y, z};
    default:
      return {x, y, -z};
  }
}

inline glm::quat cube_face_orientation(int face) {
  const CubeFace f = cube_face(face);
  return glm::quat_cast(glm::mat3(f.right, f.up, -f.forward));
}

}  // namespace petrichor
