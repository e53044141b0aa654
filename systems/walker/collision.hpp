#pragma once
// The scene's triangles as Embree sees them, for a person who must not walk through walls.

#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "engine/assets/model.hpp"
#include "engine/ecs/registry.hpp"

namespace petrichor {

struct RayHit {
  float distance_m;
  glm::vec3 normal;  // unit, towards the ray's origin
};

class CollisionScene {
 public:
  // All mesh instances where they stand now (WorldTransform); nothing that moves later is followed.
  CollisionScene(Registry&, const std::vector<std::shared_ptr<const Model>>& models);
  ~CollisionScene();
  CollisionScene(const CollisionScene&) = delete;
  CollisionScene& operator=(const CollisionScene&) = delete;

  // The first surface along the unit direction within the reach.
  std::optional<RayHit> cast(const glm::vec3& origin_m, const glm::vec3& direction, float reach_m) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace petrichor
