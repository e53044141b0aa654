#pragma once
// The reference page of the components in docs/, made from the schemas alone.

#include <span>
#include <string>

#include "engine/ecs/schema.hpp"

namespace petrichor {

// Markdown under a first-level heading: per component its meaning and a table of its fields. Defaults are
// read from a freshly emplaced component.
std::string schema_reference(std::span<const Schema>);

// What a field takes, in words: "number", "[x, y, z]", "\"point\", \"spot\" or ...".
std::string field_type_words(const Field&);

// "0 to 300", "at least 0", or "" where any value will do.
std::string field_range_words(const Field&);

}  // namespace petrichor
