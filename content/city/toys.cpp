#include "content/city/toys.hpp"

#include <array>
#include <cmath>

namespace petrichor::city {
namespace {

glm::vec3 bright(Dice& dice) {
  static const std::array<glm::vec3, 8> colours{{{0.60f, 0.04f, 0.03f},
                                                 {0.04f, 0.14f, 0.48f},
                                                 {0.65f, 0.42f, 0.03f},
                                                 {0.04f, 0.32f, 0.09f},
                                                 {0.62f, 0.20f, 0.30f},
                                                 {0.55f, 0.16f, 0.02f},
                                                 {0.60f, 0.56f, 0.48f},
                                                 {0.20f, 0.07f, 0.36f}}};
  return colours[static_cast<std::size_t>(dice.below(8))];
}

}  // namespace

void sphere(Builder& b, const Paint& paint, glm::vec3 centre, glm::vec3 radii, int around, int up) {
  b.surface(paint, around, up, [&](float u, float v) {
    const float a = 6.2831853f * u;
    const float e = 3.14159265f * (v - 0.5f);
    return centre + radii * glm::vec3(std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a));
  });
}

void ball(Builder b, float size, glm::vec3 a, glm::vec3 c) {
  const float r = 0.5f * size;
  const int gores = size < 0.35f ? 6 : 8;
  const int rows = size < 0.35f ? 3 : 5;
  for (int k = 0; k < gores; ++k) {
    b.surface(plain((k & 1) ? a : c, Finish::gloss), 1, rows, [&](float u, float v) {
      const float t = 6.2831853f * (static_cast<float>(k) + u) / gores;
      const float e = 3.14159265f * (v - 0.5f);
      return glm::vec3(0, r, 0) + r * glm::vec3(std::cos(e) * std::sin(t), std::sin(e), std::cos(e) * std::cos(t));
    });
  }
}

void bear(Builder b, float s, glm::vec3 fur) {
  const Paint f = plain(fur, Finish::matte);
  const Paint pale = plain(glm::min(fur * 1.7f + glm::vec3(0.05f), glm::vec3(0.8f)), Finish::matte);
  const Paint dark = plain(glm::vec3(0.01f), Finish::gloss);
  if (s < 0.5f) {  // on a shelf: no more than can be seen from the street
    sphere(b, f, glm::vec3(0, 0.30f, 0) * s, glm::vec3(0.24f, 0.30f, 0.2f) * s, 6, 4);
    sphere(b, f, glm::vec3(0, 0.74f, 0.02f) * s, glm::vec3(0.21f, 0.19f, 0.18f) * s, 6, 4);
    for (float x : {-1.0f, 1.0f}) {
      b.box(f, glm::vec3(0.16f * x - 0.06f, 0.82f, -0.04f) * s, glm::vec3(0.16f * x + 0.06f, 0.97f, 0.04f) * s,
            face_no_bottom & ~face_back);
      b.box(f, glm::vec3(0.15f * x - 0.08f, 0.0f, 0.05f) * s, glm::vec3(0.15f * x + 0.08f, 0.15f, 0.36f) * s,
            face_no_bottom & ~face_back);
    }
    return;
  }
  sphere(b, f, glm::vec3(0, 0.33f, 0) * s, glm::vec3(0.24f, 0.29f, 0.2f) * s);
  sphere(b, pale, glm::vec3(0, 0.32f, 0.07f) * s, glm::vec3(0.16f, 0.2f, 0.15f) * s, 7, 4);
  sphere(b, f, glm::vec3(0, 0.74f, 0.02f) * s, glm::vec3(0.21f, 0.19f, 0.18f) * s);
  sphere(b, pale, glm::vec3(0, 0.69f, 0.17f) * s, glm::vec3(0.09f, 0.07f, 0.07f) * s, 6, 4);
  for (float x : {-1.0f, 1.0f}) {
    sphere(b, f, glm::vec3(0.16f * x, 0.91f, 0) * s, glm::vec3(0.075f, 0.075f, 0.04f) * s, 6, 4);
    sphere(b, f, glm::vec3(0.27f * x, 0.42f, 0.07f) * s, glm::vec3(0.085f, 0.19f, 0.09f) * s, 6, 4);
    sphere(b, f, glm::vec3(0.17f * x, 0.09f, 0.2f) * s, glm::vec3(0.09f, 0.09f, 0.2f) * s, 6, 4);
    sphere(b, dark, glm::vec3(0.075f * x, 0.78f, 0.175f) * s, glm::vec3(0.02f) * s, 5, 3);
  }
  sphere(b, dark, glm::vec3(0, 0.715f, 0.235f) * s, glm::vec3(0.03f, 0.02f, 0.02f) * s, 5, 3);
}

void train(Builder b, float s, glm::vec3 colour) {
  const Paint body = plain(colour, Finish::gloss);
  const Paint black = plain(glm::vec3(0.015f), Finish::paint);
  const Paint brass = plain({0.75f, 0.5f, 0.2f}, Finish::brass);
  b.cylinder(body, glm::vec3(-0.25f, 0.45f, 0) * s, glm::vec3(0.62f, 0.45f, 0) * s, 0.2f * s, 0.2f * s, 10, false,
             true);
  b.box(body, glm::vec3(-0.7f, 0.25f, -0.24f) * s, glm::vec3(-0.25f, 0.85f, 0.24f) * s);
  b.box(black, glm::vec3(-0.76f, 0.85f, -0.28f) * s, glm::vec3(-0.2f, 0.92f, 0.28f) * s);
  b.box(black, glm::vec3(-0.75f, 0.16f, -0.2f) * s, glm::vec3(0.7f, 0.26f, 0.2f) * s);
  b.cylinder(black, glm::vec3(0.45f, 0.62f, 0) * s, glm::vec3(0.45f, 0.95f, 0) * s, 0.06f * s, 0.1f * s, 8, false,
             true);
  b.cylinder(brass, glm::vec3(0.1f, 0.62f, 0) * s, glm::vec3(0.1f, 0.75f, 0) * s, 0.08f * s, 0.05f * s, 8, false, true);
  for (float x : {-0.5f, -0.1f, 0.25f, 0.58f}) {
    for (float z : {-1.0f, 1.0f}) {
      const float r = x < 0.4f ? 0.16f : 0.1f;
      b.cylinder(plain({0.45f, 0.03f, 0.02f}, Finish::paint), glm::vec3(x, r, 0.2f * z) * s,
                 glm::vec3(x, r, 0.25f * z) * s, r * s, r * s, 9, false, true);
    }
  }
  for (int k = 0; k < 2; ++k) {  // wagons behind
    const float x = -1.3f - 0.85f * static_cast<float>(k);
    b.box(plain(k ? glm::vec3(0.05f, 0.2f, 0.4f) : glm::vec3(0.6f, 0.4f, 0.05f), Finish::gloss),
          glm::vec3(x - 0.35f, 0.2f, -0.22f) * s, glm::vec3(x + 0.35f, 0.55f, 0.22f) * s);
    for (float w : {-0.2f, 0.2f}) {
      for (float z : {-1.0f, 1.0f})
        b.cylinder(black, glm::vec3(x + w, 0.1f, 0.2f * z) * s, glm::vec3(x + w, 0.1f, 0.25f * z) * s, 0.1f * s,
                   0.1f * s, 7, false, true);
    }
  }
}

void blocks(Builder b, float s, Dice& dice) {
  const float e = 0.34f * s;
  int rows = 3;
  for (int y = 0; y < 3; ++y, --rows) {
    for (int x = 0; x < rows; ++x) {
      const float cx = (static_cast<float>(x) - 0.5f * static_cast<float>(rows - 1)) * e * 1.08f;
      Builder one = b.moved({cx, static_cast<float>(y) * e, 0}, dice.between(-0.25f, 0.25f));
      one.box(plain(bright(dice), Finish::paint), {-0.48f * e, 0, -0.48f * e}, {0.48f * e, 0.97f * e, 0.48f * e},
              face_no_bottom & ~face_back);
    }
  }
}

void drum(Builder b, float s, glm::vec3 colour) {
  b.cylinder(plain(colour, Finish::gloss), {0, 0.08f * s, 0}, {0, 0.62f * s, 0}, 0.42f * s, 0.42f * s, 12);
  const Paint gold = plain({0.75f, 0.5f, 0.2f}, Finish::brass);
  for (float y : {0.0f, 0.6f}) b.cylinder(gold, {0, y * s, 0}, {0, (y + 0.09f) * s, 0}, 0.44f * s, 0.44f * s, 12);
  b.cylinder(plain(glm::vec3(0.7f, 0.66f, 0.55f), Finish::matte), {0, 0.64f * s, 0}, {0, 0.67f * s, 0}, 0.43f * s,
             0.42f * s, 12, false, true);
}

void soldier(Builder b, float s, glm::vec3 coat) {
  const Paint blue = plain({0.02f, 0.03f, 0.10f}, Finish::gloss);
  for (float x : {-0.06f, 0.06f}) b.cylinder(blue, {x * s, 0, 0}, {x * s, 0.36f * s, 0}, 0.05f * s, 0.055f * s, 5);
  b.cylinder(plain(coat, Finish::gloss), {0, 0.34f * s, 0}, {0, 0.66f * s, 0}, 0.13f * s, 0.15f * s, 6, false, true);
  for (float x : {-0.18f, 0.18f})
    b.cylinder(plain(coat, Finish::gloss), {x * s, 0.36f * s, 0}, {x * s, 0.64f * s, 0}, 0.04f * s, 0.05f * s, 6, false,
               true);
  sphere(b, plain({0.62f, 0.42f, 0.30f}, Finish::gloss), glm::vec3(0, 0.75f, 0) * s, glm::vec3(0.09f) * s, 7, 4);
  b.cylinder(plain(glm::vec3(0.012f), Finish::matte), {0, 0.79f * s, 0}, {0, 1.0f * s, 0}, 0.1f * s, 0.09f * s, 8,
             false, true);
}

void house_toy(Builder b, float s, glm::vec3 roof) {
  const Paint wall = plain({0.62f, 0.56f, 0.42f}, Finish::paint);
  b.box(wall, glm::vec3(-0.4f, 0, -0.25f) * s, glm::vec3(0.4f, 0.6f, 0.25f) * s, face_no_bottom);
  const Paint tiles = plain(roof, Finish::paint);
  b.quad(tiles, glm::vec3(-0.45f, 0.57f, 0.32f) * s, glm::vec3(0.45f, 0.57f, 0.32f) * s, glm::vec3(0.45f, 0.95f, 0) * s,
         glm::vec3(-0.45f, 0.95f, 0) * s);
  b.quad(tiles, glm::vec3(0.45f, 0.57f, -0.32f) * s, glm::vec3(-0.45f, 0.57f, -0.32f) * s,
         glm::vec3(-0.45f, 0.95f, 0) * s, glm::vec3(0.45f, 0.95f, 0) * s);
  b.triangle(wall, glm::vec3(0.4f, 0.6f, 0.25f) * s, glm::vec3(0.4f, 0.6f, -0.25f) * s, glm::vec3(0.4f, 0.93f, 0) * s);
  b.triangle(wall, glm::vec3(-0.4f, 0.6f, -0.25f) * s, glm::vec3(-0.4f, 0.6f, 0.25f) * s,
             glm::vec3(-0.4f, 0.93f, 0) * s);
  for (float x : {-0.24f, 0.0f, 0.24f}) {
    for (float y : {0.1f, 0.36f}) {
      b.quad(glow(Glow::shop), glm::vec3(x - 0.06f, y, 0.252f) * s, glm::vec3(x + 0.06f, y, 0.252f) * s,
             glm::vec3(x + 0.06f, y + 0.15f, 0.252f) * s, glm::vec3(x - 0.06f, y + 0.15f, 0.252f) * s);
    }
  }
}

void rocking_horse(Builder b, float s) {
  const Paint coat = plain({0.55f, 0.50f, 0.42f}, Finish::gloss);
  const Paint mane = plain({0.10f, 0.05f, 0.02f}, Finish::matte);
  const Paint red = plain({0.50f, 0.03f, 0.03f}, Finish::gloss);
  sphere(b, coat, glm::vec3(0, 0.55f, 0) * s, glm::vec3(0.36f, 0.17f, 0.15f) * s, 10, 6);
  const std::array<glm::vec3, 4> neck{{glm::vec3(0.24f, 0.6f, 0) * s, glm::vec3(0.36f, 0.74f, 0) * s,
                                       glm::vec3(0.43f, 0.88f, 0) * s, glm::vec3(0.45f, 0.98f, 0) * s}};
  b.tube(coat, neck, 0.085f * s, 7);
  sphere(b, coat, glm::vec3(0.53f, 0.97f, 0) * s, glm::vec3(0.15f, 0.08f, 0.07f) * s, 8, 5);
  for (float z : {-0.05f, 0.05f})
    b.cylinder(coat, glm::vec3(0.43f, 1.02f, z) * s, glm::vec3(0.42f, 1.13f, z) * s, 0.03f * s, 0.005f * s, 5);
  const std::array<glm::vec3, 4> crest{{glm::vec3(0.38f, 1.04f, 0) * s, glm::vec3(0.33f, 0.92f, 0) * s,
                                        glm::vec3(0.24f, 0.80f, 0) * s, glm::vec3(0.16f, 0.70f, 0) * s}};
  b.tube(mane, crest, 0.05f * s, 5);
  const std::array<glm::vec3, 4> tail{{glm::vec3(-0.34f, 0.62f, 0) * s, glm::vec3(-0.46f, 0.60f, 0) * s,
                                       glm::vec3(-0.52f, 0.46f, 0) * s, glm::vec3(-0.50f, 0.32f, 0) * s}};
  b.tube(mane, tail, 0.04f * s, 5);
  b.cylinder(red, glm::vec3(-0.1f, 0.66f, 0) * s, glm::vec3(0.12f, 0.66f, 0) * s, 0.11f * s, 0.11f * s, 8, true, true);
  for (float z : {-1.0f, 1.0f}) {
    for (float x : {-1.0f, 1.0f})
      b.cylinder(coat, glm::vec3(0.2f * x, 0.48f, 0.09f * z) * s, glm::vec3(0.36f * x, 0.12f, 0.15f * z) * s,
                 0.055f * s, 0.035f * s, 6);
    std::vector<glm::vec3> rocker;
    for (int k = 0; k <= 8; ++k) {
      const float t = -0.75f + 1.5f * static_cast<float>(k) / 8.0f;
      rocker.push_back(glm::vec3(0.8f * std::sin(t), 0.83f - 0.8f * std::cos(t), 0.15f * z) * s);
    }
    b.tube(red, rocker, 0.03f * s, 5);
  }
}

void carousel(Builder b, float s) {
  const std::array<glm::vec3, 2> two{{{0.58f, 0.04f, 0.05f}, {0.66f, 0.60f, 0.46f}}};
  b.cylinder(plain(two[0], Finish::gloss), {0, 0, 0}, {0, 0.1f * s, 0}, 0.5f * s, 0.48f * s, 16, false, true);
  b.cylinder(plain({0.75f, 0.5f, 0.2f}, Finish::brass), {0, 0.1f * s, 0}, {0, 0.72f * s, 0}, 0.06f * s, 0.06f * s, 8);
  for (int k = 0; k < 16; ++k) {
    const float a = 6.2831853f * static_cast<float>(k) / 16.0f;
    const float c = 6.2831853f * static_cast<float>(k + 1) / 16.0f;
    const auto rim = [&](float t, float r, float y) { return glm::vec3(r * std::sin(t), y, r * std::cos(t)) * s; };
    b.triangle(plain(two[static_cast<std::size_t>(k & 1)], Finish::paint), rim(a, 0.56f, 0.72f), rim(c, 0.56f, 0.72f),
               glm::vec3(0, 1.0f, 0) * s);
    b.quad(plain(two[static_cast<std::size_t>(1 - (k & 1))], Finish::paint), rim(a, 0.56f, 0.64f), rim(c, 0.56f, 0.64f),
           rim(c, 0.56f, 0.72f), rim(a, 0.56f, 0.72f));
    b.box(glow(Glow::candle), rim(a, 0.565f, 0.66f) - 0.012f * s, rim(a, 0.565f, 0.66f) + 0.012f * s);
  }
  for (int k = 0; k < 6; ++k) {
    const float a = 6.2831853f * static_cast<float>(k) / 6.0f;
    const glm::vec3 at = glm::vec3(0.38f * std::sin(a), 0.0f, 0.38f * std::cos(a)) * s;
    b.cylinder(plain({0.75f, 0.5f, 0.2f}, Finish::brass), at + glm::vec3(0, 0.1f, 0) * s,
               at + glm::vec3(0, 0.72f, 0) * s, 0.012f * s, 0.012f * s, 5);
    const float y = 0.3f + 0.08f * static_cast<float>(k & 1);
    Builder horse = b.moved(at + glm::vec3(0, y, 0) * s, a + 1.5708f);
    sphere(horse, plain({0.6f, 0.55f, 0.45f}, Finish::gloss), glm::vec3(0), glm::vec3(0.05f, 0.05f, 0.12f) * s, 6, 4);
    horse.cylinder(plain({0.6f, 0.55f, 0.45f}, Finish::gloss), glm::vec3(0, 0.02f, 0.09f) * s,
                   glm::vec3(0, 0.14f, 0.15f) * s, 0.035f * s, 0.025f * s, 5, false, true);
  }
}

void any_toy(Builder b, float size, Dice& dice) {
  switch (dice.below(9)) {
    case 0:
      ball(b, 0.8f * size, bright(dice), bright(dice));
      return;
    case 1:
      bear(b, size, glm::vec3(0.36f, 0.18f, 0.06f) * dice.between(0.5f, 1.3f));
      return;
    case 2:
      blocks(b, size, dice);
      return;
    case 3:
      drum(b, size, bright(dice));
      return;
    case 4:
    case 5:
      soldier(b, size, bright(dice));
      return;
    case 6:
      house_toy(b, size, bright(dice));
      return;
    default: {  // boxed games and puzzles
      const float h = dice.between(0.5f, 1.0f) * size;
      const float w = dice.between(0.3f, 0.55f) * size;
      const glm::vec3 a = bright(dice);
      b.box(plain(a, Finish::paint), {-w, 0, -0.1f}, {w, h, 0.1f}, face_no_bottom);
      b.box(plain(bright(dice), Finish::paint), {-0.7f * w, 0.2f * h, 0.1f}, {0.7f * w, 0.75f * h, 0.104f}, face_front);
      return;
    }
  }
}

}  // namespace petrichor::city
