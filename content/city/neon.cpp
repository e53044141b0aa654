#include "content/city/neon.hpp"

#include "content/city/lettering.hpp"

namespace petrichor::city {
namespace {

constexpr float stand_off_m = 0.06f;  // the glass floats on posts before the wall

void glyph(Builder& b, Glow colour, const NeonGlyph& g, float x, float y, float height_m, float tube_m) {
  for (const std::vector<glm::vec2>& stroke : g.strokes) {
    std::vector<glm::vec3> path;
    for (const glm::vec2& p : stroke) path.emplace_back(x + p.x * height_m, y + p.y * height_m, stand_off_m);
    b.tube(glow(colour), path, tube_m, 4);
    // The electrode ends turn back into the wall.
    for (const glm::vec3& end : {path.front(), path.back()}) {
      b.cylinder(plain(glm::vec3(0.03f), Finish::rubber), {end.x, end.y, 0.0f}, {end.x, end.y, stand_off_m},
                 tube_m * 0.8f, tube_m * 0.8f, 3);
    }
  }
}

}  // namespace

float neon_text(Builder& b, Glow colour, const std::string& capitals, float x, float y, float height_m, float tube_m,
                float spacing) {
  float pen = x;
  for (char c : capitals) {
    const NeonGlyph g = neon_glyph(c);
    glyph(b, colour, g, pen, y, height_m, tube_m);
    pen += (g.advance + spacing) * height_m;
  }
  return pen - spacing * height_m - x;
}

void neon_column(Builder& b, Glow colour, const std::string& capitals, float x, float y, float height_m, float step_m,
                 float tube_m) {
  float pen = y;
  for (char c : capitals) {
    const NeonGlyph g = neon_glyph(c);
    float width = 0.0f;
    for (const auto& stroke : g.strokes) {
      for (const glm::vec2& p : stroke) width = std::max(width, p.x);
    }
    glyph(b, colour, g, x - 0.5f * width * height_m, pen - height_m, height_m, tube_m);
    pen -= step_m;
  }
}

void neon_line(Builder& b, Glow colour, std::span<const glm::vec3> path, float tube_m, bool closed) {
  b.tube(glow(colour), path, tube_m, 4, closed);
}

}  // namespace petrichor::city
