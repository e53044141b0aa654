// Interiors behind windows: what a passer-by sees looking up at night, a few dozen pixels each.
#include <algorithm>
#include <array>
#include <cmath>

#include "content/city/atlases.hpp"
#include "content/city/dice.hpp"

namespace petrichor::city {
namespace {

constexpr int pane_px = 256;
constexpr int shop_px = 512;

float smooth(float low, float high, float x) {
  const float t = std::clamp((x - low) / (high - low), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}
glm::vec3 blend(glm::vec3 a, glm::vec3 b, float t) {
  return a + (b - a) * std::clamp(t, 0.0f, 1.0f);
}
float inside_disc(glm::vec2 p, glm::vec2 centre, glm::vec2 radius, float soft = 0.05f) {
  const glm::vec2 d = (p - centre) / radius;
  return smooth(1.0f + soft, 1.0f - soft, glm::length(d));
}
float inside_box(glm::vec2 p, glm::vec2 low, glm::vec2 high) {
  return p.x > low.x && p.x < high.x && p.y > low.y && p.y < high.y ? 1.0f : 0.0f;
}

struct Room {
  glm::vec3 light;  // colour of the lamp
  float level;      // brightness of the wall beside the lamp, of full scale
  glm::vec2 lamp;   // 0..1, y down
  int fitting;      // 0 pendant, 1 standing lamp, 2 none in view, 3 television
  int curtain;      // 0 none, 1 drapes, 2 sheer, 3 roller blind
  glm::vec3 cloth;
  glm::vec3 wall;
  int thing;  // 0 nothing, 1 plant, 2 person, 3 cat, 4 bookshelf, 5 picture
};

const std::array<Room, 12> rooms{{
    {{1.0f, 0.62f, 0.27f}, 0.30f, {0.55f, 0.30f}, 0, 1, {0.5f, 0.12f, 0.08f}, {0.9f, 0.75f, 0.5f}, 1},
    {{1.0f, 0.70f, 0.38f}, 0.22f, {0.25f, 0.48f}, 1, 2, {0.9f, 0.85f, 0.7f}, {0.8f, 0.8f, 0.7f}, 0},
    {{1.0f, 0.58f, 0.22f}, 0.36f, {0.70f, 0.42f}, 1, 1, {0.15f, 0.25f, 0.16f}, {0.75f, 0.55f, 0.35f}, 4},
    {{1.0f, 0.74f, 0.44f}, 0.26f, {0.45f, 0.22f}, 0, 3, {0.85f, 0.7f, 0.45f}, {0.9f, 0.85f, 0.7f}, 3},
    {{1.0f, 0.66f, 0.32f}, 0.42f, {0.30f, 0.26f}, 0, 1, {0.35f, 0.30f, 0.24f}, {0.95f, 0.85f, 0.6f}, 2},
    {{1.0f, 0.60f, 0.25f}, 0.16f, {0.80f, 0.35f}, 2, 2, {0.95f, 0.8f, 0.6f}, {0.9f, 0.7f, 0.5f}, 2},
    {{0.45f, 0.62f, 1.0f}, 0.13f, {0.40f, 0.62f}, 3, 1, {0.2f, 0.2f, 0.3f}, {0.6f, 0.7f, 0.8f}, 2},
    {{1.0f, 0.55f, 0.20f}, 0.24f, {0.60f, 0.50f}, 1, 1, {0.6f, 0.4f, 0.15f}, {0.7f, 0.4f, 0.25f}, 5},
    {{1.0f, 0.78f, 0.52f}, 0.34f, {0.50f, 0.16f}, 0, 0, {0, 0, 0}, {0.85f, 0.85f, 0.8f}, 4},
    {{1.0f, 0.64f, 0.30f}, 0.20f, {0.15f, 0.40f}, 1, 3, {0.75f, 0.3f, 0.12f}, {0.8f, 0.7f, 0.5f}, 1},
    {{1.0f, 0.68f, 0.36f}, 0.30f, {0.75f, 0.28f}, 0, 2, {0.75f, 0.5f, 0.3f}, {0.95f, 0.8f, 0.6f}, 5},
    {{1.0f, 0.72f, 0.42f}, 0.10f, {0.50f, 0.36f}, 2, 1, {0.25f, 0.12f, 0.2f}, {0.7f, 0.6f, 0.5f}, 0},
}};

// Folds of hanging cloth: brightness across x.
float folds(float x, float y, std::uint32_t seed) {
  return 0.7f + 0.3f * std::sin(x * 75.0f + 4.0f * std::sin(x * 17.0f + static_cast<float>(seed)) + 1.5f * y);
}

glm::vec3 lit_room(const Room& room, glm::vec2 p, std::uint32_t seed) {
  // Seen from below: ceiling, then the back wall, then dark furniture.
  const float ceiling = 0.20f + 0.03f * std::abs(p.x - 0.5f);
  const glm::vec2 to_lamp = p - room.lamp;
  const float near_lamp = 1.0f / (1.0f + 7.0f * glm::dot(to_lamp, to_lamp));
  glm::vec3 colour = room.wall * room.light * room.level * (0.25f + 0.75f * near_lamp);
  if (p.y < ceiling) colour = glm::vec3(0.9f) * room.light * room.level * (0.3f + 0.7f * near_lamp);
  if (std::abs(p.y - ceiling) < 0.008f) colour *= 0.55f;
  const float corner = std::abs(p.x - (seed % 2 ? 0.12f : 0.9f));
  if (corner < 0.008f && p.y > ceiling) colour *= 0.6f;
  const glm::vec3 shade(0.03f, 0.02f, 0.015f);
  if (room.thing == 4) {  // shelves of books
    const float shelf = inside_box(p, {0.08f, 0.40f}, {0.5f, 1.0f});
    if (shelf > 0.0f) {
      const float row = std::floor((p.y - 0.40f) / 0.13f);
      const float in_row = (p.y - 0.40f) / 0.13f - row;
      const int spine = static_cast<int>(p.x / 0.021f);
      const std::uint32_t h = mix(seed, static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(spine));
      const float tall = 0.15f + 0.3f * unit(h);
      const glm::vec3 cloth(0.25f + 0.6f * unit(mix(h, 1)), 0.15f + 0.4f * unit(mix(h, 2)),
                            0.12f + 0.3f * unit(mix(h, 3)));
      colour = in_row > tall ? colour * cloth * 0.9f : colour * 0.25f;
      if (in_row > 0.92f) colour = colour * 0.4f;
    }
  }
  if (room.thing == 5) {  // a framed picture
    if (inside_box(p, {0.14f, 0.34f}, {0.40f, 0.62f}) > 0) colour *= 0.25f;
    if (inside_box(p, {0.16f, 0.365f}, {0.38f, 0.595f}) > 0)
      colour = colour * 3.0f * glm::vec3(0.8f, 0.9f, 0.7f) * (0.5f + p.y);
  }
  if (room.thing == 1) {  // leaves of a plant on the sill
    float leaf = 0.0f;
    for (std::uint32_t k = 0; k < 14; ++k) {
      const float a = -2.7f + 2.3f * unit(mix(seed, k));
      const float r = 0.08f + 0.16f * unit(mix(seed, k, 9));
      const glm::vec2 c = glm::vec2(0.28f, 0.86f) + r * glm::vec2(std::cos(a), std::sin(a));
      leaf = std::max(leaf, inside_disc(p, c, {0.055f, 0.03f}, 0.2f));
    }
    leaf = std::max(leaf, inside_box(p, {0.23f, 0.88f}, {0.34f, 1.0f}));
    colour = blend(colour, colour * glm::vec3(0.05f, 0.10f, 0.04f), leaf);
  }
  if (room.thing == 2) {  // somebody standing
    const float x = seed % 3 ? 0.63f : 0.36f;
    float body = inside_disc(p, {x, 0.56f}, {0.062f, 0.085f});
    body = std::max(body, inside_box(p, {x - 0.025f, 0.6f}, {x + 0.025f, 0.7f}));
    body = std::max(body, inside_disc(p, {x, 0.95f}, {0.16f, 0.28f}));
    colour = blend(colour, shade * room.light * (0.3f + 2.0f * room.level), body);
  }
  if (room.thing == 3) {  // a cat on the sill
    float cat = inside_disc(p, {0.70f, 0.90f}, {0.075f, 0.12f});
    cat = std::max(cat, inside_disc(p, {0.70f, 0.76f}, {0.05f, 0.048f}));
    for (float side : {-1.0f, 1.0f}) {
      const glm::vec2 ear(0.70f + side * 0.033f, 0.70f);
      if (p.y > ear.y - 0.02f && p.y < ear.y + 0.05f && std::abs(p.x - ear.x) < 0.018f * (p.y - ear.y + 0.02f) / 0.05f)
        cat = 1;
    }
    colour = blend(colour, shade, cat);
  }
  if (room.fitting == 0) {  // pendant
    if (p.y < room.lamp.y && std::abs(p.x - room.lamp.x) < 0.006f) colour *= 0.2f;
    const float dome = p.y > room.lamp.y - 0.07f && p.y < room.lamp.y &&
                       std::abs(p.x - room.lamp.x) < 0.03f + 1.0f * (p.y - room.lamp.y + 0.07f);
    colour = blend(colour, room.light * 0.8f, dome ? 0.85f : 0.0f);
    colour =
        blend(colour, glm::vec3(1.0f, 0.92f, 0.75f), inside_disc(p, room.lamp + glm::vec2(0, 0.012f), {0.06f, 0.022f}));
  } else if (room.fitting == 1) {  // standing lamp with a shade
    const float dx = std::abs(p.x - room.lamp.x);
    const float dy = p.y - room.lamp.y;
    if (dx < 0.008f && dy > 0.0f) colour *= 0.3f;
    if (dy > -0.12f && dy < 0.05f && dx < 0.055f + 0.3f * (dy + 0.12f)) {
      colour = room.light * (0.55f + 0.45f * smooth(0.1f, 0.0f, std::abs(dy + 0.03f)));
    }
  } else if (room.fitting == 3) {
    if (inside_box(p, room.lamp - glm::vec2(0.14f, 0.09f), room.lamp + glm::vec2(0.14f, 0.09f)) > 0) {
      colour =
          room.light *
          (0.3f + 0.5f * unit(mix(seed, static_cast<std::uint32_t>(p.x * 18), static_cast<std::uint32_t>(p.y * 18))));
    }
  }
  if (room.curtain == 1) {
    const float open = 0.20f + 0.05f * std::sin(7.0f * p.y) * p.y;
    const float edge = std::min(p.x, 1.0f - p.x);
    if (edge < open) {
      const float through = 0.25f + 0.5f * near_lamp;
      colour = room.cloth * room.light * room.level * through * folds(p.x, p.y, seed) *
               (0.6f + 0.4f * smooth(0.0f, open, edge));
    }
  } else if (room.curtain == 2) {
    const glm::vec3 veil =
        room.cloth * room.light * room.level * (0.35f + 0.65f * near_lamp) * (0.55f + 0.45f * folds(p.x, p.y, seed));
    colour = blend(colour, veil, 0.75f);
  } else if (room.curtain == 3) {
    if (p.y < 0.46f) {
      colour = room.cloth * room.light * room.level * (0.45f + 0.55f * near_lamp);
      if (p.y > 0.445f) colour *= 0.4f;
    }
  }
  return colour;
}

// Base colour of a pane and what little a dark room gives back.
glm::vec3 dark_room(int kind, glm::vec2 p, std::uint32_t seed, bool emission) {
  glm::vec3 colour(0.004f, 0.005f, 0.006f);
  const float edge = std::min(p.x, 1.0f - p.x);
  if (kind == 0 && edge < 0.24f) colour = glm::vec3(0.045f, 0.042f, 0.04f) * folds(p.x, p.y, seed);
  if (kind == 1) colour = glm::vec3(0.05f, 0.048f, 0.044f) * folds(p.x, p.y, seed) * (0.6f + 0.4f * p.y);
  if (kind == 2 && p.y < 0.55f) colour = glm::vec3(0.055f, 0.05f, 0.04f);
  if (kind == 3 && edge < 0.12f) colour = glm::vec3(0.03f, 0.012f, 0.01f) * folds(p.x, p.y, seed);
  if (!emission) return colour;
  // A door left ajar far inside.
  return kind == 3 && inside_box(p, {0.55f, 0.45f}, {0.60f, 1.0f}) > 0 ? glm::vec3(0.05f, 0.03f, 0.012f)
                                                                       : glm::vec3(0.0f);
}

glm::vec3 shelf_of_goods(Goods goods, glm::vec2 p) {
  const std::uint32_t seed = 700 + static_cast<std::uint32_t>(goods);
  const glm::vec3 warm(1.0f, 0.72f, 0.40f);
  const float spot = 0.35f + 0.65f * std::abs(std::sin(p.x * 9.42f));  // three down-lights
  glm::vec3 colour = warm * 0.075f * (0.4f + 0.6f * spot) * smooth(1.1f, 0.0f, p.y);
  if (p.y < 0.07f) colour = warm * (0.25f + 0.7f * smooth(0.75f, 1.0f, std::abs(std::sin(p.x * 9.42f))));
  const float rows = goods == Goods::books ? 6.0f : goods == Goods::bakery ? 5.0f : 3.0f;
  const float y = (p.y - 0.12f) / 0.74f * rows;
  const float row = std::floor(y);
  const float in_row = y - row;
  if (goods == Goods::cafe) {
    // Pendants over a counter, bottles behind, guests in front.
    if (p.y > 0.25f && p.y < 0.5f && std::fmod(p.x, 0.03f) < 0.02f && p.x > 0.1f && p.x < 0.9f) {
      const std::uint32_t h =
          mix(seed, static_cast<std::uint32_t>(p.x / 0.03f), static_cast<std::uint32_t>((p.y - 0.25f) / 0.125f));
      if (std::fmod(p.y - 0.25f, 0.125f) > 0.03f + 0.04f * unit(h)) {
        colour = glm::vec3(0.2f + 0.6f * unit(mix(h, 1)), 0.3f + 0.4f * unit(mix(h, 2)), 0.15f) * 0.28f * spot;
      }
    }
    for (float x : {0.2f, 0.5f, 0.8f}) {
      colour += warm * 0.05f / (0.02f + 6.0f * glm::dot(p - glm::vec2(x, 0.3f), p - glm::vec2(x, 0.3f)));
      colour = blend(colour, glm::vec3(1.0f, 0.85f, 0.6f), inside_disc(p, {x, 0.3f}, {0.035f, 0.025f}));
      if (p.y < 0.28f && std::abs(p.x - x) < 0.003f) colour *= 0.2f;
    }
    if (p.y > 0.66f) colour = glm::vec3(0.16f, 0.07f, 0.03f) * spot * (p.y < 0.68f ? 2.0f : 0.6f);
    for (float x : {0.16f, 0.34f, 0.68f}) {
      const float body =
          std::max(inside_disc(p, {x, 0.58f}, {0.04f, 0.055f}), inside_disc(p, {x, 0.86f}, {0.09f, 0.23f}));
      colour = blend(colour, glm::vec3(0.02f, 0.013f, 0.01f), body);
    }
    return colour;
  }
  if (goods == Goods::tailor) {
    for (float x : {0.22f, 0.5f, 0.78f}) {  // dress forms
      float form = inside_disc(p, {x, 0.42f}, {0.075f, 0.14f});
      form = std::max(form, inside_disc(p, {x, 0.66f}, {0.11f - 0.05f * (x == 0.5f), 0.2f}));
      form = std::max(form, inside_box(p, {x - 0.006f, 0.8f}, {x + 0.006f, 0.95f}));
      const glm::vec3 cloth = x < 0.3f   ? glm::vec3(0.45f, 0.08f, 0.08f)
                              : x < 0.6f ? glm::vec3(0.1f, 0.18f, 0.35f)
                                         : glm::vec3(0.5f, 0.4f, 0.2f);
      const float shade = 0.4f + 0.6f * smooth(-0.12f, 0.08f, p.x - x);
      colour = blend(colour, cloth * 0.5f * shade * (1.2f - p.y), form);
    }
    if (p.y > 0.93f) colour = glm::vec3(0.2f, 0.12f, 0.06f) * spot;
    return colour;
  }
  if (p.y > 0.12f && p.y < 0.86f) {
    const float width = goods == Goods::books ? 0.016f : 0.052f;
    const int item = static_cast<int>(p.x / width);
    const float fx = p.x / width - static_cast<float>(item);
    const std::uint32_t h = mix(seed, static_cast<std::uint32_t>(row), static_cast<std::uint32_t>(item));
    const float tall = 0.15f + (goods == Goods::books ? 0.28f : 0.35f) * unit(h);
    if (in_row > 0.93f) {
      colour = glm::vec3(0.22f, 0.12f, 0.05f) * spot;
    } else if (in_row > tall) {
      if (goods == Goods::books) {
        const glm::vec3 cloth(0.2f + 0.7f * unit(mix(h, 1)), 0.12f + 0.5f * unit(mix(h, 2)),
                              0.1f + 0.45f * unit(mix(h, 3)));
        colour =
            cloth * 0.32f * spot * (fx > 0.08f ? 1.0f : 0.3f) * (std::abs(in_row - tall - 0.15f) < 0.02f ? 1.8f : 1.0f);
      } else {
        // Loaves and cakes between jars and bottles.
        const bool jar = unit(mix(h, 5)) > 0.45f;
        const glm::vec3 crust = blend(glm::vec3(0.6f, 0.28f, 0.08f), glm::vec3(0.75f, 0.5f, 0.25f), unit(mix(h, 4)));
        const glm::vec3 bottle(0.12f + 0.5f * unit(mix(h, 6)), 0.2f + 0.35f * unit(mix(h, 7)),
                               0.10f + 0.4f * unit(mix(h, 8)));
        const float body = jar ? inside_box({fx, in_row}, {0.22f, tall + 0.12f}, {0.78f, 0.93f}) +
                                     inside_box({fx, in_row}, {0.38f, tall}, {0.62f, tall + 0.12f})
                               : inside_disc({fx, in_row}, {0.5f, 0.93f}, {0.46f, 0.93f - tall});
        const glm::vec3 ware =
            jar ? bottle * (std::abs(in_row - 0.72f) < 0.1f ? 1.6f : 0.8f) * (0.7f + 0.6f * fx) : crust;
        colour = blend(colour, ware * 0.45f * spot * (1.1f - 0.5f * in_row), body);
      }
    } else {
      colour *= 0.5f;
    }
  }
  if (p.y >= 0.86f) colour = glm::vec3(0.13f, 0.07f, 0.03f) * (p.y < 0.88f ? 2.0f : 0.8f) * spot;
  return colour;
}

}  // namespace

Atlas pane_atlas() {
  Atlas atlas{Picture(4 * pane_px, 4 * pane_px), Picture(4 * pane_px, 4 * pane_px)};
  for (int y = 0; y < 4 * pane_px; ++y) {
    for (int x = 0; x < 4 * pane_px; ++x) {
      const int tile = (y / pane_px) * 4 + x / pane_px;
      const glm::vec2 p((static_cast<float>(x % pane_px) + 0.5f) / pane_px,
                        (static_cast<float>(y % pane_px) + 0.5f) / pane_px);
      const auto seed = static_cast<std::uint32_t>(tile);
      const bool lit = tile < lit_panes;
      const glm::vec3 emission =
          lit ? lit_room(rooms[static_cast<std::size_t>(tile)], p, seed) : dark_room(tile - lit_panes, p, seed, true);
      const glm::vec3 base = lit ? glm::vec3(0.02f) : dark_room(tile - lit_panes, p, seed, false);
      for (int c = 0; c < 3; ++c) {
        atlas.base_colour.at(x, y)[c] = to_byte(to_srgb(base[c]));
        atlas.emission.at(x, y)[c] = to_byte(to_srgb(emission[c]));
      }
    }
  }
  return atlas;
}

UvRect pane_rect(int index) {
  const glm::vec2 corner(static_cast<float>(index % 4) / 4.0f, static_cast<float>(index / 4) / 4.0f);
  const float inset = 1.5f / (4 * pane_px);
  return {corner + inset, corner + 0.25f - inset};
}

Atlas shopfront_atlas() {
  Atlas atlas{Picture(2 * shop_px, 2 * shop_px), Picture(2 * shop_px, 2 * shop_px)};
  for (int y = 0; y < 2 * shop_px; ++y) {
    for (int x = 0; x < 2 * shop_px; ++x) {
      const int tile = (y / shop_px) * 2 + x / shop_px;
      const glm::vec2 p((static_cast<float>(x % shop_px) + 0.5f) / shop_px,
                        (static_cast<float>(y % shop_px) + 0.5f) / shop_px);
      const glm::vec3 emission = shelf_of_goods(static_cast<Goods>(tile), p);
      for (int c = 0; c < 3; ++c) {
        atlas.base_colour.at(x, y)[c] = to_byte(to_srgb(0.02f));
        atlas.emission.at(x, y)[c] = to_byte(to_srgb(emission[c]));
      }
    }
  }
  return atlas;
}

UvRect goods_rect(Goods goods) {
  const int tile = static_cast<int>(goods);
  const glm::vec2 corner(static_cast<float>(tile % 2) / 2.0f, static_cast<float>(tile / 2) / 2.0f);
  const float inset = 1.5f / (2 * shop_px);
  return {corner + inset, corner + 0.5f - inset};
}

}  // namespace petrichor::city
