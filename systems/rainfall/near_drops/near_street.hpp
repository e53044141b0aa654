#pragma once
// A street of boxes that shine evenly, as a scene for the GPU and as a function for the CPU: what charts and tests of
// near drops stand in, so that the truth can be traced in the same world.

#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "engine/assets/model.hpp"
#include "systems/frame.hpp"
#include "systems/rainfall/near_drops/near.hpp"

namespace petrichor {

struct GpuScene;

struct StreetBox {
  glm::vec3 low_m, high_m;
  glm::vec3 light_cd_m2;  // at most 30, or a capture cuts it
};

struct NearStreet {
  std::vector<StreetBox> boxes;
  FrameSky sky;
};

// Ground, two rows of houses 4 m to either side with lit windows, a shop across the end, lamps without posts.
NearStreet make_near_street();
Model street_model(const NearStreet&);
// A box a mesh: adds the model and its instances to the frame.
void enter_street(const NearStreet&, GpuScene&, Frame&);
World street_world(const NearStreet&);

}  // namespace petrichor
