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
  // Row z, column x: y of the upper surface, m; how much of the cell it covers, 0 or 1; and what mist stands over it, of
  // a level one's (thrown_up).
  std::vector<glm::vec3> heights;
  struct Patch {
    glm::vec3 middle, normal;
    float level_m2;  // seen from above, times thrown_up
  };
  std::vector<Patch> upper;  // what rain strikes, for sums over it
};

CatcherShape make_shape(const Mesh&);

// Column of mist over a slope, of that over level ground: drops strike it aslant, so fewer splash, and throw up less.
// Fitted to the flights of droplets from slopes at 50 mm/h (systems/splatter/mist.hpp) within 0.05.
inline float thrown_up(float normal_y) { return glm::clamp(1.25f * (normal_y - 0.2f), 0.0f, 1.0f); }

// Object space, scaled to metres (rotations alone lie between this and the world).
struct ScaledShape {
  const CatcherShape* shape;
  glm::vec3 scale;
};

// Height of the upper surface, cover, and cover by mist, bilinear, as the GPU reads them.
glm::vec3 surface_at(const ScaledShape&, float x_m, float z_m);

// Optical depth along eye + s way, s in [0, reach], through a layer of density extinction exp(-height / height_m) above
// the upper surface: piecewise in closed form, heights and cover linear in between. The ray ends inside the shape.
float layer_depth(const ScaledShape&, const glm::vec3& eye_m, const glm::vec3& way, float reach_m,
                  float extinction_per_m, float height_m, int steps = 24);

}  // namespace petrichor
