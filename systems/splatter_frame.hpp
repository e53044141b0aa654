#pragma once
// What splatters and mists: marked instances of one frame. Filled by systems/splatter.

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

namespace petrichor {

struct Mesh;  // engine/assets/model.hpp

// The cloud of droplets that splashes throw up over a square metre of level ground in the open, and its crowns.
struct SplashMist {
  float extinction_per_m = 0.0f;  // geometric, at the surface; it falls as exp(-height / height_m)
  float height_m = 0.0f;          // mean height of the droplets' cross-section
  float droplet_mm = 0.0f;        // mean diameter, by cross-section
  float speed_mps = 0.0f;         // mean vertical speed, up or down, by cross-section
  float crowns_per_m2_s = 0.0f;   // impacts that splash rather than spread
  float crown_mm = 0.0f;          // diameter of the drops that make them, their mean
  float crown_speed_mps = 0.0f;   // at which they strike
  float column() const { return extinction_per_m * height_m; }
};

struct Catcher {
  std::uint32_t instance;            // in Frame::instances
  std::shared_ptr<const Mesh> mesh;  // shape, in its model
  std::uint32_t key;                 // of its random numbers: the entity's
  float splatter, halo, halo_height;
  std::int32_t shells;
  float shell_height_m;
  bool published;
};

struct FrameSplatter {
  std::vector<Catcher> catchers;
  SplashMist mist;
};

}  // namespace petrichor
