// The sign atlas: boards, posters and plates, painted or lit from behind.
#include <algorithm>
#include <array>
#include <cmath>

#include "content/city/atlases.hpp"
#include "content/city/dice.hpp"
#include "content/city/lettering.hpp"

namespace petrichor::city {
namespace {

constexpr int atlas_px = 1024;

struct Board {
  const char* text;
  Font font;
  TextBox place;     // pixels in the atlas
  glm::vec3 ground;  // linear
  glm::vec3 letters;
  float ground_shine;  // emission of the ground and of the letters, of full scale
  float letter_shine;
};

const glm::vec3 gold(0.75f, 0.50f, 0.14f);
const glm::vec3 cream(0.72f, 0.66f, 0.50f);

// In the order of Sign.
const std::array<Board, static_cast<std::size_t>(Sign::count)> boards{{
    {"Quill & Quarto", Font::serif, {0, 0, 512, 72}, {0.012f, 0.045f, 0.03f}, gold, 0, 0.10f},
    {"Café Luna", Font::script, {512, 0, 512, 72}, {0.10f, 0.015f, 0.012f}, cream, 0, 0.16f},
    {"Bakery", Font::script, {0, 72, 512, 72}, {0.025f, 0.05f, 0.09f}, cream, 0, 0.12f},
    {"A. Finch, Tailor", Font::serif, {512, 72, 512, 72}, {0.015f, 0.013f, 0.012f}, gold, 0, 0.08f},
    {"Antiques & Curios", Font::serif, {0, 144, 512, 72}, {0.06f, 0.035f, 0.015f}, cream, 0, 0.06f},
    {"Wines", Font::script, {512, 144, 512, 72}, {0.05f, 0.008f, 0.02f}, gold, 0, 0.10f},
    {"Clocks & Watches", Font::serif, {0, 216, 512, 72}, {0.014f, 0.02f, 0.05f}, gold, 0, 0.08f},
    {"Florist", Font::script, {512, 216, 512, 72}, {0.03f, 0.075f, 0.04f}, cream, 0, 0.10f},
    {"Barber", Font::serif, {0, 288, 512, 72}, {0.25f, 0.23f, 0.20f}, {0.2f, 0.02f, 0.02f}, 0, 0},
    {"PHARMACY", Font::sans, {512, 288, 512, 72}, {0.01f, 0.12f, 0.05f}, {0.8f, 0.9f, 0.85f}, 0.10f, 0.75f},
    {"Marlowe’s Toys & Trains", Font::script, {0, 360, 1024, 96}, {0.11f, 0.008f, 0.012f}, gold, 0.004f, 0.20f},
    {"LAMPLIGHTER STREET", Font::condensed, {0, 456, 320, 64}, {0.012f, 0.03f, 0.11f}, {0.7f, 0.7f, 0.66f}, 0, 0},
    {"WEATHERCOCK LANE", Font::condensed, {320, 456, 320, 64}, {0.012f, 0.03f, 0.11f}, {0.7f, 0.7f, 0.66f}, 0, 0},
    {"BUS 7", Font::sans, {640, 456, 192, 96}, {0.55f, 0.34f, 0.02f}, {0.02f, 0.02f, 0.02f}, 0.12f, 0},
    {"NEWS", Font::serif, {0, 520, 320, 64}, {0.02f, 0.05f, 0.035f}, cream, 0.0f, 0.5f},
    {"TELEPHONE", Font::serif, {320, 520, 320, 64}, {0.8f, 0.75f, 0.6f}, {0.02f, 0.015f, 0.01f}, 0.45f, 0},
    {"HOTEL METEOR", Font::serif, {832, 456, 192, 96}, {0.015f, 0.012f, 0.012f}, gold, 0, 0.1f},
    {"PTR·1024", Font::condensed, {640, 552, 192, 48}, {0.6f, 0.58f, 0.5f}, {0.01f, 0.01f, 0.01f}, 0.02f, 0},
    {"", Font::serif, {0, 600, 283, 424}, {0.02f, 0.02f, 0.05f}, cream, 0, 0},
    {"", Font::serif, {283, 600, 283, 424}, {0.1f, 0.3f, 0.4f}, cream, 0, 0},
    {"", Font::serif, {566, 600, 256, 256}, {0.6f, 0.55f, 0.42f}, cream, 0, 0},
    {"", Font::serif, {822, 600, 202, 202}, {0.09f, 0.05f, 0.02f}, gold, 0, 0},
    {"TAXI", Font::sans, {832, 552, 192, 48}, {0.8f, 0.42f, 0.05f}, {0.01f, 0.008f, 0.005f}, 0.35f, 0},
    {"CINEMA · THE THIRD UMBRELLA · 8.15 · LAST WEEK",
     Font::condensed,
     {566, 856, 458, 72},
     {0.8f, 0.78f, 0.7f},
     {0.03f, 0.01f, 0.01f},
     0.6f,
     0},
}};

using Shade = std::pair<glm::vec3, glm::vec3>;  // base colour, emission

// A concert poster: moon over rooftops and rain.
Shade concert(glm::vec2 p) {
  glm::vec3 c = glm::vec3(0.015f, 0.03f, 0.09f) + glm::vec3(0.20f, 0.10f, 0.10f) * p.y * p.y;
  const float moon = glm::length(p - glm::vec2(0.64f, 0.30f) * glm::vec2(1.0f, 1.0f));
  if (glm::length((p - glm::vec2(0.64f, 0.34f)) * glm::vec2(1.0f, 1.5f)) < 0.21f) c = {0.85f, 0.68f, 0.34f};
  c += glm::vec3(0.10f, 0.08f, 0.04f) / (1.0f + 30.0f * moon * moon);
  const int house = static_cast<int>(p.x * 7.0f);
  const float roof = 0.62f + 0.1f * unit(mix(5, static_cast<std::uint32_t>(house))) +
                     0.5f * std::abs(p.x * 7.0f - static_cast<float>(house) - 0.5f) / 7.0f;
  if (p.y > roof) {
    c = {0.008f, 0.008f, 0.02f};
    const glm::vec2 w(p.x * 28.0f, p.y * 26.0f);
    const glm::vec2 f = w - glm::floor(w);
    if (f.x > 0.3f && f.x < 0.8f && f.y > 0.3f && f.y < 0.85f && p.y > roof + 0.05f && p.y < 0.93f &&
        unit(mix(9, static_cast<std::uint32_t>(w.x), static_cast<std::uint32_t>(w.y))) > 0.62f) {
      c = {0.9f, 0.55f, 0.12f};
    }
  }
  const float rain = p.x * 40.0f + p.y * 6.0f;
  if (unit(mix(3, static_cast<std::uint32_t>(rain),
               static_cast<std::uint32_t>(p.y * 22.0f + 7.0f * std::floor(rain)))) > 0.86f &&
      rain - std::floor(rain) < 0.16f) {
    c += glm::vec3(0.10f, 0.13f, 0.2f);
  }
  return {c, c * 0.22f};
}

// A travel poster: sun, sea and a sail.
Shade sea(glm::vec2 p) {
  glm::vec3 c = glm::vec3(0.95f, 0.55f, 0.18f) * (0.5f + p.y) * 0.8f;
  if (glm::length((p - glm::vec2(0.35f, 0.52f)) * glm::vec2(1.0f, 1.5f)) < 0.2f) c = {1.0f, 0.85f, 0.45f};
  if (p.y > 0.55f + 0.006f * std::sin(p.x * 40.0f)) {
    const float wave = std::sin(p.y * 90.0f + 2.0f * std::sin(p.x * 9.0f));
    c = wave > 0.3f ? glm::vec3(0.03f, 0.22f, 0.30f) : glm::vec3(0.02f, 0.13f, 0.21f);
    if (std::abs(p.x - 0.35f) < 0.12f * (1.0f - p.y) * 2 && wave > 0.0f) c = {0.9f, 0.6f, 0.25f};
  }
  const glm::vec2 s = p - glm::vec2(0.70f, 0.62f);
  if (s.y < 0.0f && s.y > -0.3f && s.x > 0.0f && s.x < 0.17f * (s.y + 0.3f) / 0.3f) c = glm::vec3(0.85f);
  if (s.y < -0.03f && s.y > -0.26f && s.x < -0.01f && -s.x < 0.11f * (s.y + 0.3f) / 0.3f) c = {0.75f, 0.1f, 0.06f};
  if (s.y > 0.01f && s.y < 0.045f && std::abs(s.x - 0.02f) < 0.17f - 2.0f * s.y) c = {0.06f, 0.02f, 0.01f};
  return {c, c * 0.24f};
}

Shade clock(glm::vec2 p) {
  const glm::vec2 d = (p - 0.5f) * 2.0f;
  const float r = glm::length(d);
  glm::vec3 c(0.75f, 0.66f, 0.45f);
  const float hours = std::atan2(d.x, -d.y) / 6.2831853f * 12.0f;
  const float off_mark = std::abs(hours - std::round(hours)) * r;
  if (r > 0.72f && r < 0.88f && off_mark < 0.045f) c = glm::vec3(0.01f);
  if (r > 0.92f) c = glm::vec3(0.02f, 0.015f, 0.01f);
  const auto hand = [&](float turn, float length, float width) {
    const glm::vec2 along(std::sin(turn * 6.2831853f), -std::cos(turn * 6.2831853f));
    const float a = glm::dot(d, along);
    const float b = std::abs(d.x * along.y - d.y * along.x);
    return a > -0.1f && a < length && b < width * (1.1f - a / length);
  };
  if (hand(0.965f, 0.48f, 0.07f) || hand(0.58f, 0.74f, 0.045f)) c = glm::vec3(0.01f);
  return {c, c * glm::vec3(1.0f, 0.85f, 0.55f) * 0.42f};
}

// The toy shop's hanging board: a bear.
Shade bear(glm::vec2 p) {
  const auto disc = [&](float x, float y, float r) { return glm::length(p - glm::vec2(x, y)) < r; };
  glm::vec3 c(0.10f, 0.012f, 0.016f);
  const float rim = glm::length(p - 0.5f);
  if (rim > 0.44f && rim < 0.47f) c = gold;
  const glm::vec3 fur(0.50f, 0.27f, 0.09f);
  if (disc(0.5f, 0.66f, 0.19f) || disc(0.5f, 0.38f, 0.155f) || disc(0.37f, 0.26f, 0.065f) ||
      disc(0.63f, 0.26f, 0.065f) || disc(0.31f, 0.6f, 0.075f) || disc(0.69f, 0.6f, 0.075f) ||
      disc(0.38f, 0.82f, 0.08f) || disc(0.62f, 0.82f, 0.08f))
    c = fur;
  if (disc(0.5f, 0.44f, 0.06f) || disc(0.5f, 0.68f, 0.11f)) c = {0.72f, 0.5f, 0.24f};
  if (disc(0.44f, 0.35f, 0.02f) || disc(0.56f, 0.35f, 0.02f) || disc(0.5f, 0.42f, 0.024f)) c = glm::vec3(0.01f);
  return {c, c * 0.06f};
}

void fill(Atlas& atlas, const TextBox& place, const std::function<Shade(glm::vec2)>& shade) {
  for (int y = 0; y < place.height; ++y) {
    for (int x = 0; x < place.width; ++x) {
      const Shade s = shade({(static_cast<float>(x) + 0.5f) / static_cast<float>(place.width),
                             (static_cast<float>(y) + 0.5f) / static_cast<float>(place.height)});
      for (int c = 0; c < 3; ++c) {
        atlas.base_colour.at(place.x + x, place.y + y)[c] = to_byte(to_srgb(s.first[c]));
        atlas.emission.at(place.x + x, place.y + y)[c] = to_byte(to_srgb(s.second[c]));
      }
    }
  }
}

}  // namespace

Atlas sign_atlas() {
  Atlas atlas{Picture(atlas_px, atlas_px), Picture(atlas_px, atlas_px)};
  for (std::size_t i = 0; i < boards.size(); ++i) {
    const Board& b = boards[i];
    const TextBox& at = b.place;
    const auto sign = static_cast<Sign>(i);
    if (sign == Sign::poster_concert) {
      fill(atlas, at, concert);
    } else if (sign == Sign::poster_sea) {
      fill(atlas, at, sea);
    } else if (sign == Sign::clock_face) {
      fill(atlas, at, clock);
    } else if (sign == Sign::hanging_bear) {
      fill(atlas, at, bear);
    } else {
      fill(atlas, at, [&](glm::vec2 p) {
        const float rim = std::min(std::min(p.x, 1.0f - p.x) * static_cast<float>(at.width),
                                   std::min(p.y, 1.0f - p.y) * static_cast<float>(at.height));
        const bool line = rim > 4.0f && rim < 6.5f;
        return Shade{line ? b.letters : b.ground, line ? b.letters * b.letter_shine : b.ground * b.ground_shine};
      });
      const TextBox inner{at.x + 14, at.y + 6, at.width - 28, at.height - 12};
      draw_text(atlas.base_colour, b.font, b.text, inner, b.letters, at.height * 3 / 4);
      draw_text(atlas.emission, b.font, b.text, inner, b.letters * b.letter_shine, at.height * 3 / 4);
    }
  }
  const auto poster_text = [&](Sign sign, float y, float height, Font font, const char* text, glm::vec3 colour) {
    const TextBox& at = boards[static_cast<std::size_t>(sign)].place;
    const TextBox line{at.x + 12, at.y + static_cast<int>(y * at.height), at.width - 24,
                       static_cast<int>(height * at.height)};
    draw_text(atlas.base_colour, font, text, line, colour, line.height);
    draw_text(atlas.emission, font, text, line, colour * 0.25f, line.height);
  };
  poster_text(Sign::poster_concert, 0.03f, 0.11f, Font::script, "Nocturnes", cream);
  poster_text(Sign::poster_concert, 0.13f, 0.05f, Font::serif, "for rain and orchestra", cream);
  poster_text(Sign::poster_concert, 0.93f, 0.05f, Font::sans, "TOWN HALL · SATURDAY 8 PM", gold);
  poster_text(Sign::poster_sea, 0.05f, 0.14f, Font::script, "To the Sea", {0.9f, 0.85f, 0.7f});
  poster_text(Sign::poster_sea, 0.90f, 0.06f, Font::sans, "BY THE NIGHT TRAIN", {0.9f, 0.85f, 0.7f});
  return atlas;
}

UvRect sign_rect(Sign sign) {
  const TextBox& at = boards[static_cast<std::size_t>(sign)].place;
  const glm::vec2 low(static_cast<float>(at.x) + 1.0f, static_cast<float>(at.y) + 1.0f);
  const glm::vec2 high(static_cast<float>(at.x + at.width) - 1.0f, static_cast<float>(at.y + at.height) - 1.0f);
  return {low / static_cast<float>(atlas_px), high / static_cast<float>(atlas_px)};
}

float sign_aspect(Sign sign) {
  const TextBox& at = boards[static_cast<std::size_t>(sign)].place;
  return static_cast<float>(at.width) / static_cast<float>(at.height);
}

}  // namespace petrichor::city
