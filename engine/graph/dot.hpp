#pragma once
#include <string>

#include "engine/graph/plan.hpp"

namespace petrichor {

// Graphviz: passes as boxes, resources as ellipses, arrows the way the data goes. Passes that do not run are grey and
// dashed and say why; dashed arrows are last frame's content.
std::string write_dot(const Table&, const Plan&);

}  // namespace petrichor
