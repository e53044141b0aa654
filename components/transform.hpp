#pragma once
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <string>

#include "engine/ecs/entity.hpp"

namespace petrichor {

struct Name {
  std::string text;
};

// Placement relative to the Parent, or to the world without one. Right-handed, y up, metres (glTF).
struct Transform {
  glm::vec3 position_m{0.0f};
  glm::quat orientation{1.0f, 0.0f, 0.0f, 0.0f};
  glm::vec3 scale{1.0f};
};

struct Parent {
  Entity entity;
};

// Written by the propagate phase from Transform and Parent; everybody else only reads it.
struct WorldTransform {
  glm::mat4 matrix{1.0f};
};

}  // namespace petrichor
