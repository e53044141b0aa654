#pragma once
// The shape of a marked mesh, made ready once: edges with both their faces for fins, welded normals for shells, and the
// heights that rain falls on, seen from above, for the layer of mist.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "engine/assets/model.hpp"

namespace petrichor {

struct CatcherEdge {
  std::uint32_t a, b;        // in positions
  glm::vec3 face_a, face_b;  // unit normals of the two faces; of an open edge (a sheet's) the other way round
};

constexpr int catcher_cells = 128;  // heights, along x and along z

struct CatcherShape {
  glm::vec3 low_m{0.0f}, high_m{0.0f};        // box, object space
  std::vector<glm::vec3> positions, normals;  // welded: one for each place, normals averaged over the faces there
  std::vector<std::uint32_t> indices;
  // Those that may lie on an outline that rain strikes: of the upper surface, sharp or open or curved.
  std::vector<CatcherEdge> edges;
  std::vector<glm::vec2> heights;  // row z, column x: y of the upper surface, m; how much of the cell it covers, 0 or 1
};

CatcherShape make_shape(const Mesh&);

// Object space, scaled to metres (rotations alone lie between this and the world).
struct ScaledShape {
  const CatcherShape* shape;
  glm::vec3 scale;
};

// Height of the upper surface, and cover, bilinear, as the GPU reads them.
glm::vec2 surface_at(const ScaledShape&, float x_m, float z_m);

// Optical depth along eye + s way, s in [0, reach], through a layer of density extinction exp(-height / height_m) above
// the upper surface: piecewise in closed form, heights and cover linear in between. The ray ends inside the shape.
float layer_depth(const ScaledShape&, const glm::vec3& eye_m, const glm::vec3& way, float reach_m,
                  float extinction_per_m, float height_m, int steps = 24);

}  // namespace petrichor
