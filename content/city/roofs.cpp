#include "content/city/roofs.hpp"

#include <array>
#include <cmath>

namespace petrichor::city {
namespace {

constexpr float overhang_m = 0.55f;
const glm::vec3 zinc(0.15f, 0.16f, 0.17f);

void skylight(Builder& b, float x, float y, float z, float slope) {
  const float len = std::sqrt(1.0f + slope * slope);
  const glm::vec3 up(0.0f, slope / len, -1.0f / len), out(0.0f, 1.0f / len, slope / len), right(1, 0, 0);
  const glm::vec3 c = glm::vec3(x, y, z) + out * 0.06f;
  b.quad(plain(glm::vec3(0.02f), Finish::gloss), c - right * 0.4f - up * 0.6f, c + right * 0.4f - up * 0.6f,
         c + right * 0.4f + up * 0.6f, c - right * 0.4f + up * 0.6f);
}

}  // namespace

void gutter(Builder& b, float x0, float x1, float y, float z) {
  const Paint metal = plain(zinc, Finish::iron);
  const std::array<glm::vec2, 5> outside{
      {{z, y - 0.12f}, {z + 0.06f, y - 0.11f}, {z + 0.11f, y - 0.07f}, {z + 0.13f, y}, {z + 0.12f, y + 0.012f}}};
  b.moulding(metal, outside, x0, x1, 0.0f, 0.0f, false);
  b.quad(plain(zinc * 0.3f, Finish::gloss), {x0, y - 0.02f, z + 0.12f}, {x1, y - 0.02f, z + 0.12f}, {x1, y - 0.02f, z},
         {x0, y - 0.02f, z});
}

void chimney(Builder& parent, glm::vec3 foot, float height, int pots) {
  Builder b = parent.moved(foot);
  const float half = 0.28f + 0.2f * static_cast<float>(pots);
  b.box(tiling(Mat::brick, glm::vec3(0.75f)), {-half, -2.0f, -0.35f}, {half, height, 0.35f}, face_no_bottom);
  b.box(plain(glm::vec3(0.25f), Finish::stone), {-half - 0.07f, height - 0.25f, -0.42f},
        {half + 0.07f, height - 0.10f, 0.42f});
  for (int k = 0; k < pots; ++k) {
    const float x = (static_cast<float>(k) - 0.5f * static_cast<float>(pots - 1)) * 0.42f;
    b.cylinder(plain({0.22f, 0.09f, 0.05f}, Finish::matte), {x, height - 0.02f, 0}, {x, height + 0.5f, 0}, 0.14f, 0.11f,
               7, false, true);
  }
}

void dormer(Builder& parent, const Style& style, float x, float y, float z, float slope, glm::vec3 tint, Dice& dice) {
  Builder b = parent.moved({x, y, z});
  const Paint cheek = plain(style.joinery * 0.5f + glm::vec3(0.05f), Finish::paint);
  const Paint tiles = tiling(Mat::tiles, tint);
  const float half = 0.68f;
  const float h = 1.45f;
  const float rise = 0.55f;
  std::vector<Opening> hole{{half - 0.45f, half + 0.45f, 0.2f, h - 0.12f}};
  Builder front = b.moved({-half, 0.0f, 0.0f});
  wall_with_openings(front, cheek, 2.0f * half, 0.0f, h, hole);
  Style own = style;
  own.trim = style.joinery;
  window(b, own, 0.0f, 0.2f, 0.9f, h - 0.32f, Head::none, false, dice);
  b.triangle(cheek, {-half, h, 0}, {half, h, 0}, {0, h + rise, 0});
  // Cheeks and the little roof run back until the main slope swallows them.
  const float back = -h / slope;
  const float back_ridge = -(h + rise) / slope;
  b.triangle(cheek, {half, 0, 0}, {half, h, back}, {half, h, 0});
  b.triangle(cheek, {-half, 0, 0}, {-half, h, 0}, {-half, h, back});
  const float e = half + 0.14f;
  const float ey = h - 0.12f;
  b.quad(tiles, {e, ey, 0.15f}, {e, ey, back}, {0, h + rise, back_ridge}, {0, h + rise, 0.15f});
  b.quad(tiles, {-e, ey, back}, {-e, ey, 0.15f}, {0, h + rise, 0.15f}, {0, h + rise, back_ridge});
  const Paint board = plain(style.joinery, Finish::paint);
  b.quad(board, {0, h + rise - 0.14f, 0.15f}, {e, ey - 0.12f, 0.15f}, {e, ey, 0.15f}, {0, h + rise, 0.15f});
  b.quad(board, {-e, ey - 0.12f, 0.15f}, {0, h + rise - 0.14f, 0.15f}, {0, h + rise, 0.15f}, {-e, ey, 0.15f});
}

void saddle_roof(Builder& b, const Style& style, RoofSpan s, glm::vec3 tint, Dice& dice) {
  const Paint tiles = tiling(Mat::tiles, tint, {dice.next() * 2.0f, 0.0f});
  const float half = 0.5f * s.depth_m;
  const float slope = dice.between(0.72f, 1.0f);
  const float z_eave = overhang_m;
  const float ridge = s.eaves_m + slope * (half + z_eave) * 0.92f;
  const float w = s.width_m;
  b.quad(tiles, {0, s.eaves_m, z_eave}, {w, s.eaves_m, z_eave}, {w, ridge, -half}, {0, ridge, -half});
  b.quad(tiles, {w, s.eaves_m, -s.depth_m - z_eave}, {0, s.eaves_m, -s.depth_m - z_eave}, {0, ridge, -half},
         {w, ridge, -half});
  const Paint wall = tiling(Mat::stucco, style.wall.colour * 0.6f);
  b.triangle(wall, {w, s.eaves_m, 0}, {w, s.eaves_m, -s.depth_m}, {w, ridge - 0.05f, -half});
  b.triangle(wall, {0, s.eaves_m, -s.depth_m}, {0, s.eaves_m, 0}, {0, ridge - 0.05f, -half});
  const std::array<glm::vec3, 2> top{{{0, ridge, -half}, {w, ridge, -half}}};
  b.tube(plain(tint * 0.12f, Finish::stone), top, 0.12f, 6);
  gutter(b, 0.0f, w, s.eaves_m, z_eave - 0.02f);
  const float run = (ridge - s.eaves_m) / (half + z_eave);
  const int dormers = static_cast<int>(w / 4.2f);
  for (int k = 0; k < dormers; ++k) {
    const float x = w * (static_cast<float>(k) + 0.5f) / static_cast<float>(dormers);
    const float z = -0.75f;
    dormer(b, style, x, s.eaves_m + run * (z_eave - z) - 0.02f, z, run, tint, dice);
    if (dice.chance(0.4f)) skylight(b, x + 1.6f, s.eaves_m + run * (z_eave + 3.0f), -3.0f, run);
  }
  chimney(b, {dice.chance(0.5f) ? 0.9f : w - 0.9f, ridge - 0.6f, -half + 0.9f}, dice.between(1.6f, 2.4f),
          1 + dice.below(3));
}

void mansard_roof(Builder& b, const Style& style, RoofSpan s, glm::vec3 tint, Dice& dice) {
  const Paint tiles = tiling(Mat::tiles, tint * 0.55f);
  const float w = s.width_m;
  const float rise = 2.7f;
  const float inset = 1.1f;
  const float slope = rise / (inset + 0.2f);
  const float y = s.eaves_m;
  b.quad(tiles, {0, y, 0.2f}, {w, y, 0.2f}, {w, y + rise, -inset}, {0, y + rise, -inset});
  b.quad(tiles, {w, y, -s.depth_m}, {0, y, -s.depth_m}, {0, y + rise, -s.depth_m + inset},
         {w, y + rise, -s.depth_m + inset});
  const Paint wall = tiling(Mat::stucco, style.wall.colour * 0.55f);
  for (float x : {0.0f, w}) {
    std::array<glm::vec3, 4> side{
        {{x, y, 0.2f}, {x, y, -s.depth_m}, {x, y + rise, -s.depth_m + inset}, {x, y + rise, -inset}}};
    if (x == 0.0f) std::swap(side[1], side[3]);
    b.fan(wall, side);
  }
  const Paint lead = plain(glm::vec3(0.07f), Finish::stone);
  const float ridge = y + rise + 1.1f;
  const float half = -0.5f * s.depth_m;
  b.quad(lead, {0, y + rise, -inset}, {w, y + rise, -inset}, {w, ridge, half}, {0, ridge, half});
  b.quad(lead, {w, y + rise, -s.depth_m + inset}, {0, y + rise, -s.depth_m + inset}, {0, ridge, half},
         {w, ridge, half});
  b.triangle(wall, {w, y + rise, -inset}, {w, y + rise, -s.depth_m + inset}, {w, ridge, half});
  b.triangle(wall, {0, y + rise, -s.depth_m + inset}, {0, y + rise, -inset}, {0, ridge, half});
  gutter(b, 0.0f, w, y + 0.02f, 0.40f);
  const int dormers = std::max(1, static_cast<int>(std::lround(w / style.bay_m)));
  for (int k = 0; k < dormers; ++k) {
    const float x = w * (static_cast<float>(k) + 0.5f) / static_cast<float>(dormers);
    dormer(b, style, x, y + 0.45f, 0.12f - 0.45f / slope, slope, tint * 0.55f, dice);
  }
  for (float x : {0.6f, w - 0.6f}) chimney(b, {x, ridge - 0.8f, half + 1.2f}, 1.9f, 2);
}

void flat_roof(Builder& b, const Style& style, RoofSpan s, Dice& dice) {
  const Paint wall = plain(style.trim * 0.8f, Finish::stone);
  const float y = s.eaves_m;
  const float parapet = 0.95f;
  const float w = s.width_m;
  b.quad(plain(glm::vec3(0.05f, 0.05f, 0.052f), Finish::stone), {0, y, 0}, {w, y, 0}, {w, y, -s.depth_m},
         {0, y, -s.depth_m});
  b.box(wall, {0, y, -0.30f}, {w, y + parapet, 0.0f}, face_front | face_back | face_top);
  b.box(wall, {0, y, -s.depth_m}, {w, y + parapet, -s.depth_m + 0.3f}, face_front | face_back | face_top);
  b.box(wall, {0, y, -s.depth_m + 0.3f}, {0.3f, y + parapet, -0.3f}, face_sides | face_top);
  b.box(wall, {w - 0.3f, y, -s.depth_m + 0.3f}, {w, y + parapet, -0.3f}, face_sides | face_top);
  const std::array<glm::vec2, 4> coping{
      {{0.0f, y + parapet}, {0.10f, y + parapet + 0.02f}, {0.10f, y + parapet + 0.10f}, {-0.38f, y + parapet + 0.13f}}};
  b.moulding(wall, coping, 0.0f, w);
  // A stair head with a lamp over its door, a water tank, vents.
  const float cx = 0.68f * w;
  const float cz = -0.62f * s.depth_m;
  b.box(tiling(Mat::brick, glm::vec3(0.8f)), {cx - 1.4f, y, cz - 1.3f}, {cx + 1.4f, y + 2.6f, cz + 1.3f},
        face_no_bottom);
  b.box(plain(glm::vec3(0.10f), Finish::stone), {cx - 1.55f, y + 2.6f, cz - 1.45f},
        {cx + 1.55f, y + 2.75f, cz + 1.6f});
  b.box(plain({0.05f, 0.09f, 0.08f}, Finish::paint), {cx - 0.5f, y, cz + 1.3f}, {cx + 0.5f, y + 2.1f, cz + 1.35f},
        face_no_back);
  b.box(glow(Glow::candle), {cx - 0.07f, y + 2.25f, cz + 1.31f}, {cx + 0.07f, y + 2.42f, cz + 1.42f});
  b.cylinder(plain({0.12f, 0.08f, 0.05f}, Finish::matte), {0.24f * w, y + 0.5f, cz}, {0.24f * w, y + 2.4f, cz}, 1.0f,
             1.0f, 14);
  b.cylinder(plain(glm::vec3(0.08f), Finish::iron), {0.24f * w, y + 2.4f, cz}, {0.24f * w, y + 2.9f, cz}, 1.08f, 0.05f,
             14);
  for (int k = 0; k < 4; ++k) {
    const float t = 1.5708f * static_cast<float>(k) + 0.78f;
    const float x = 0.24f * w + 0.8f * std::cos(t);
    b.cylinder(plain(glm::vec3(0.05f), Finish::iron), {x, y, cz + 0.8f * std::sin(t)},
               {x, y + 0.55f, cz + 0.8f * std::sin(t)}, 0.05f, 0.05f, 5);
  }
  for (int k = 0; k < 3; ++k) {
    const float x = w * (0.2f + 0.25f * static_cast<float>(k)) + dice.next();
    const float z = -2.2f - dice.next() * 1.5f;
    b.cylinder(plain(zinc, Finish::iron), {x, y, z}, {x, y + 0.7f, z}, 0.11f, 0.11f, 8);
    b.cylinder(plain(zinc, Finish::iron), {x, y + 0.74f, z}, {x, y + 0.9f, z}, 0.2f, 0.02f, 8, true);
  }
}

void stepped_gable(Builder& b, const Style& style, RoofSpan s, glm::vec3 tint, Dice& dice) {
  const float w = s.width_m;
  const int steps = 5;
  const float step_h = 0.95f;
  const float top_half = 0.8f;
  const Paint coping = plain(style.trim, Finish::stone);
  float ridge = s.eaves_m;
  for (int k = 0; k < steps; ++k) {
    const float f = static_cast<float>(k) / static_cast<float>(steps);
    const float half = 0.5f * w + (top_half - 0.5f * w) * f;
    const float y0 = s.eaves_m + step_h * static_cast<float>(k);
    const float y1 = y0 + step_h;
    const bool has_window = k == 1 || k == 2;
    Builder row = b.moved({0.5f * w - half, 0.0f, 0.0f});
    std::vector<Opening> holes;
    if (k == 1 || k == 2) holes.push_back({half - 0.45f, half + 0.45f, k == 1 ? y0 : y0, k == 1 ? y1 : y0 + 0.5f});
    wall_with_openings(row, style.wall, 2.0f * half, y0, y1, holes);
    b.box(style.wall, {0.5f * w - half, y0, -0.4f}, {0.5f * w + half, y1, -0.0005f}, face_sides | face_back);
    const float next = 0.5f * w + (top_half - 0.5f * w) * (f + 1.0f / static_cast<float>(steps));
    const float inner = k + 1 == steps ? 0.0f : next;
    b.box(coping, {0.5f * w - half - 0.06f, y1, -0.45f}, {0.5f * w - inner, y1 + 0.09f, 0.07f});
    b.box(coping, {0.5f * w + inner, y1, -0.45f}, {0.5f * w + half + 0.06f, y1 + 0.09f, 0.07f});
    if (has_window && k == 1) window(b, style, 0.5f * w, y0, 0.9f, step_h + 0.5f, Head::none, false, dice);
    ridge = y0;
  }
  // The roof behind runs at right angles to the street.
  const Paint tiles = tiling(Mat::tiles, tint);
  const float m = 0.5f * w;
  b.quad(tiles, {w, s.eaves_m, -0.3f}, {w, s.eaves_m, -s.depth_m}, {m, ridge, -s.depth_m}, {m, ridge, -0.3f});
  b.quad(tiles, {0, s.eaves_m, -s.depth_m}, {0, s.eaves_m, -0.3f}, {m, ridge, -0.3f}, {m, ridge, -s.depth_m});
  b.triangle(style.wall, {w, s.eaves_m, -s.depth_m}, {0, s.eaves_m, -s.depth_m}, {m, ridge, -s.depth_m});
  chimney(b, {m + 1.2f, ridge - 1.0f, -0.6f * s.depth_m}, 1.8f, 2);
}

}  // namespace petrichor::city
