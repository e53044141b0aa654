#pragma once
#include <glm/glm.hpp>

namespace petrichor {

// An object that moves and shines, say a car: it mirrors its own surroundings, not the camera's (technique
// probes=moving). On the entity that holds the object's meshes, or above them.
struct ReflectionProbe {
  glm::vec3 centre_m{0.0f, 0.8f, 0.0f};  // of the object, along the entity's axes
  float radius_m = 3.0f;                 // surfaces within it mirror what is round the centre
};

}  // namespace petrichor
