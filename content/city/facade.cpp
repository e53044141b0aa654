#include "content/city/facade.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "content/city/atlases.hpp"

namespace petrichor::city {
namespace {

constexpr float plinth_m = 0.55f;

void quoins(Builder& b, const Paint& trim, float x, float inward, float y0, float y1) {
  int k = 0;
  for (float y = y0; y + 0.30f < y1; y += 0.33f, ++k) {
    const float reach = (k & 1) ? 0.32f : 0.52f;
    const float x0 = inward > 0 ? x : x - reach;
    b.box(trim, {x0, y, 0.0f}, {x0 + reach, y + 0.305f, 0.05f}, face_no_back & ~face_bottom);
  }
}

void cornice(Builder& b, const Style& style, const Facade& f, float y) {
  const Paint trim = plain(style.trim, Finish::stone);
  const std::array<glm::vec2, 8> profile{{{0.0f, y - 0.62f},
                                          {0.06f, y - 0.60f},
                                          {0.07f, y - 0.36f},
                                          {0.20f, y - 0.30f},
                                          {0.40f, y - 0.24f},
                                          {0.42f, y - 0.12f},
                                          {0.50f, y - 0.03f},
                                          {0.50f, y}}};
  b.moulding(trim, profile, 0.0f, f.width_m, f.miter_left, f.miter_right);
  b.quad(trim, {-f.miter_left * 0.5f, y, 0.5f}, {f.width_m + f.miter_right * 0.5f, y, 0.5f}, {f.width_m, y, 0.0f},
         {0.0f, y, 0.0f});
  if (!style.dentils) return;
  for (float x = 0.15f; x + 0.16f < f.width_m; x += 0.48f) {
    b.box(trim, {x, y - 0.36f, 0.06f}, {x + 0.16f, y - 0.22f, 0.26f}, face_front | face_sides | face_bottom);
  }
}

void string_course(Builder& b, const Style& style, const Facade& f, float y, float reach) {
  const std::array<glm::vec2, 5> profile{
      {{0.0f, y - 0.12f}, {reach * 0.6f, y - 0.10f}, {reach, y - 0.03f}, {reach, y + 0.03f}, {0.0f, y + 0.07f}}};
  b.moulding(plain(style.trim, Finish::stone), profile, 0.0f, f.width_m, f.miter_left, f.miter_right);
}

void downpipe(Builder& b, float x, float y) {
  const Paint zinc = plain(glm::vec3(0.16f, 0.17f, 0.18f), Finish::iron);
  const std::array<glm::vec3, 7> path{{{x, y - 0.05f, 0.58f},
                                       {x, y - 0.25f, 0.55f},
                                       {x, y - 0.75f, 0.16f},
                                       {x, y - 0.95f, 0.11f},
                                       {x, 0.75f, 0.11f},
                                       {x, 0.40f, 0.13f},
                                       {x, 0.28f, 0.28f}}};
  b.tube(zinc, path, 0.048f, 6);
  for (float h = 1.6f; h < y - 1.2f; h += 2.6f)
    b.box(zinc, {x - 0.065f, h, 0.0f}, {x + 0.065f, h + 0.05f, 0.175f}, face_no_back);
}

void upper_floors(Builder& b, const Style& style, const Facade& f, Dice& dice) {
  const int bays = std::max(1, static_cast<int>(std::lround(f.width_m / style.bay_m)));
  const float pitch = f.width_m / static_cast<float>(bays);
  for (int floor = 0; floor < style.floors; ++floor) {
    const float y = style.ground_height_m + style.floor_height_m * static_cast<float>(floor);
    const bool top = floor == style.floors - 1;
    // The piano nobile is tall, the top floor low.
    const float h = style.window_height_m * (floor == 0 ? 1.1f : top ? 0.82f : 1.0f);
    const float sill = floor == 0 && style.balconies > 0.0f ? 0.12f : 0.75f;
    std::vector<Opening> openings;
    for (int k = 0; k < bays; ++k) {
      const float x = (static_cast<float>(k) + 0.5f) * pitch;
      openings.push_back({x - 0.5f * style.window_width_m, x + 0.5f * style.window_width_m, y + sill, y + sill + h});
    }
    wall_with_openings(b, style.wall, f.width_m, y, y + style.floor_height_m, openings);
    for (int k = 0; k < bays; ++k) {
      const float x = (static_cast<float>(k) + 0.5f) * pitch;
      const Head head = top && style.head != Head::arch ? Head::lintel
                        : style.head == Head::pediment
                            ? (floor == 0 || (floor == 1 && (k & 1)) ? Head::pediment : Head::hood)
                            : style.head;
      window(b, style, x, y + sill, style.window_width_m, h, head, style.has_shutters, dice);
      if ((floor == 0 || floor == 2) && !top && dice.chance(style.balconies)) {
        balcony(b, style, x, y + (floor == 0 ? 0.1f : 0.35f), std::min(pitch - 0.2f, style.window_width_m + 0.9f));
      }
    }
    if (style.string_courses && floor > 0) string_course(b, style, f, y, floor == 1 ? 0.14f : 0.09f);
  }
}

void house_ground(Builder& b, const Style& style, const Facade& f, Dice& dice) {
  const float top = style.ground_height_m;
  const int bays = std::max(1, static_cast<int>(std::lround(f.width_m / style.bay_m)));
  const float pitch = f.width_m / static_cast<float>(bays);
  const int door_bay = f.ground == Ground::gate ? bays / 2 : dice.below(bays);
  const float door_width = f.ground == Ground::gate ? std::min(2.6f, pitch - 0.2f) : 1.3f;
  const float door_height = f.ground == Ground::gate ? 3.1f : 2.7f;
  std::vector<Opening> openings;
  for (int k = 0; k < bays; ++k) {
    const float x = (static_cast<float>(k) + 0.5f) * pitch;
    if (k == door_bay) {
      openings.push_back({x - 0.5f * door_width, x + 0.5f * door_width, 0.1f, 0.1f + door_height});
    } else {
      openings.push_back(
          {x - 0.5f * style.window_width_m, x + 0.5f * style.window_width_m, 1.15f, 1.15f + style.window_height_m});
    }
  }
  wall_with_openings(b, style.ground_wall, f.width_m, 0.0f, top, openings);
  const Paint trim = plain(style.trim * 0.8f, Finish::stone);
  float x = 0.0f;  // plinth, interrupted by the door
  const float door_x = (static_cast<float>(door_bay) + 0.5f) * pitch;
  for (float end : {door_x - 0.5f * door_width - 0.15f, f.width_m}) {
    if (end > x + 0.05f) {
      const std::array<glm::vec2, 4> profile{
          {{0.07f, 0.0f}, {0.07f, plinth_m - 0.06f}, {0.03f, plinth_m}, {0.0f, plinth_m}}};
      b.moulding(trim, profile, x, end, x == 0.0f ? f.miter_left : 0.0f, end == f.width_m ? f.miter_right : 0.0f);
    }
    x = door_x + 0.5f * door_width + 0.15f;
  }
  for (int k = 0; k < bays; ++k) {
    const float wx = (static_cast<float>(k) + 0.5f) * pitch;
    if (k == door_bay)
      door(b, style, f.accent, wx, door_width, door_height, true);
    else
      window(b, style, wx, 1.15f, style.window_width_m, style.window_height_m,
             style.head == Head::pediment ? Head::hood : style.head, false, dice);
  }
}

}  // namespace

float eaves_height_m(const Style& s) {
  return s.ground_height_m + s.floor_height_m * static_cast<float>(s.floors) + 0.5f;
}

void wall_with_openings(Builder& b, const Paint& paint, float width, float y0, float y1,
                        std::vector<Opening> openings) {
  std::sort(openings.begin(), openings.end(), [](const Opening& a, const Opening& c) { return a.x0 < c.x0; });
  float x = 0.0f;
  for (const Opening& o : openings) {
    b.quad(paint, {x, y0, 0}, {o.x0, y0, 0}, {o.x0, y1, 0}, {x, y1, 0});
    b.quad(paint, {o.x0, y0, 0}, {o.x1, y0, 0}, {o.x1, o.y0, 0}, {o.x0, o.y0, 0});
    b.quad(paint, {o.x0, o.y1, 0}, {o.x1, o.y1, 0}, {o.x1, y1, 0}, {o.x0, y1, 0});
    x = o.x1;
  }
  b.quad(paint, {x, y0, 0}, {width, y0, 0}, {width, y1, 0}, {x, y1, 0});
}

void door(Builder& parent, const Style& style, glm::vec3 colour, float x, float w, float h, bool lamp_above) {
  Builder b = parent.moved({x, 0.1f, 0.0f});
  const float d = 0.35f;
  const float l = -0.5f * w;
  const float r = 0.5f * w;
  const Paint trim = plain(style.trim, Finish::stone);
  const Paint leaf = plain(colour, Finish::gloss);
  b.quad(trim, {l, 0, 0}, {l, 0, -d}, {l, h, -d}, {l, h, 0});
  b.quad(trim, {r, 0, -d}, {r, 0, 0}, {r, h, 0}, {r, h, -d});
  b.quad(trim, {l, h, -d}, {r, h, -d}, {r, h, 0}, {l, h, 0});
  const float light = h - 0.5f;  // a fanlight over the leaf
  b.quad(leaf, {l, 0, -d}, {r, 0, -d}, {r, light, -d}, {l, light, -d});
  b.picture(Mat::panes, glm::vec3(1.0f), pane_rect(5), {l, light, -d}, {r, light, -d}, {r, h, -d}, {l, h, -d});
  b.box(leaf, {l, light - 0.05f, -d}, {r, light + 0.03f, -d + 0.07f}, face_front | face_top | face_bottom);
  const int leaves = w > 1.8f ? 2 : 1;
  for (int k = 0; k < leaves; ++k) {
    const float x0 = l + w * static_cast<float>(k) / static_cast<float>(leaves);
    const float x1 = x0 + w / static_cast<float>(leaves);
    for (int p = 0; p < 3; ++p) {  // raised panels
      const float y0 = 0.15f + static_cast<float>(p) * (light - 0.25f) / 3.0f;
      b.box(leaf, {x0 + 0.14f, y0, -d}, {x1 - 0.14f, y0 + (light - 0.25f) / 3.0f - 0.12f, -d + 0.035f}, face_no_back);
    }
    b.box(plain({0.75f, 0.5f, 0.2f}, Finish::brass), {x1 - 0.10f, 1.0f, -d}, {x1 - 0.06f, 1.14f, -d + 0.07f},
          face_no_back);
  }
  b.box(trim, {l - 0.15f, 0.0f, 0.0f}, {l, h + 0.15f, 0.07f}, face_front | face_sides | face_top);
  b.box(trim, {r, 0.0f, 0.0f}, {r + 0.15f, h + 0.15f, 0.07f}, face_front | face_sides | face_top);
  b.box(trim, {l, h, 0.0f}, {r, h + 0.15f, 0.07f}, face_front | face_top | face_bottom);
  const std::array<glm::vec2, 4> hood{{{0.0f, h + 0.30f}, {0.30f, h + 0.36f}, {0.34f, h + 0.44f}, {0.0f, h + 0.47f}}};
  b.moulding(trim, hood, l - 0.3f, r + 0.3f);
  // Steps up from the pavement.
  b.box(trim, {l - 0.1f, -0.1f, 0.0f}, {r + 0.1f, 0.15f, 0.36f}, face_no_back & ~face_bottom);
  b.box(trim, {l - 0.2f, -0.1f, 0.36f}, {r + 0.2f, 0.09f, 0.66f}, face_no_back & ~face_bottom);
  b.quad(trim, {l, 0.15f, 0}, {r, 0.15f, 0}, {r, 0.15f, -d}, {l, 0.15f, -d});
  if (lamp_above) {
    const Paint iron = plain(glm::vec3(0.03f), Finish::iron);
    b.box(iron, {-0.02f, h + 0.16f, 0.0f}, {0.02f, h + 0.2f, 0.22f}, face_no_back);
    b.box(glow(Glow::candle), {-0.06f, h + 0.02f, 0.14f}, {0.06f, h + 0.16f, 0.26f}, face_all);
    b.box(iron, {-0.08f, h + 0.16f, 0.12f}, {0.08f, h + 0.19f, 0.28f}, face_all);
  }
}

void facade(Builder& b, const Style& style, const Facade& f, Dice& dice) {
  const float eaves = eaves_height_m(style);
  const float upper = style.ground_height_m + style.floor_height_m * static_cast<float>(style.floors);
  if (f.ground == Ground::house || f.ground == Ground::gate) house_ground(b, style, f, dice);
  if (f.ground == Ground::shop) shop_front(b, style, f, 0.0f, f.width_m, dice);
  upper_floors(b, style, f, dice);
  b.quad(style.wall, {0, upper, 0}, {f.width_m, upper, 0}, {f.width_m, eaves, 0}, {0, eaves, 0});
  string_course(b, style, f, style.ground_height_m, 0.2f);
  cornice(b, style, f, eaves);
  const Paint trim = plain(style.trim * 0.95f, Finish::stone);
  if (style.quoins) {
    const float from = style.ground_height_m + 0.1f;
    quoins(b, trim, 0.0f, 1.0f, from, upper);
    quoins(b, trim, f.width_m, -1.0f, from, upper);
  }
  if (f.downpipe) downpipe(b, 0.22f, eaves);
}

}  // namespace petrichor::city
