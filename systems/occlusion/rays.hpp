#pragma once
// The truth of shelter: rays (Embree) through a scene's triangles, whatever their material.

#include <glm/glm.hpp>
#include <memory>
#include <span>

#include "engine/assets/model.hpp"
#include "systems/frame.hpp"

namespace petrichor {

class ShelterRays {
 public:
  // The instances' models by their index; matrices as they are now.
  ShelterRays(std::span<const Model* const> models, std::span<const FrameInstance> instances);
  ~ShelterRays();
  ShelterRays(const ShelterRays&) = delete;
  ShelterRays& operator=(const ShelterRays&) = delete;

  // Metres from a place in the world along a unit way to the first surface; infinity where there is none.
  float distance_m(const glm::vec3& from_m, const glm::vec3& way) const;
  // Whether anything stands between a place and the sky, against the way that something falls. 1 mm off the place, so
  // that what it lies on does not count.
  bool sheltered(const glm::vec3& place_m, const glm::vec3& velocity_mps) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace petrichor
