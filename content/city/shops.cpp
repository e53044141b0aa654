// Ordinary shop fronts and awnings.
#include <array>
#include <cmath>

#include "content/city/atlases.hpp"
#include "content/city/facade.hpp"

namespace petrichor::city {

void shop_front(Builder& b, const Style& style, const Facade& f, float x0, float x1, Dice& dice) {
  const float top = style.ground_height_m;
  const Paint stone = plain(style.trim * 0.85f, Finish::stone);
  const Paint joinery = plain(f.accent, Finish::gloss);
  const float pier = 0.45f;
  const float l = x0 + pier;
  const float r = x1 - pier;
  const float fascia0 = 2.95f;
  const float fascia1 = 3.62f;
  const float riser = 0.62f;
  const float depth = 0.22f;
  // Piers and the wall above the fascia.
  b.quad(style.ground_wall, {x0, 0, 0}, {l, 0, 0}, {l, top, 0}, {x0, top, 0});
  b.quad(style.ground_wall, {r, 0, 0}, {x1, 0, 0}, {x1, top, 0}, {r, top, 0});
  b.quad(style.ground_wall, {l, fascia1, 0}, {r, fascia1, 0}, {r, top, 0}, {l, top, 0});
  for (float x : {l, r}) {  // pilasters with capital and base
    b.box(joinery, {x - 0.16f, 0.1f, 0}, {x + 0.16f, fascia1, 0.10f}, face_front | face_sides);
    b.box(joinery, {x - 0.20f, 0.1f, 0}, {x + 0.20f, 0.5f, 0.14f}, face_no_back);
    b.box(joinery, {x - 0.20f, fascia0 - 0.16f, 0}, {x + 0.20f, fascia0 - 0.02f, 0.15f}, face_no_back);
    b.box(joinery, {x - 0.20f, fascia1 - 0.1f, 0}, {x + 0.20f, fascia1 + 0.14f, 0.2f}, face_no_back);
  }
  // Fascia with its board, and a small cornice over it.
  b.box(joinery, {l + 0.16f, fascia0, 0}, {r - 0.16f, fascia1, 0.08f}, face_front | face_bottom);
  const std::array<glm::vec2, 4> hood{
      {{0.08f, fascia1 - 0.04f}, {0.22f, fascia1 + 0.03f}, {0.24f, fascia1 + 0.10f}, {0.0f, fascia1 + 0.14f}}};
  b.moulding(joinery, hood, l - 0.1f, r + 0.1f);
  if (f.sign >= 0) {
    const auto sign = static_cast<Sign>(f.sign);
    const float h = 0.52f;
    const float half = std::min(0.5f * (r - l) - 0.3f, 0.5f * h * sign_aspect(sign));
    const float hh = half / sign_aspect(sign);
    const float cx = 0.5f * (l + r);
    const float cy = 0.5f * (fascia0 + fascia1) + 0.01f;
    b.picture(Mat::signs, glm::vec3(1.0f), sign_rect(sign), {cx - half, cy - hh, 0.095f}, {cx + half, cy - hh, 0.095f},
              {cx + half, cy + hh, 0.095f}, {cx - half, cy + hh, 0.095f});
    for (float s : {-0.55f, 0.55f}) {  // swan-neck lamps over the board
      const float x = cx + s * half;
      const std::array<glm::vec3, 4> neck{{{x, fascia1 + 0.2f, 0.0f},
                                           {x, fascia1 + 0.34f, 0.2f},
                                           {x, fascia1 + 0.3f, 0.4f},
                                           {x, fascia1 + 0.17f, 0.44f}}};
      b.tube(plain(glm::vec3(0.03f), Finish::iron), neck, 0.016f, 4);
      b.cylinder(plain({0.05f, 0.07f, 0.06f}, Finish::paint), {x, fascia1 + 0.06f, 0.46f}, {x, fascia1 + 0.19f, 0.44f},
                 0.11f, 0.03f, 8);
      const std::array<glm::vec3, 4> mouth{{{x - 0.07f, fascia1 + 0.075f, 0.40f},
                                            {x + 0.07f, fascia1 + 0.075f, 0.40f},
                                            {x + 0.07f, fascia1 + 0.075f, 0.53f},
                                            {x - 0.07f, fascia1 + 0.075f, 0.53f}}};
      b.fan(glow(Glow::candle), mouth);
    }
  }
  // Two windows about a door that lies deeper.
  const bool door_left = dice.chance(0.3f);
  const float span = r - l - 0.32f;
  const float door_w = 1.15f;
  const float dx = door_left ? l + 0.16f + 0.12f * span : l + 0.16f + 0.5f * (span - door_w);
  const auto display = [&](float a, float c) {
    if (c - a < 0.35f) return;
    b.box(joinery, {a, 0.1f, -depth}, {c, riser, 0.02f}, face_front | face_top);
    b.quad(stone, {a, fascia0, -depth}, {c, fascia0, -depth}, {c, fascia0, 0.0f}, {a, fascia0, 0.0f});
    const float share = std::min(1.0f, (c - a) / 3.2f);
    UvRect rect = goods_rect(static_cast<Goods>(f.goods));
    const float slack = (1.0f - share) * (rect.maximum.x - rect.minimum.x);
    rect.minimum.x += slack * (a < dx ? 0.0f : 1.0f);
    rect.maximum.x = rect.minimum.x + share * (goods_rect(static_cast<Goods>(f.goods)).maximum.x -
                                               goods_rect(static_cast<Goods>(f.goods)).minimum.x);
    b.picture(Mat::shopfront, glm::vec3(1.0f), rect, {a, riser, -depth}, {c, riser, -depth}, {c, fascia0, -depth},
              {a, fascia0, -depth});
    const int panes = std::max(1, static_cast<int>(std::lround((c - a) / 1.1f)));
    for (int k = 0; k <= panes; ++k) {
      const float x = a + (c - a) * static_cast<float>(k) / static_cast<float>(panes);
      b.box(joinery, {x - 0.035f, riser, -depth}, {x + 0.035f, fascia0, -depth + 0.08f}, face_front | face_sides);
    }
    b.box(joinery, {a, 2.35f, -depth}, {c, 2.42f, -depth + 0.07f}, face_front | face_bottom | face_top);
  };
  display(l + 0.16f, dx);
  display(dx + door_w, r - 0.16f);
  const float dd = -0.75f;
  b.quad(joinery, {dx, 0.1f, 0}, {dx, 0.1f, dd}, {dx, fascia0, dd}, {dx, fascia0, 0});
  b.quad(joinery, {dx + door_w, 0.1f, dd}, {dx + door_w, 0.1f, 0}, {dx + door_w, fascia0, 0},
         {dx + door_w, fascia0, dd});
  b.quad(stone, {dx, fascia0, dd}, {dx + door_w, fascia0, dd}, {dx + door_w, fascia0, 0}, {dx, fascia0, 0});
  b.quad(stone, {dx, 0.19f, 0}, {dx + door_w, 0.19f, 0}, {dx + door_w, 0.19f, dd}, {dx, 0.19f, dd});
  b.quad(stone, {dx, 0.0f, 0.0f}, {dx + door_w, 0.0f, 0.0f}, {dx + door_w, 0.19f, 0.0f}, {dx, 0.19f, 0.0f});
  b.quad(joinery, {dx, 0.19f, dd}, {dx + door_w, 0.19f, dd}, {dx + door_w, fascia0, dd}, {dx, fascia0, dd});
  b.picture(Mat::panes, glm::vec3(1.0f), pane_rect(8), {dx + 0.16f, 1.0f, dd + 0.01f},
            {dx + door_w - 0.16f, 1.0f, dd + 0.01f}, {dx + door_w - 0.16f, 2.75f, dd + 0.01f},
            {dx + 0.16f, 2.75f, dd + 0.01f});
  if (f.awning)
    awning(b, l - 0.1f, r + 0.1f, fascia0 + 0.05f, 0.75f, 1.5f, f.accent * 2.2f + glm::vec3(0.02f),
           glm::vec3(0.42f, 0.39f, 0.33f));
}

int awning_stripes(float length_m) {
  return std::max(4, static_cast<int>(std::lround(length_m / 0.28f)));
}

void awning(Builder& b, float x0, float x1, float y_top, float drop, float reach, glm::vec3 stripe, glm::vec3 ground) {
  const int stripes = awning_stripes(x1 - x0);
  const float y1 = y_top - drop;
  const float valance = 0.24f;
  for (int k = 0; k < stripes; ++k) {
    const float a = x0 + (x1 - x0) * static_cast<float>(k) / static_cast<float>(stripes);
    const float c = x0 + (x1 - x0) * static_cast<float>(k + 1) / static_cast<float>(stripes);
    const Paint cloth = plain((k & 1) ? ground : stripe, Finish::matte);
    const Paint under = plain(((k & 1) ? ground : stripe) * 0.6f, Finish::matte);
    // The cloth sags between wall and rail.
    const float zm = 0.5f * reach;
    const float ym = 0.5f * (y_top + y1) - 0.05f;
    const glm::vec3 up(0, 0.004f, 0);
    b.quad(cloth, glm::vec3(a, ym, zm) + up, glm::vec3(c, ym, zm) + up, glm::vec3(c, y_top, 0.02f) + up,
           glm::vec3(a, y_top, 0.02f) + up);
    b.quad(cloth, glm::vec3(a, y1, reach) + up, glm::vec3(c, y1, reach) + up, glm::vec3(c, ym, zm) + up,
           glm::vec3(a, ym, zm) + up);
    b.quad(under, {a, y_top, 0.02f}, {c, y_top, 0.02f}, {c, ym, zm}, {a, ym, zm});
    b.quad(under, {a, ym, zm}, {c, ym, zm}, {c, y1, reach}, {a, y1, reach});
    // Valance with a pointed scallop to each stripe, seen from both sides.
    const float m = 0.5f * (a + c);
    const std::array<glm::vec3, 5> front{{{a, y1 - valance * 0.65f, reach},
                                          {m, y1 - valance, reach},
                                          {c, y1 - valance * 0.65f, reach},
                                          {c, y1 + 0.004f, reach},
                                          {a, y1 + 0.004f, reach}}};
    b.fan(cloth, front);
    const std::array<glm::vec3, 5> back{{front[4], front[3], front[2], front[1], front[0]}};
    std::array<glm::vec3, 5> inner = back;
    for (glm::vec3& p : inner) p.z -= 0.006f;
    b.fan(under, inner);
  }
  const Paint iron = plain(glm::vec3(0.05f), Finish::iron);
  b.cylinder(iron, {x0, y1 - 0.01f, reach - 0.02f}, {x1, y1 - 0.01f, reach - 0.02f}, 0.015f, 0.015f, 5);
  for (float x : {x0 + 0.1f, x1 - 0.1f})
    b.cylinder(iron, {x, y_top - drop - 0.25f, 0.03f}, {x, y1, reach - 0.02f}, 0.012f, 0.012f, 4);
}

}  // namespace petrichor::city
