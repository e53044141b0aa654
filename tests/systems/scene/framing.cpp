#include "systems/scene/framing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace petrichor {
namespace {

Model box(glm::vec3 low, glm::vec3 high) {
  Model model;
  Primitive p;
  p.vertices.resize(3);
  p.indices = {0, 1, 2};
  p.bounds_min_m = low;
  p.bounds_max_m = high;
  model.meshes.push_back(Mesh{"box", {p}});
  Node node;
  node.mesh = 0;
  model.nodes.push_back(node);
  return model;
}

// Where the corners of the box land in a picture: |x| and |y| at most 1 inside, and the least distance along
// the line of sight.
struct Shown {
  float largest = 0.0f;
  float nearest_m = 1e30f;
};

Shown show(const FramingCamera& framing, glm::vec3 low, glm::vec3 high, float aspect) {
  Shown out;
  const float tan_y = std::tan(glm::radians(framing.camera.vertical_fov_deg) / 2);
  for (int k = 0; k < 8; ++k) {
    const glm::vec3 corner(k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z);
    const glm::vec3 eye = glm::inverse(framing.transform.orientation) * (corner - framing.transform.position_m);
    out.nearest_m = std::min(out.nearest_m, -eye.z);
    out.largest = std::max({out.largest, std::abs(eye.x / eye.z) / (tan_y * aspect), std::abs(eye.y / eye.z) / tan_y});
  }
  return out;
}

TEST(Framing, FillsThePictureWithWhateverSize) {
  struct Case {
    glm::vec3 low, high;
  };
  for (const Case& c : {Case{{-1, 0, -1}, {1, 2, 1}}, Case{{0, 0, 0}, {0.001f, 0.001f, 0.001f}},
                        Case{{-5000, 0, -5000}, {5000, 300, 5000}}, Case{{-5, 0, -5}, {5, 0, 5}},
                        Case{{0, 0, 0}, {0, 3, 0}}, Case{{1000, 50, -2000}, {1001, 51, -1999}}}) {
    for (float aspect : {16.0f / 9.0f, 1.0f, 0.5f}) {
      const FramingCamera framing = framing_camera(box(c.low, c.high), aspect);
      const Shown shown = show(framing, c.low, c.high, aspect);
      SCOPED_TRACE(testing::Message() << "size " << glm::length(c.high - c.low) << " m, aspect " << aspect);
      EXPECT_GT(shown.nearest_m, framing.camera.near_m) << "nothing is cut off";
      EXPECT_LE(shown.largest, 1.0f);
      EXPECT_GE(shown.largest, 0.85f);
      EXPECT_GT(framing.transform.position_m.y, (c.low.y + c.high.y) / 2) << "from above";
      EXPECT_TRUE(framing.camera.active);
    }
  }
}

TEST(Framing, NothingAndAPoint) {
  for (const Model& model : {Model{}, box({0, 0, 0}, {0, 0, 0}), box({7, 7, 7}, {7, 7, 7})}) {
    const FramingCamera framing = framing_camera(model);
    for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::isfinite(framing.transform.position_m[c]));
    EXPECT_NEAR(glm::length(framing.transform.orientation), 1.0f, 1e-5f);
    EXPECT_GT(framing.camera.near_m, 0.0f);
  }
  // It looks at the origin.
  const FramingCamera empty = framing_camera(Model{});
  const glm::vec3 forward = empty.transform.orientation * glm::vec3(0, 0, -1);
  EXPECT_LT(glm::length(glm::cross(forward, glm::normalize(-empty.transform.position_m))), 1e-4f);
}

}  // namespace
}  // namespace petrichor
