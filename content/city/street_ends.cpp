// Where the vistas end: the north gate's passage, the church behind it.
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "content/city/atlases.hpp"
#include "content/city/dice.hpp"
#include "content/city/facade.hpp"
#include "content/city/furniture.hpp"
#include "content/city/plan.hpp"
#include "content/city/toys.hpp"

namespace petrichor::city {
namespace {

// A vaulted passage through the ground floor of the gate house, in its wall frame.
void passage(Builder& b, float width, float top, float depth) {
  const Paint stone = tiling(Mat::ashlar, glm::vec3(0.75f));
  const Paint trim = plain(glm::vec3(0.36f, 0.33f, 0.29f), Finish::stone);
  const float m = 0.5f * width;
  const float half = 2.6f;
  const float spring = 2.3f;
  const int pieces = 14;
  for (float z : {0.0f, -depth}) {
    const bool back = z < 0.0f;
    const auto face = [&](glm::vec3 p, glm::vec3 q, glm::vec3 r, glm::vec3 s) {
      if (back)
        b.quad(stone, q, p, s, r);
      else
        b.quad(stone, p, q, r, s);
    };
    face({0, 0, z}, {m - half, 0, z}, {m - half, top, z}, {0, top, z});
    face({m + half, 0, z}, {width, 0, z}, {width, top, z}, {m + half, top, z});
    for (int k = 0; k < pieces; ++k) {
      const float t0 = 3.14159265f * static_cast<float>(k) / pieces;
      const float t1 = 3.14159265f * static_cast<float>(k + 1) / pieces;
      const float xa = m - half * std::cos(t0), xb = m - half * std::cos(t1);
      const float ya = spring + half * std::sin(t0) * 0.8f, yb = spring + half * std::sin(t1) * 0.8f;
      face({xa, ya, z}, {xb, yb, z}, {xb, top, z}, {xa, top, z});
      if (back) continue;
      const glm::vec3 in(0, 0, -depth);
      b.quad(stone, {xa, ya, 0}, glm::vec3(xa, ya, 0) + in, glm::vec3(xb, yb, 0) + in, {xb, yb, 0});
      // Voussoirs stand out round the mouth.
      const glm::vec2 c(m, spring);
      const auto on = [&](float t, float r, float z1) {
        return glm::vec3(c.x - r * std::cos(t), c.y + 0.8f * r * std::sin(t), z1);
      };
      const float z1 = 0.06f + 0.025f * static_cast<float>(k & 1);
      b.quad(trim, on(t0, half, z1), on(t1, half, z1), on(t1, half + 0.42f, z1), on(t0, half + 0.42f, z1));
      b.quad(trim, on(t0, half + 0.42f, z1), on(t1, half + 0.42f, z1), on(t1, half + 0.42f, 0),
             on(t0, half + 0.42f, 0));
      b.quad(trim, on(t1, half, z1), on(t0, half, z1), on(t0, half, 0), on(t1, half, 0));
    }
  }
  b.quad(stone, {m - half, 0, 0}, {m - half, 0, -depth}, {m - half, spring, -depth}, {m - half, spring, 0});
  b.quad(stone, {m + half, 0, -depth}, {m + half, 0, 0}, {m + half, spring, 0}, {m + half, spring, -depth});
  b.quad(tiling(Mat::setts), {m - half, 0.04f, 0.05f}, {m + half, 0.04f, 0.05f}, {m + half, 0.04f, -depth},
         {m - half, 0.04f, -depth});
  const Paint iron = plain(glm::vec3(0.025f), Finish::iron);
  b.cylinder(iron, {m, 3.55f, -5.0f}, {m, 4.3f, -5.0f}, 0.012f, 0.012f, 5);
  b.cylinder(glow(Glow::sodium), {m, 3.1f, -5.0f}, {m, 3.5f, -5.0f}, 0.10f, 0.17f, 6, true);
  b.cylinder(iron, {m, 3.5f, -5.0f}, {m, 3.62f, -5.0f}, 0.22f, 0.02f, 6);
}

void tower(Builder& b) {
  const Paint stone = tiling(Mat::ashlar, glm::vec3(0.7f));
  const Paint trim = plain(glm::vec3(0.30f, 0.28f, 0.25f), Finish::stone);
  const Paint slate = plain(glm::vec3(0.05f, 0.065f, 0.065f), Finish::stone);
  const float r = 4.6f;
  b.box(stone, {-r, 0, -r}, {r, 34.0f, r}, face_all & ~(face_top | face_bottom));
  for (float sx : {-1.0f, 1.0f}) {
    for (float sz : {-1.0f, 1.0f})
      b.box(stone, glm::vec3(sx * r - 0.8f, 0, sz * r - 0.8f), glm::vec3(sx * r + 0.8f, 31.0f, sz * r + 0.8f),
            face_no_bottom);
  }
  for (float y : {12.0f, 22.0f, 33.2f}) b.box(trim, {-r - 0.45f, y, -r - 0.45f}, {r + 0.45f, y + 0.6f, r + 0.45f});
  for (int side = 0; side < 4; ++side) {
    Builder s = b.moved({0, 0, 0}, 1.5707963f * static_cast<float>(side));
    const float z = r + 0.03f;
    for (float x : {-1.5f, 1.5f}) {  // belfry louvres, with a little light behind them
      s.quad(plain(glm::vec3(0.004f), Finish::matte), {x - 0.8f, 15.5f, z}, {x + 0.8f, 15.5f, z}, {x + 0.8f, 20.5f, z},
             {x - 0.8f, 20.5f, z});
      s.triangle(plain(glm::vec3(0.004f), Finish::matte), {x - 0.8f, 20.5f, z}, {x + 0.8f, 20.5f, z}, {x, 21.6f, z});
      for (int k = 0; k < 7; ++k)
        s.box(trim, {x - 0.8f, 15.8f + 0.68f * static_cast<float>(k), z},
              {x + 0.8f, 15.95f + 0.68f * static_cast<float>(k), z + 0.15f}, face_no_back);
    }
    // The clock.
    const float cy = 27.4f;
    s.picture(Mat::signs, glm::vec3(1.0f), sign_rect(Sign::clock_face), {-2.0f, cy - 2.0f, z + 0.05f},
              {2.0f, cy - 2.0f, z + 0.05f}, {2.0f, cy + 2.0f, z + 0.05f}, {-2.0f, cy + 2.0f, z + 0.05f});
    std::vector<glm::vec3> rim;
    for (int k = 0; k < 20; ++k) {
      const float t = 6.2831853f * static_cast<float>(k) / 20.0f;
      rim.emplace_back(2.0f * std::cos(t), cy + 2.0f * std::sin(t), z + 0.08f);
    }
    s.tube(trim, rim, 0.16f, 5, true);
    for (int k = 0; k < 4; ++k) {  // spandrels hide the picture's corners
      const float x = (k & 1) ? 1.0f : -1.0f;
      const float y = (k & 2) ? 1.0f : -1.0f;
      for (int j = 0; j < 5; ++j) {
        const float t0 = 1.5707963f * static_cast<float>(j) / 5.0f, t1 = 1.5707963f * static_cast<float>(j + 1) / 5.0f;
        const glm::vec3 p(2.0f * std::cos(t0) * x, cy + 2.0f * std::sin(t0) * y, z + 0.06f),
            q(2.0f * std::cos(t1) * x, cy + 2.0f * std::sin(t1) * y, z + 0.06f),
            c(2.05f * x, cy + 2.05f * y, z + 0.06f);
        if (x * y > 0)
          s.triangle(stone, p, c, q);
        else
          s.triangle(stone, q, c, p);
      }
    }
    for (int k = 0; k < 4; ++k)
      s.box(trim, {-r + 0.3f + 2.5f * static_cast<float>(k), 33.8f, r - 0.1f},
            {-r + 1.4f + 2.5f * static_cast<float>(k), 35.2f, r + 0.3f}, face_no_bottom);
    // Spire: eight sides, each pair of faces over one side of the tower.
    const float e = r - 0.3f;
    const float a = 0.4142f * e;
    const glm::vec3 top(0, 58.0f, 0);
    s.triangle(slate, {-a, 34.0f, e}, {a, 34.0f, e}, top);
    s.triangle(slate, {a, 34.0f, e}, {e, 34.0f, a}, top);
  }
  b.cylinder(plain({0.6f, 0.4f, 0.15f}, Finish::brass), {0, 57.5f, 0}, {0, 60.5f, 0}, 0.09f, 0.04f, 6);
  sphere(b, plain({0.6f, 0.4f, 0.15f}, Finish::brass), {0, 59.0f, 0}, glm::vec3(0.3f), 8, 5);
}

// The rest of the town as roofs against the sky, and the yards behind the houses.
void backdrop(Scene& scene, int parent) {
  Dice dice{909};
  for (int quarter = 0; quarter < 4; ++quarter) {
    Mesh mesh;
    mesh.name = "far_town_" + std::to_string(quarter);
    Builder b(mesh);
    const float fx = (quarter & 1) ? 1.0f : -1.0f;
    const float fz = (quarter & 2) ? 1.0f : -1.0f;
    const glm::vec3 lo(std::min(fx * 17.0f, fx * 118.0f), -0.02f, std::min(fz * 15.0f, fz * 118.0f));
    const glm::vec3 hi(std::max(fx * 17.0f, fx * 118.0f), -0.02f, std::max(fz * 15.0f, fz * 118.0f));
    b.quad(plain(glm::vec3(0.04f), Finish::stone), {lo.x, lo.y, hi.z}, {hi.x, lo.y, hi.z}, {hi.x, lo.y, lo.z},
           {lo.x, lo.y, lo.z});
    for (int k = 0; k < 26; ++k) {
      const float ring = 80.0f + 9.0f * static_cast<float>(k % 4) + dice.between(0.0f, 6.0f);
      const float t = 1.5707963f * (static_cast<float>(k) + dice.next()) / 26.0f;
      const glm::vec3 at(fx * ring * std::cos(t), 0.0f, fz * ring * std::sin(t));
      if (std::abs(at.x - 3.5f) < 22.0f && at.z < -60.0f) continue;  // the church's own square
      Builder house = b.moved(at, dice.between(0.0f, 3.1f));
      const float w = dice.between(6.0f, 11.0f), d = dice.between(5.0f, 7.0f), h = dice.between(11.0f, 19.0f),
                  rise = dice.between(3.0f, 5.5f);
      const Paint wall = tiling(Mat::stucco, glm::vec3(0.45f) * dice.between(0.6f, 1.0f));
      const Paint tiles = tiling(Mat::tiles, glm::vec3(0.7f));
      house.box(wall, {-w, 0, -d}, {w, h, d}, face_sides | face_front | face_back);
      house.quad(tiles, {-w, h, d}, {w, h, d}, {w, h + rise, 0}, {-w, h + rise, 0});
      house.quad(tiles, {w, h, -d}, {-w, h, -d}, {-w, h + rise, 0}, {w, h + rise, 0});
      house.triangle(wall, {w, h, d}, {w, h, -d}, {w, h + rise, 0});
      house.triangle(wall, {-w, h, -d}, {-w, h, d}, {-w, h + rise, 0});
      for (int j = 0; j < 5; ++j) {  // a few windows awake
        const float x = dice.between(-w + 1.0f, w - 2.0f), y = dice.between(0.55f * h, h - 2.5f);
        for (float s : {-1.0f, 1.0f}) {
          if (!dice.chance(0.5f)) continue;
          const float z = s * (d + 0.02f);
          const UvRect rect = pane_rect(dice.below(lit_panes));
          if (s > 0)
            house.picture(Mat::panes, glm::vec3(1.0f), rect, {x, y, z}, {x + 1.1f, y, z}, {x + 1.1f, y + 1.7f, z},
                          {x, y + 1.7f, z});
          else
            house.picture(Mat::panes, glm::vec3(1.0f), rect, {x + 1.1f, y, z}, {x, y, z}, {x, y + 1.7f, z},
                          {x + 1.1f, y + 1.7f, z});
        }
      }
    }
    add_mesh_node(scene, parent, std::move(mesh));
  }
}

}  // namespace

void add_street_ends(Scene& scene) {
  const int parent = scene.group("street_ends");
  backdrop(scene, parent);
  const float depth = 11.0f;
  Mesh gate;
  gate.name = "gate_passage";
  Builder g(gate, wall_frame({-main_wall_m, 0, -street_end_m}, {0, 0, 1}));
  passage(g, 2.0f * main_wall_m, gate_ground_m, depth);
  add_mesh_node(scene, parent, std::move(gate));
  add_light(scene, "gate_passage_light", parent, {0, 2.9f, -street_end_m - 5.0f},
            {sodium_light, 260.0f, 22.0f, 0, 0, false, 0.12f});

  Mesh church;
  church.name = "church";
  Builder b(church, glm::translate(glm::mat4(1.0f), {3.5f, 0, -92.0f}));
  tower(b);
  // The square before it, and the nave.
  b.quad(tiling(Mat::setts, glm::vec3(0.9f)), {-24.0f, 0.03f, 21.0f}, {20.0f, 0.03f, 21.0f}, {20.0f, 0.03f, -6.0f},
         {-24.0f, 0.03f, -6.0f});
  b.box(tiling(Mat::ashlar, glm::vec3(0.6f)), {-9.0f, 0, -34.0f}, {9.0f, 13.0f, -4.0f}, face_no_bottom);
  b.quad(plain(glm::vec3(0.05f), Finish::stone), {-9.6f, 13.0f, -4.0f}, {-9.6f, 13.0f, -34.0f}, {0, 22.0f, -34.0f},
         {0, 22.0f, -4.0f});
  b.quad(plain(glm::vec3(0.05f), Finish::stone), {9.6f, 13.0f, -34.0f}, {9.6f, 13.0f, -4.0f}, {0, 22.0f, -4.0f},
         {0, 22.0f, -34.0f});
  b.quad(plain({0.07f, 0.035f, 0.015f}, Finish::paint), {-1.3f, 0, 4.7f}, {1.3f, 0, 4.7f}, {1.3f, 4.2f, 4.7f},
         {-1.3f, 4.2f, 4.7f});
  b.triangle(glow(Glow::clock), {-1.3f, 4.3f, 4.7f}, {1.3f, 4.3f, 4.7f}, {0, 6.0f, 4.7f});
  add_mesh_node(scene, parent, std::move(church));
  add_light(scene, "church_flood", parent, {-3.0f, 7.0f, -73.0f},
            {{1.0f, 0.74f, 0.42f}, 26000.0f, 80.0f, 12.0f, 34.0f, false, 0.2f}, {6.5f, 26.0f, -14.4f});
  add_light(scene, "church_square_lamp", parent, {-7.0f, 4.6f, -82.0f},
            {sodium_light, 420.0f, 26.0f, 0, 0, false, 0.12f});
}

}  // namespace petrichor::city
