#pragma once
// Letters: painted ones through FreeType with packaged fonts, and neon ones as bent glass tubes.

#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "content/city/canvas.hpp"

namespace petrichor::city {

enum class Font { serif, sans, script, condensed };

struct TextBox {
  int x, y, width, height;  // the text is centred and scaled down until it fits
};

// Blends `colour` (linear) over the picture where the text is. Missing fonts fall back to DejaVu (Debian's
// fonts-dejavu-core); without any font nothing is drawn and false comes back.
bool draw_text(Picture&, Font, const std::string& utf8, TextBox, glm::vec3 colour, int largest_px);

// Single-stroke capitals of a neon maker: polylines in a cell 1 high, y up; advance is the cell's width.
struct NeonGlyph {
  std::vector<std::vector<glm::vec2>> strokes;
  float advance = 0.7f;
};
NeonGlyph neon_glyph(char capital);
float neon_width(const std::string& capitals, float spacing);

}  // namespace petrichor::city
