#include "content/city/lettering.hpp"

#include <ft2build.h>
#include FT_FREETYPE_H

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

namespace petrichor::city {
namespace {

const std::vector<std::string>& font_files(Font font) {
  static const std::string root = "/usr/share/fonts/truetype/";
  static const std::array<std::vector<std::string>, 4> files{{
      {root + "dejavu/DejaVuSerif-Bold.ttf"},
      {root + "dejavu/DejaVuSans-Bold.ttf"},
      {"/usr/share/fonts/opentype/lobster/lobster.otf", root + "dejavu/DejaVuSerif-Bold.ttf"},
      {root + "dejavu/DejaVuSansCondensed-Bold.ttf", root + "dejavu/DejaVuSans-Bold.ttf"},
  }};
  return files[static_cast<std::size_t>(font)];
}

struct Library {
  FT_Library handle = nullptr;
  Library() { FT_Init_FreeType(&handle); }
  ~Library() { FT_Done_FreeType(handle); }
};

FT_Face face_of(Font font) {
  static Library library;
  static std::array<FT_Face, 4> faces{};
  FT_Face& face = faces[static_cast<std::size_t>(font)];
  if (face) return face;
  for (const std::string& file : font_files(font)) {
    if (FT_New_Face(library.handle, file.c_str(), 0, &face) == 0) return face;
    face = nullptr;
  }
  return nullptr;
}

std::vector<char32_t> code_points(const std::string& utf8) {
  std::vector<char32_t> out;
  for (std::size_t i = 0; i < utf8.size();) {
    const auto c = static_cast<unsigned char>(utf8[i]);
    const int extra = c < 0x80 ? 0 : c < 0xe0 ? 1 : c < 0xf0 ? 2 : 3;
    char32_t code = extra == 0 ? c : c & (0x3fu >> extra);
    for (int k = 1; k <= extra && i + static_cast<std::size_t>(k) < utf8.size(); ++k) {
      code = (code << 6) | (static_cast<unsigned char>(utf8[i + static_cast<std::size_t>(k)]) & 0x3fu);
    }
    out.push_back(code);
    i += static_cast<std::size_t>(extra) + 1;
  }
  return out;
}

int text_width(FT_Face face, const std::vector<char32_t>& text) {
  long width = 0;
  for (char32_t code : text) {
    if (FT_Load_Char(face, code, FT_LOAD_DEFAULT) == 0) width += face->glyph->advance.x >> 6;
  }
  return static_cast<int>(width);
}

using Stroke = std::vector<glm::vec2>;

Stroke arc(glm::vec2 centre, glm::vec2 radius, float from_deg, float to_deg) {
  Stroke out;
  const int steps = std::max(4, static_cast<int>(std::abs(to_deg - from_deg) / 24.0f));
  for (int k = 0; k <= steps; ++k) {
    const float t = (from_deg + (to_deg - from_deg) * static_cast<float>(k) / static_cast<float>(steps)) * 0.01745329f;
    out.push_back(centre + radius * glm::vec2(std::cos(t), std::sin(t)));
  }
  return out;
}

Stroke join(std::initializer_list<Stroke> parts) {
  Stroke out;
  for (const Stroke& part : parts) {
    for (const glm::vec2& p : part) {
      if (out.empty() || glm::length(out.back() - p) > 0.02f) out.push_back(p);
    }
  }
  return out;
}

}  // namespace

bool draw_text(Picture& picture, Font font, const std::string& utf8, TextBox box, glm::vec3 colour, int largest_px) {
  FT_Face face = face_of(font);
  if (!face) return false;
  const std::vector<char32_t> text = code_points(utf8);
  int pixels = std::min(largest_px, box.height);
  for (; pixels > 6; --pixels) {
    FT_Set_Pixel_Sizes(face, 0, static_cast<FT_UInt>(pixels));
    if (text_width(face, text) <= box.width) break;
  }
  int pen = box.x + (box.width - text_width(face, text)) / 2;
  const int base = box.y + box.height / 2 + static_cast<int>(0.36f * static_cast<float>(pixels));
  for (char32_t code : text) {
    if (FT_Load_Char(face, code, FT_LOAD_RENDER) != 0) continue;
    const FT_Bitmap& bitmap = face->glyph->bitmap;
    for (unsigned y = 0; y < bitmap.rows; ++y) {
      for (unsigned x = 0; x < bitmap.width; ++x) {
        const int px = pen + face->glyph->bitmap_left + static_cast<int>(x);
        const int py = base - face->glyph->bitmap_top + static_cast<int>(y);
        if (px < 0 || py < 0 || px >= picture.width || py >= picture.height) continue;
        const float a = static_cast<float>(bitmap.buffer[y * static_cast<unsigned>(bitmap.pitch) + x]) / 255.0f;
        std::uint8_t* out = picture.at(px, py);
        for (int c = 0; c < 3; ++c) {
          out[c] = to_byte((1.0f - a) * static_cast<float>(out[c]) / 255.0f + a * to_srgb(colour[c]));
        }
      }
    }
    pen += static_cast<int>(face->glyph->advance.x >> 6);
  }
  return true;
}

NeonGlyph neon_glyph(char c) {
  const float w = 0.56f;
  const float m = 0.5f * w;
  switch (c) {
    case 'A':
      return {{{{0, 0}, {m, 1}, {w, 0}}, {{0.1f, 0.36f}, {w - 0.1f, 0.36f}}}, w + 0.16f};
    case 'B':
      return {{join({{{0, 0}, {0, 1}}, arc({0.25f, 0.76f}, {0.24f, 0.24f}, 90, -90), {{0.04f, 0.52f}}}),
               join({{{0.04f, 0.48f}}, arc({0.27f, 0.25f}, {0.27f, 0.25f}, 90, -90), {{0, 0}}})},
              w + 0.14f};
    case 'C':
      return {{arc({m + 0.04f, 0.5f}, {m + 0.04f, 0.5f}, 50, 310)}, w + 0.14f};
    case 'D':
      return {{join({{{0, 0}, {0, 1}}, arc({0.16f, 0.5f}, {0.4f, 0.5f}, 90, -90), {{0, 0}}})}, w + 0.16f};
    case 'E':
      return {{{{0.46f, 1}, {0, 1}, {0, 0}, {0.46f, 0}}, {{0.03f, 0.52f}, {0.38f, 0.52f}}}, 0.6f};
    case 'F':
      return {{{{0.46f, 1}, {0, 1}, {0, 0}}, {{0.03f, 0.52f}, {0.38f, 0.52f}}}, 0.58f};
    case 'H':
      return {{{{0, 0}, {0, 1}}, {{w, 0}, {w, 1}}, {{0.03f, 0.52f}, {w - 0.03f, 0.52f}}}, w + 0.18f};
    case 'I':
      return {{{{0, 0}, {0, 1}}}, 0.2f};
    case 'K':
      return {{{{0, 0}, {0, 1}}, {{0.5f, 1}, {0.04f, 0.45f}, {0.54f, 0}}}, 0.68f};
    case 'L':
      return {{{{0, 1}, {0, 0}, {0.44f, 0}}}, 0.58f};
    case 'M':
      return {{{{0, 0}, {0.04f, 1}, {0.34f, 0.3f}, {0.64f, 1}, {0.68f, 0}}}, 0.84f};
    case 'N':
      return {{{{0, 0}, {0, 1}, {w, 0}, {w, 1}}}, w + 0.18f};
    case 'O':
      return {{arc({0.34f, 0.5f}, {0.34f, 0.5f}, 90, 440)}, 0.84f};
    case 'P':
      return {{join({{{0, 0}, {0, 1}}, arc({0.24f, 0.73f}, {0.27f, 0.27f}, 90, -90), {{0.04f, 0.46f}}})}, 0.62f};
    case 'R':
      return {{join({{{0, 0}, {0, 1}}, arc({0.24f, 0.74f}, {0.26f, 0.26f}, 90, -90), {{0.06f, 0.48f}}}),
               {{0.26f, 0.46f}, {0.52f, 0}}},
              0.66f};
    case 'S':
      return {{join({arc({0.26f, 0.745f}, {0.25f, 0.255f}, 30, 270), arc({0.26f, 0.245f}, {0.26f, 0.245f}, 90, -150)})},
              0.66f};
    case 'T':
      return {{{{0, 1}, {w, 1}}, {{m, 0.97f}, {m, 0}}}, w + 0.1f};
    case 'U':
      return {{join({{{0, 1}}, arc({m, 0.28f}, {m, 0.28f}, 180, 360), {{w, 1}}})}, w + 0.18f};
    case 'V':
      return {{{{0, 1}, {m, 0}, {w, 1}}}, w + 0.12f};
    case 'W':
      return {{{{0, 1}, {0.2f, 0}, {0.38f, 0.75f}, {0.56f, 0}, {0.76f, 1}}}, 0.9f};
    case 'Y':
      return {{{{0, 1}, {m, 0.48f}, {w, 1}}, {{m, 0.45f}, {m, 0}}}, w + 0.1f};
    default:
      return {{}, 0.4f};
  }
}

float neon_width(const std::string& capitals, float spacing) {
  float width = 0.0f;
  for (char c : capitals) width += neon_glyph(c).advance + spacing;
  return width - spacing;
}

}  // namespace petrichor::city
