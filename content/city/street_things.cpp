// Benches, bins, bollards, planters, a pillar box, a telephone box and a news kiosk.
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "content/city/atlases.hpp"
#include "content/city/dice.hpp"
#include "content/city/furniture.hpp"
#include "content/city/plan.hpp"
#include "content/city/toys.hpp"

namespace petrichor::city {
namespace {

const glm::vec3 iron_black(0.022f);

Mesh bollard_mesh() {
  Mesh mesh;
  mesh.name = "bollard";
  Builder b(mesh);
  const std::array<glm::vec2, 9> profile{{{0.0f, 0.98f},
                                          {0.05f, 0.97f},
                                          {0.075f, 0.92f},
                                          {0.05f, 0.87f},
                                          {0.075f, 0.84f},
                                          {0.06f, 0.80f},
                                          {0.08f, 0.20f},
                                          {0.11f, 0.16f},
                                          {0.12f, 0.0f}}};
  b.lathe(plain(iron_black, Finish::iron), profile, 8);
  b.cylinder(plain(glm::vec3(0.5f), Finish::paint), {0, 0.70f, 0}, {0, 0.77f, 0}, 0.0665f, 0.064f, 8);
  return mesh;
}

Mesh bin_mesh() {
  Mesh mesh;
  mesh.name = "litter_bin";
  Builder b(mesh);
  const Paint green = plain({0.015f, 0.05f, 0.035f}, Finish::gloss);
  const std::array<glm::vec2, 7> profile{
      {{0.0f, 1.05f}, {0.16f, 1.02f}, {0.25f, 0.93f}, {0.26f, 0.88f}, {0.235f, 0.88f}, {0.235f, 0.10f}, {0.20f, 0.0f}}};
  b.lathe(green, profile, 12);
  b.box(plain(glm::vec3(0.003f), Finish::matte), {-0.13f, 0.74f, 0.20f}, {0.13f, 0.85f, 0.245f}, face_no_back);
  b.cylinder(plain({0.6f, 0.42f, 0.16f}, Finish::brass), {0, 0.66f, 0}, {0, 0.69f, 0}, 0.24f, 0.24f, 12);
  return mesh;
}

Mesh bench_mesh() {
  Mesh mesh;
  mesh.name = "bench";
  Builder b(mesh);
  const Paint wood = plain({0.15f, 0.075f, 0.03f}, Finish::gloss);
  const Paint iron = plain(iron_black, Finish::iron);
  for (int k = 0; k < 4; ++k)
    b.box(wood, {-0.85f, 0.43f, 0.02f + 0.11f * static_cast<float>(k)},
          {0.85f, 0.465f, 0.11f + 0.11f * static_cast<float>(k)});
  for (int k = 0; k < 3; ++k)
    b.box(wood, {-0.85f, 0.56f + 0.13f * static_cast<float>(k), -0.05f - 0.03f * static_cast<float>(k)},
          {0.85f, 0.66f + 0.13f * static_cast<float>(k), -0.015f - 0.03f * static_cast<float>(k)});
  for (float x : {-0.72f, 0.72f}) {
    const std::array<glm::vec3, 5> back{
        {{x, 0, -0.06f}, {x, 0.42f, 0.0f}, {x, 0.60f, -0.06f}, {x, 0.80f, -0.10f}, {x, 0.95f, -0.14f}}};
    b.tube(iron, back, 0.025f, 5);
    const std::array<glm::vec3, 4> front{{{x, 0, 0.46f}, {x, 0.40f, 0.42f}, {x, 0.62f, 0.40f}, {x, 0.64f, 0.02f}}};
    b.tube(iron, front, 0.025f, 5);
  }
  return mesh;
}

Mesh planter_mesh() {
  Mesh mesh;
  mesh.name = "planter";
  Builder b(mesh);
  const Paint stone = plain(glm::vec3(0.22f, 0.20f, 0.18f), Finish::stone);
  const std::array<glm::vec2, 7> pot{
      {{0.30f, 0.50f}, {0.40f, 0.56f}, {0.42f, 0.50f}, {0.34f, 0.44f}, {0.30f, 0.14f}, {0.36f, 0.08f}, {0.36f, 0.0f}}};
  b.lathe(stone, pot, 12);
  Dice dice{31};
  for (int k = 0; k < 90; ++k) {  // a clipped bush of leaves
    const float y = dice.between(-0.6f, 1.0f);
    const float a = dice.between(0.0f, 6.2831853f);
    const float r = std::sqrt(std::max(0.0f, 1.0f - y * y));
    const glm::vec3 n(r * std::cos(a), y, r * std::sin(a));
    const glm::vec3 p = glm::vec3(0, 0.95f, 0) + n * glm::vec3(0.42f, 0.48f, 0.42f) * dice.between(0.82f, 1.05f);
    const glm::vec3 u = glm::normalize(glm::cross(n, glm::vec3(0.3f, 1.0f, 0.2f))) * 0.075f;
    const glm::vec3 v = glm::normalize(glm::cross(u, n)) * 0.12f + n * 0.04f;
    b.quad(plain(glm::vec3(0.02f, 0.055f, 0.018f) * dice.between(0.6f, 1.4f), Finish::paint), p - u - v, p + u - v,
           p + u + v, p - u + v);
  }
  sphere(b, plain(glm::vec3(0.006f, 0.014f, 0.006f), Finish::matte), {0, 0.92f, 0}, {0.36f, 0.42f, 0.36f}, 8, 5);
  return mesh;
}

Mesh pillar_box_mesh() {
  Mesh mesh;
  mesh.name = "pillar_box";
  Builder b(mesh);
  const Paint red = plain({0.34f, 0.012f, 0.012f}, Finish::gloss);
  const std::array<glm::vec2, 9> profile{{{0.0f, 1.62f},
                                          {0.16f, 1.58f},
                                          {0.26f, 1.48f},
                                          {0.28f, 1.42f},
                                          {0.24f, 1.40f},
                                          {0.23f, 1.38f},
                                          {0.23f, 0.18f},
                                          {0.27f, 0.14f},
                                          {0.27f, 0.0f}}};
  b.lathe(red, profile, 14);
  b.box(plain(glm::vec3(0.005f), Finish::matte), {-0.11f, 1.22f, 0.18f}, {0.11f, 1.26f, 0.236f}, face_no_back);
  b.box(plain(glm::vec3(0.6f), Finish::paint), {-0.06f, 0.98f, 0.18f}, {0.06f, 1.14f, 0.237f}, face_no_back);
  return mesh;
}

Mesh telephone_mesh() {
  Mesh mesh;
  mesh.name = "telephone_box";
  Builder b(mesh);
  const Paint red = plain({0.30f, 0.010f, 0.012f}, Finish::gloss);
  const float h = 0.44f;
  b.box(red, {-h, 0, -h}, {h, 0.16f, h}, face_no_bottom);
  b.box(red, {-h, 2.1f, -h}, {h, 2.42f, h});
  b.surface(red, 8, 4, [&](float u, float v) {  // the domed roof
    const float x = (2.0f * u - 1.0f) * h;
    const float z = (1.0f - 2.0f * v) * h;
    return glm::vec3(x, 2.42f + 0.16f * (1.0f - (x / h) * (x / h)) * (1.0f - (z / h) * (z / h)), z);
  });
  for (float x : {-h, h - 0.08f}) {
    for (float z : {-h, h - 0.08f})
      b.box(red, {x, 0.16f, z}, {x + 0.08f, 2.1f, z + 0.08f}, face_all & ~(face_top | face_bottom));
  }
  for (int side = 0; side < 4; ++side) {
    Builder s = b.moved({0, 0, 0}, 1.5707963f * static_cast<float>(side));
    s.picture(Mat::signs, glm::vec3(1.0f), sign_rect(Sign::telephone), {-0.33f, 2.2f, h + 0.004f},
              {0.33f, 2.2f, h + 0.004f}, {0.33f, 2.34f, h + 0.004f}, {-0.33f, 2.34f, h + 0.004f});
    if (side == 2) {
      s.box(red, {-0.36f, 0.16f, h - 0.06f}, {0.36f, 2.1f, h - 0.02f}, face_front | face_back);
      continue;
    }
    s.quad({Mat::glass, glm::vec3(1.0f), {}}, {-0.36f, 0.25f, h - 0.03f}, {0.36f, 0.25f, h - 0.03f},
           {0.36f, 2.1f, h - 0.03f}, {-0.36f, 2.1f, h - 0.03f});
    for (float x : {-0.12f, 0.12f})
      s.box(red, {x - 0.014f, 0.2f, h - 0.04f}, {x + 0.014f, 2.1f, h - 0.015f}, face_front | face_sides | face_back);
    for (int k = 0; k < 7; ++k)
      s.box(red, {-0.36f, 0.22f + 0.27f * static_cast<float>(k), h - 0.04f},
            {0.36f, 0.248f + 0.27f * static_cast<float>(k), h - 0.015f},
            face_front | face_top | face_bottom | face_back);
  }
  b.box(plain(glm::vec3(0.02f), Finish::gloss), {-0.15f, 1.0f, -0.38f}, {0.15f, 1.6f, -0.24f});
  b.box(glow(Glow::shop), {-0.2f, 2.07f, -0.2f}, {0.2f, 2.1f, 0.2f}, face_bottom | face_sides | face_front | face_back);
  return mesh;
}

Mesh kiosk_mesh() {
  Mesh mesh;
  mesh.name = "news_kiosk";
  Builder b(mesh);
  const Paint green = plain({0.018f, 0.055f, 0.04f}, Finish::gloss);
  const int sides = 6;
  const float r = 1.15f;
  const auto on = [&](float k, float radius, float y) {
    return glm::vec3(radius * std::sin(1.0471976f * k), y, radius * std::cos(1.0471976f * k));
  };
  for (int k = 0; k < sides; ++k) {
    const float a = static_cast<float>(k) - 0.5f;
    const float c = a + 1.0f;
    b.quad(green, on(a, r, 0), on(c, r, 0), on(c, r, 0.95f), on(a, r, 0.95f));
    b.quad(green, on(a, r, 2.1f), on(c, r, 2.1f), on(c, r, 2.5f), on(a, r, 2.5f));
    b.cylinder(green, on(a, r, 0), on(a, r, 2.5f), 0.05f, 0.05f, 6);
    if (k % 2 == 0) {  // an open counter, papers hanging in it
      b.picture(Mat::shopfront, glm::vec3(1.0f), goods_rect(Goods::books), on(a, r - 0.12f, 0.95f),
                on(c, r - 0.12f, 0.95f), on(c, r - 0.12f, 2.1f), on(a, r - 0.12f, 2.1f));
      b.quad(green, on(a, r + 0.25f, 0.95f), on(c, r + 0.25f, 0.95f), on(c, r - 0.12f, 0.95f), on(a, r - 0.12f, 0.95f));
      b.quad(green, on(a, r, 0.88f), on(c, r, 0.88f), on(c, r + 0.25f, 0.94f), on(a, r + 0.25f, 0.94f));
    } else {
      const Sign poster = k == 1 ? Sign::poster_sea : Sign::poster_concert;
      b.quad(green, on(a, r, 0.95f), on(c, r, 0.95f), on(c, r, 2.1f), on(a, r, 2.1f));
      const glm::vec3 m = 0.5f * (on(a, r, 0.95f) + on(c, r, 0.95f));
      const glm::vec3 e = glm::normalize(on(c, r, 0) - on(a, r, 0));
      const glm::vec3 n = glm::normalize(glm::vec3(m.x, 0, m.z)) * 0.012f;
      const glm::vec3 up(0, 1.12f, 0);
      b.picture(Mat::signs, glm::vec3(0.6f), sign_rect(poster), m - 0.37f * e + n, m + 0.37f * e + n,
                m + 0.37f * e + n + up, m - 0.37f * e + n + up);
    }
    const glm::vec3 m = 0.5f * (on(a, r, 2.3f) + on(c, r, 2.3f));
    const glm::vec3 e = glm::normalize(on(c, r, 0) - on(a, r, 0));
    const glm::vec3 n = glm::normalize(glm::vec3(m.x, 0, m.z)) * 0.015f;
    const glm::vec3 up(0, 0.1f, 0);
    b.picture(Mat::signs, glm::vec3(1.0f), sign_rect(Sign::news), m - 0.5f * e + n - up, m + 0.5f * e + n - up,
              m + 0.5f * e + n + up, m - 0.5f * e + n + up);
    // A brim, then an onion of a roof.
    b.quad(green, on(a, r, 2.42f), on(c, r, 2.42f), on(c, r + 0.42f, 2.48f), on(a, r + 0.42f, 2.48f));
    b.quad(green, on(a, r + 0.42f, 2.48f), on(c, r + 0.42f, 2.48f), on(c, r + 0.42f, 2.55f), on(a, r + 0.42f, 2.55f));
    const std::array<glm::vec2, 6> roof{
        {{r + 0.42f, 2.55f}, {0.95f, 2.80f}, {0.62f, 3.05f}, {0.50f, 3.25f}, {0.30f, 3.5f}, {0.03f, 3.75f}}};
    for (std::size_t j = 0; j + 1 < roof.size(); ++j)
      b.quad(green, on(a, roof[j].x, roof[j].y), on(c, roof[j].x, roof[j].y), on(c, roof[j + 1].x, roof[j + 1].y),
             on(a, roof[j + 1].x, roof[j + 1].y));
  }
  sphere(b, plain({0.7f, 0.48f, 0.18f}, Finish::brass), {0, 3.8f, 0}, glm::vec3(0.07f), 6, 4);
  return mesh;
}

}  // namespace

void add_small_things(Scene& scene) {
  const int parent = scene.group("street_things");
  int number = 0;
  const auto place = [&](const char* name, int mesh, float x, float z, float y, float turn = 0.0f) {
    add_node(scene, std::string(name) + "_" + std::to_string(number++), parent, mesh,
             glm::rotate(glm::translate(glm::mat4(1.0f), {x, y, z}), turn, glm::vec3(0, 1, 0)));
  };
  const float at_kerb = pavement_height_m(0.35f);
  const float inner = pavement_height_m(1.8f);
  const int bollard = scene.add_mesh(bollard_mesh());
  for (float sx : {-1.0f, 1.0f}) {
    for (float sz : {-1.0f, 1.0f}) {
      for (int k = 0; k < 4; ++k) {  // round the corners, a step behind the kerb
        const float t = 0.2f + 0.39f * static_cast<float>(k);
        const glm::vec2 c(main_half_m + kerb_radius_m, lane_half_m + kerb_radius_m);
        const glm::vec2 p = c - (kerb_radius_m - 0.42f) * glm::vec2(std::cos(t), std::sin(t));
        place("bollard", bollard, sx * p.x, sz * p.y, at_kerb);
      }
    }
  }
  const int bin = scene.add_mesh(bin_mesh());
  place("litter_bin", bin, 5.7f, 20.6f, at_kerb, -1.57f);
  place("litter_bin", bin, -5.7f, 12.2f, at_kerb, 1.57f);
  place("litter_bin", bin, -5.7f, -23.0f, at_kerb, 1.57f);
  place("litter_bin", bin, 19.6f, -4.7f, at_kerb, 0.0f);
  place("litter_bin", bin, 5.7f, -27.5f, at_kerb, -1.57f);
  const int bench = scene.add_mesh(bench_mesh());
  place("bench", bench, -7.4f, 22.0f, inner, 1.5707963f);
  place("bench", bench, 7.4f, -23.5f, inner, -1.5707963f);
  place("bench", bench, -7.4f, -33.0f, inner, 1.5707963f);
  place("bench", bench, 7.4f, 38.0f, inner, -1.5707963f);
  const int planter = scene.add_mesh(planter_mesh());
  for (glm::vec2 p :
       {glm::vec2(-7.45f, -11.0f), glm::vec2(-7.45f, -18.6f), glm::vec2(-12.0f, -6.0f), glm::vec2(-19.8f, -6.0f),
        glm::vec2(17.6f, -6.0f), glm::vec2(7.45f, -15.2f), glm::vec2(-7.4f, 27.6f)}) {
    place("planter", planter, p.x, p.y, inner, p.x);
  }
  place("pillar_box", scene.add_mesh(pillar_box_mesh()), -5.75f, 10.4f, at_kerb, -1.2f);
  const int phone = scene.add_mesh(telephone_mesh());
  place("telephone_box", phone, -7.0f, 15.8f, inner, 1.5707963f);
  add_light(scene, "telephone_box_light", parent, {-7.0f, inner + 1.95f, 15.8f},
            {{1.0f, 0.80f, 0.52f}, 40.0f, 9.0f, 0, 0, false, 0.15f});
  place("news_kiosk", scene.add_mesh(kiosk_mesh()), -9.2f, 7.9f, pavement_height_m(2.3f), 2.356f);
  add_light(scene, "news_kiosk_light", parent, {-7.9f, 2.2f, 6.6f},
            {{1.0f, 0.72f, 0.42f}, 48.0f, 10.0f, 0, 0, false, 0.3f});
}

}  // namespace petrichor::city
