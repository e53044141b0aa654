#pragma once
// Signs of bent glass tube.

#include <string>

#include "content/city/builder.hpp"

namespace petrichor::city {

// Letters on one line in the plane z = 0 of the builder, bottom left at (x, y); returns the width.
float neon_text(Builder&, Glow, const std::string& capitals, float x, float y, float height_m, float tube_m = 0.016f,
                float spacing = 0.06f);
// The same, letters stacked downwards from (x, y), each centred on x.
void neon_column(Builder&, Glow, const std::string& capitals, float x, float y, float height_m, float step_m,
                 float tube_m = 0.016f);
void neon_line(Builder&, Glow, std::span<const glm::vec3> path, float tube_m = 0.014f, bool closed = false);

}  // namespace petrichor::city
