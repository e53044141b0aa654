#pragma once
// The page of the Lua functions in docs/, made from the list that binds them.

#include <string>

namespace petrichor {

// Markdown under a first-level heading; the components follow from schema_reference (engine/ecs).
std::string script_reference();

}  // namespace petrichor
