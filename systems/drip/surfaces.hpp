#pragma once
// What drips land on: the scene's triangles (Embree), and the landings of whole edges, remembered.

#include <cstdint>
#include <glm/glm.hpp>
#include <map>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "engine/assets/model.hpp"

namespace petrichor {

struct DripSourceMotion;
struct DripPose;

struct DripObstacle {
  const Mesh* mesh;
  glm::mat4 matrix;  // object -> world
};

constexpr double longest_fall_m = 80.0;

class DripSurfaces {
 public:
  explicit DripSurfaces(std::span<const DripObstacle>);
  ~DripSurfaces();
  DripSurfaces(const DripSurfaces&) = delete;
  DripSurfaces& operator=(const DripSurfaces&) = delete;

  // Metres below each site at which its drops land, in wind of about that velocity (its cell of 0.5 m/s);
  // longest_fall_m where there is nothing. A pure function of its arguments that is remembered; valid until
  // forget().
  const std::vector<float>& falls(const DripSourceMotion&, const DripPose&, const glm::dvec3& wind_mps);
  static glm::ivec3 cell_of(const DripSourceMotion&, const glm::dvec3& wind_mps);
  void forget();  // where more is remembered than is needed

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, int, int>;  // life, edge, pose, cell of wind
  std::map<Key, std::vector<float>> known_;
};

}  // namespace petrichor
