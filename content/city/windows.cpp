#include <algorithm>
#include <array>
#include <cmath>

#include "content/city/atlases.hpp"
#include "content/city/facade.hpp"

namespace petrichor::city {
namespace {

const glm::vec3 railing_iron(0.025f);

// Only what can be seen from below: windows are most of the town's triangles.
void surround(Builder& b, const Paint& trim, float w, float h) {
  const float band = 0.13f;
  const float proud = 0.045f;
  b.box(trim, {-0.5f * w - band, 0.0f, 0.0f}, {-0.5f * w, h + band, proud}, face_front | face_sides);
  b.box(trim, {0.5f * w, 0.0f, 0.0f}, {0.5f * w + band, h + band, proud}, face_front | face_sides);
  b.box(trim, {-0.5f * w, h, 0.0f}, {0.5f * w, h + band, proud}, face_front | face_bottom);
}

void head_piece(Builder& b, const Paint& trim, Head head, float w, float h) {
  const float half = 0.5f * w + 0.2f;
  switch (head) {
    case Head::none:
      return;
    case Head::lintel: {
      b.box(trim, {-half, h + 0.002f, 0.0f}, {half, h + 0.26f, 0.05f}, face_no_back);
      // Keystone, wider at the top.
      const float z = 0.10f;
      b.quad(trim, {-0.09f, h, z}, {0.09f, h, z}, {0.14f, h + 0.34f, z}, {-0.14f, h + 0.34f, z});
      b.quad(trim, {0.09f, h, z}, {0.09f, h, 0}, {0.14f, h + 0.34f, 0}, {0.14f, h + 0.34f, z});
      b.quad(trim, {-0.09f, h, 0}, {-0.09f, h, z}, {-0.14f, h + 0.34f, z}, {-0.14f, h + 0.34f, 0});
      return;
    }
    case Head::hood: {
      const std::array<glm::vec2, 5> profile{
          {{0.0f, h + 0.18f}, {0.06f, h + 0.20f}, {0.16f, h + 0.27f}, {0.17f, h + 0.33f}, {0.0f, h + 0.37f}}};
      b.moulding(trim, profile, -half - 0.05f, half + 0.05f);
      for (float s : {-1.0f, 1.0f}) {  // consoles
        const float x = s * (half - 0.06f);
        b.box(trim, {x - 0.06f, h - 0.15f, 0.0f}, {x + 0.06f, h + 0.2f, 0.11f}, face_front | face_sides | face_bottom);
      }
      return;
    }
    case Head::pediment: {
      const std::array<glm::vec2, 4> profile{
          {{0.0f, h + 0.18f}, {0.14f, h + 0.22f}, {0.15f, h + 0.29f}, {0.0f, h + 0.30f}}};
      b.moulding(trim, profile, -half - 0.06f, half + 0.06f);
      const float rise = 0.20f * w + 0.12f;
      const float y = h + 0.29f;
      const float z = 0.14f;
      const float e = half + 0.06f;
      b.triangle(trim, {-e, y, 0.05f}, {e, y, 0.05f}, {0, y + rise, 0.05f});
      for (float s : {-1.0f, 1.0f}) {
        const glm::vec3 low(s * e, y, 0), top(0, y + rise, 0), up(0, 0.09f, 0), out(0, 0, z);
        if (s < 0) {
          b.quad(trim, low + out, top + out, top + out + up, low + out + up);
          b.quad(trim, low + up + out, top + up + out, top + up, low + up);
          b.quad(trim, low, top, top + out, low + out);
        } else {
          b.quad(trim, top + out, low + out, low + out + up, top + out + up);
          b.quad(trim, top + up + out, low + up + out, low + up, top + up);
          b.quad(trim, top, low, low + out, top + out);
        }
      }
      return;
    }
    case Head::arch: {  // a segmental arch of dressed stones over the opening
      const int stones = 7;
      const float rise = 0.16f * w;
      const float radius = (0.25f * w * w + rise * rise) / (2.0f * rise);
      const glm::vec2 centre(0.0f, h + rise - radius);
      const float spread = std::asin(0.5f * w / radius);
      for (int k = 0; k < stones; ++k) {
        const float t0 = -spread + 2.0f * spread * static_cast<float>(k) / stones;
        const float t1 = -spread + 2.0f * spread * static_cast<float>(k + 1) / stones;
        const float thick = k == stones / 2 ? 0.34f : 0.25f;
        const float z = k == stones / 2 ? 0.09f : 0.05f + 0.012f * static_cast<float>(k & 1);
        const auto on = [&](float r, float t) {
          return glm::vec3(centre.x + r * std::sin(t), centre.y + r * std::cos(t), z);
        };
        const glm::vec3 a = on(radius, t0), c = on(radius, t1), d = on(radius + thick, t1), e = on(radius + thick, t0);
        b.quad(trim, a, c, d, e);
        const glm::vec3 in(0, 0, -z);
        b.quad(trim, e, d, d + in, e + in);
        b.quad(trim, a + in, c + in, c, a);
      }
      return;
    }
  }
}

}  // namespace

void window(Builder& parent, const Style& style, float x, float y, float w, float h, Head head, bool shutters,
            Dice& dice) {
  Builder b = parent.moved({x, y, 0.0f});
  const float depth = 0.17f;
  const float l = -0.5f * w;
  const float r = 0.5f * w;
  const Paint trim = plain(style.trim, Finish::stone);
  const Paint reveal = plain(style.trim * 0.8f, Finish::matte);
  const Paint frame = plain(style.joinery, Finish::paint);
  b.quad(reveal, {l, 0, 0}, {l, 0, -depth}, {l, h, -depth}, {l, h, 0});
  b.quad(reveal, {r, 0, -depth}, {r, 0, 0}, {r, h, 0}, {r, h, -depth});
  b.quad(reveal, {l, h, -depth}, {r, h, -depth}, {r, h, 0}, {l, h, 0});
  // Frame: an outer ring with its inner faces, a post and a transom.
  const float f = 0.065f;
  const float zf = -depth + 0.05f;
  const float zp = -depth;
  // High above the street the bars' flanks are less than a pixel.
  const bool high_up = y > 7.0f;
  const unsigned flanks = high_up ? 0u : ~0u;
  b.box(frame, {l, 0, zp}, {l + f, h, zf}, face_front | (face_right & flanks));
  b.box(frame, {r - f, 0, zp}, {r, h, zf}, face_front | (face_left & flanks));
  b.box(frame, {l + f, 0, zp}, {r - f, f, zf}, face_front | (face_top & flanks));
  b.box(frame, {l + f, h - f, zp}, {r - f, h, zf}, face_front | (face_bottom & flanks));
  const float transom = h > 1.5f ? 0.68f * h : 0.5f * h;
  b.box(frame, {-0.03f, f, zp}, {0.03f, h - f, zf}, face_front | (face_sides & flanks));
  b.box(frame, {l + f, transom - 0.025f, zp}, {r - f, transom + 0.025f, zf - 0.008f},
        face_front | (face_bottom & flanks));
  const bool lit = dice.chance(style.lit);
  const int tile = lit ? dice.below(lit_panes) : lit_panes + dice.below(dark_panes);
  UvRect rect = pane_rect(tile);
  if (dice.chance(0.5f)) std::swap(rect.minimum.x, rect.maximum.x);
  b.picture(Mat::panes, glm::vec3(1.0f), rect, {l, 0, zp}, {r, 0, zp}, {r, h, zp}, {l, h, zp});
  // Sill, falling outwards.
  const std::array<glm::vec2, 4> sill{{{0.0f, -0.10f}, {0.11f, -0.09f}, {0.12f, -0.02f}, {-depth + 0.04f, 0.012f}}};
  b.moulding(trim, sill, l - 0.09f, r + 0.09f, 0.0f, 0.0f, !high_up);
  if (head != Head::none && head != Head::arch) surround(b, trim, w, h);
  head_piece(b, trim, head, w, h);
  if (shutters) {
    const Paint leaf = plain(style.shutters * dice.between(0.8f, 1.15f), Finish::paint);
    const float sw = 0.5f * w;
    const float open = dice.chance(0.15f) ? 0.55f : 0.06f;  // ajar or flat against the wall
    for (float s : {-1.0f, 1.0f}) {
      const float hinge = s * (r + 0.14f);
      Builder leaf_b = b.moved({hinge, 0.0f, 0.05f}, s < 0 ? open : -open);
      const float x0 = s < 0 ? -sw : 0.0f;
      leaf_b.box(leaf, {x0, 0.02f, 0.0f}, {x0 + sw, h - 0.02f, 0.035f}, face_no_back & ~face_bottom);
      for (int k = 0; k < 2; ++k) {  // louvred panels read as a darker field with a bevel
        const float y0 = 0.10f + static_cast<float>(k) * 0.5f * (h - 0.08f);
        const float y1 = y0 + 0.5f * (h - 0.08f) - 0.12f;
        leaf_b.quad(plain(leaf.colour * 0.45f, Finish::matte), {x0 + 0.07f, y0, 0.037f}, {x0 + sw - 0.07f, y0, 0.037f},
                    {x0 + sw - 0.07f, y1, 0.037f}, {x0 + 0.07f, y1, 0.037f});
      }
    }
  }
}

void balcony(Builder& parent, const Style& style, float x, float y, float width) {
  Builder b = parent.moved({x, y, 0.0f});
  const float reach = 0.75f;
  const float half = 0.5f * width;
  const Paint stone = plain(style.trim * 0.9f, Finish::stone);
  const Paint iron = plain(railing_iron, Finish::iron);
  const std::array<glm::vec2, 4> slab{{{0.0f, -0.20f}, {reach - 0.06f, -0.16f}, {reach, -0.08f}, {reach, 0.0f}}};
  b.moulding(stone, slab, -half, half);
  b.quad(stone, {-half, 0, reach}, {half, 0, reach}, {half, 0, 0}, {-half, 0, 0});
  for (float s : {-0.7f, 0.7f}) {  // brackets
    const float c = s * half;
    b.box(stone, {c - 0.08f, -0.55f, 0.0f}, {c + 0.08f, -0.19f, 0.22f}, face_front | face_sides | face_bottom);
    b.box(stone, {c - 0.08f, -0.34f, 0.22f}, {c + 0.08f, -0.17f, 0.5f}, face_front | face_sides | face_bottom);
  }
  const float rail = 0.98f;
  const float zr = reach - 0.06f;
  const float xr = half - 0.05f;
  const unsigned long_rail = face_front | face_top | face_back | face_bottom;
  b.box(iron, {-xr - 0.03f, rail, zr - 0.02f}, {xr + 0.03f, rail + 0.035f, zr + 0.03f}, long_rail | face_sides);
  b.box(iron, {-xr, 0.09f, zr - 0.01f}, {xr, 0.115f, zr + 0.01f}, long_rail);
  for (float s : {-1.0f, 1.0f}) {
    const float c = s * xr;
    b.box(iron, {c - 0.015f, rail, 0.0f}, {c + 0.015f, rail + 0.035f, zr}, face_sides | face_top | face_bottom);
    b.box(iron, {c - 0.01f, 0.09f, 0.0f}, {c + 0.01f, 0.115f, zr}, face_sides | face_top | face_bottom);
  }
  const int bars = static_cast<int>(2.0f * xr / 0.16f);
  for (int k = 0; k <= bars; ++k) {
    const float c = -xr + 2.0f * xr * static_cast<float>(k) / static_cast<float>(bars);
    const bool post = k == 0 || k == bars;
    const float t = post ? 0.022f : 0.009f;
    b.box(iron, {c - t, 0.0f, zr - t}, {c + t, rail, zr + t},
          post ? face_front | face_sides | face_back : face_front | face_sides);
  }
  for (float s : {-1.0f, 1.0f}) {
    for (int k = 1; k < 4; ++k) {
      const float z = zr * static_cast<float>(k) / 4.0f;
      b.box(iron, {s * xr - 0.009f, 0.1f, z - 0.009f}, {s * xr + 0.009f, rail, z + 0.009f}, face_sides | face_front);
    }
  }
}

}  // namespace petrichor::city
