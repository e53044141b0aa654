#pragma once
// Streaks of near drops against traced ones, for charts and tests.

#include <glm/glm.hpp>
#include <vector>

#include "systems/frame.hpp"
#include "systems/rainfall/near_drops/near.hpp"
#include "systems/rainfall/near_drops/passes.hpp"

namespace petrichor {

// The means of a listed drop's columns, traced: as many as the drop has, left to right.
std::vector<glm::dvec3> traced_columns(const World&, const Frame&, const NearDropGpu&, int interactions = 6);

// The colour that the field gives all of such a drop (ambient.glsl: a lobe about the ray, and a little of all round).
glm::dvec3 field_colour(const World&, const Frame&, const NearDropGpu&);

struct NearComparison {
  double error = 0.0;  // root mean square over columns, by their width and the drops' images
  double off = 0.0;    // the same of one colour a drop
  double mean = 0.0, true_mean = 0.0;
  int drops = 0;
};
// At most so many drops, spread over the list by their place, which does not depend on the list's order.
NearComparison compare_columns(const World&, const Frame&, const NearListed&, int most_drops);

}  // namespace petrichor
