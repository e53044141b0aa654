#pragma once
// Marked objects of a frame as the GPU needs them: where they are, which lamps light them, which of their edges are
// outline.

#include <glm/glm.hpp>
#include <memory>
#include <unordered_map>
#include <vector>

#include "engine/gpu/objects.hpp"
#include "systems/frame.hpp"
#include "systems/splatter/shape.hpp"
#include "systems/splatter/splatter_shared.h"
#include "systems/splatter_frame.hpp"

namespace petrichor {

// What is kept of a marked mesh.
struct KeptShape {
  std::shared_ptr<const Mesh> mesh;  // so that its address stays its own
  CatcherShape shape;
  Texture heights;           // made by who draws
  Buffer vertices, indices;  // of shells as printed
  VertexArray array;
};
using ShapeStore = std::unordered_map<const Mesh*, KeptShape>;
KeptShape& kept_shape(ShapeStore&, const std::shared_ptr<const Mesh>&);

struct PlacedCatcher {
  const Catcher* catcher;
  KeptShape* kept;
  glm::mat4 relative_from_object;
  CatcherGpu gpu;
  glm::vec3 scale;
  glm::ivec2 first_pixel, last_pixel;  // of the picture that its box, with the mist over it, may touch
  float distance_m;                    // of the nearest place of that box
};

// Whether place_catchers could find any: a catcher's box, widened by margin_m, in the frustum, and its feature at least a
// hundredth of a pixel tall.
bool any_catcher_in_view(ShapeStore&, const Frame&, float feature_m, float margin_m);

// Those in view whose feature of so many metres is at least so many pixels tall, nearest first, at most `most`. lamps:
// how many each gets. margin_m: how far the effect reaches over the box.
std::vector<PlacedCatcher> place_catchers(ShapeStore&, const Frame&, int width, int height, float feature_m,
                                          float least_px, float margin_m, int lamps, std::size_t most);

// Length of the slots of time in which impacts are strewn; no crown lives longer.
constexpr double slot_s = 0.035;
// A thing's share of the rings' light: 1 x what its mean impact throws up, in cross-sections of its drop.
float thrown_sections(const SplashMist&);

// Share of the outline that lies on an edge whose faces look so (cosines to the eye): 1 where the outline is sharp.
// Over a row of edges from a face that looks here to one that looks away the shares sum to 1 at any width of the
// change; so a fin gives way to the next instead of popping (width 0: as printed).
float outline_share(float cosine_a, float cosine_b, float width);

// Quads on the outline. Depths are along the rays past the ends, through a layer of the catcher's mist.
void append_fins(const PlacedCatcher&, const Frame&, int steps, std::vector<FinGpu>&);

}  // namespace petrichor
