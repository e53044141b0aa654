// The houses at the crossing.
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "content/city/atlases.hpp"
#include "content/city/facade.hpp"
#include "content/city/parts.hpp"
#include "content/city/plan.hpp"
#include "content/city/plots.hpp"
#include "content/city/roofs.hpp"

namespace petrichor::city {
namespace {

// One slope of a mansard over a corner house, with its dormers and gutter.
void mansard_side(Builder& world, Builder& wall, glm::vec3 low0, glm::vec3 low1, glm::vec3 high0, glm::vec3 high1,
                  bool flip, float width, int dormers, float rise, float inset, float eaves, const Style& style,
                  Dice& dice) {
  const Paint tiles = tiling(Mat::tiles, glm::vec3(0.6f));
  if (flip)
    world.quad(tiles, low1, low0, high0, high1);
  else
    world.quad(tiles, low0, low1, high1, high0);
  const float slope = rise / (inset + 0.2f);
  for (int d = 0; d < dormers; ++d) {
    const float x = width * (static_cast<float>(d) + 0.5f) / static_cast<float>(dormers);
    dormer(wall, style, x, eaves + 0.5f, 0.15f - 0.5f / slope, slope, glm::vec3(0.6f), dice);
  }
  gutter(wall, 0.0f, width, eaves + 0.02f, 0.40f);
}

// A breast wall along one side of a roof terrace, mitred where it meets the next.
void parapet(Builder& b, const Style& style, float width, float y, bool mitred_first, bool mitred_last, float miter,
             bool starts_at_line) {
  const Paint stone = plain(style.trim * 0.85f, Finish::stone);
  const float m0 = (starts_at_line ? mitred_first : mitred_last) ? miter : 0.0f;
  const float m1 = (starts_at_line ? mitred_last : mitred_first) ? miter : 0.0f;
  const float h = 0.95f;
  const std::array<glm::vec2, 6> wall{{{0.0f, y},
                                       {0.0f, y + h},
                                       {0.08f, y + h + 0.02f},
                                       {0.08f, y + h + 0.11f},
                                       {-0.36f, y + h + 0.14f},
                                       {-0.36f, y + h}}};
  b.moulding(stone, wall, 0.0f, width, m0, m1, false);
  const std::array<glm::vec2, 3> inside{{{-0.36f, y + h}, {-0.30f, y + h}, {-0.30f, y}}};
  b.moulding(stone, inside, 0.0f, width, m0, m1, false);
}

// What stands on a flat roof: the stair head with its lamp, vents, a skylight that glows.
void terrace(Scene& scene, Builder b, glm::vec3 where, float turn) {
  Builder hut = b.moved({0, 0, 0}, turn);
  hut.box(tiling(Mat::brick, glm::vec3(0.8f)), {-1.4f, 0, -1.3f}, {1.4f, 2.6f, 1.3f}, face_no_bottom);
  hut.box(plain(glm::vec3(0.10f), Finish::stone), {-1.6f, 2.6f, -1.5f}, {1.6f, 2.75f, 1.7f});
  for (int side : {0, 1, 2, 3}) {
    Builder face = hut.moved({0, 0, 0}, 1.5707963f * static_cast<float>(side));
    const float z = (side & 1) ? 1.4f : 1.3f;
    if (side == 0 || side == 3)
      face.box(plain({0.05f, 0.09f, 0.08f}, Finish::gloss), {-0.5f, 0, z}, {0.5f, 2.1f, z + 0.05f}, face_no_back);
  }
  hut.box(glow(Glow::candle), {-1.15f, 2.12f, 1.31f}, {-1.0f, 2.30f, 1.43f});
  add_light(
      scene, "roof_terrace_lamp", scene.group("buildings"),
      where + glm::vec3(glm::rotate(glm::mat4(1.0f), turn, glm::vec3(0, 1, 0)) * glm::vec4(-1.08f, 2.1f, 1.75f, 0.0f)),
      {{1.0f, 0.66f, 0.32f}, 60.0f, 14.0f, 0, 0, false, 0.1f});
  for (glm::vec2 p : {glm::vec2(-3.4f, -2.0f), glm::vec2(-2.6f, -3.2f), glm::vec2(3.0f, -1.2f)}) {
    b.cylinder(plain(glm::vec3(0.15f, 0.16f, 0.17f), Finish::iron), {p.x, 0, p.y}, {p.x, 0.7f, p.y}, 0.11f, 0.11f, 8);
    b.cylinder(plain(glm::vec3(0.15f, 0.16f, 0.17f), Finish::iron), {p.x, 0.74f, p.y}, {p.x, 0.9f, p.y}, 0.2f, 0.02f, 8,
               true);
  }
}

}  // namespace

// A corner house: three facades round a cut corner, a mansard that follows them.
void add_corner(Scene& scene, const std::string& name, int sx, int sz, Style style,
                const std::array<Facade, 3>& grounds, std::uint32_t seed) {
  Dice dice{seed};
  Mesh mesh;
  mesh.name = name;
  Builder world(mesh);
  const auto at = [&](float x, float z) {
    return glm::vec3(x * static_cast<float>(sx), 0.0f, z * static_cast<float>(sz));
  };
  const float cz = lane_wall_m + corner_cut_m;
  const float cx = main_wall_m + corner_cut_m;
  const std::array<glm::vec3, 4> line{{at(main_wall_m, cz + corner_facade_m), at(main_wall_m, cz), at(cx, lane_wall_m),
                                       at(cx + corner_facade_m, lane_wall_m)}};
  const std::array<glm::vec3, 3> outs{{{-static_cast<float>(sx), 0, 0},
                                       glm::normalize(glm::vec3(-static_cast<float>(sx), 0, -static_cast<float>(sz))),
                                       {0, 0, -static_cast<float>(sz)}}};
  const float miter = std::tan(0.39269908f);
  const float eaves = eaves_height_m(style);
  const int parent = scene.group("buildings");
  std::array<glm::mat4, 3> frames;
  for (std::size_t k = 0; k < 3; ++k) {
    Facade f = grounds[k];
    f.width_m = glm::length(line[k + 1] - line[k]);
    const Frontage span{line[k], line[k + 1], outs[k]};
    frames[k] = plot_frame(span, 0.0f, f.width_m);
    const glm::vec3 left(frames[k][3]);
    const bool starts_at_line = glm::length(left - line[k]) < 0.01f;  // left end is this span's first point
    const bool inner_first = k > 0;
    const bool inner_last = k < 2;
    f.miter_left = (starts_at_line ? inner_first : inner_last) ? miter : 0.0f;
    f.miter_right = (starts_at_line ? inner_last : inner_first) ? miter : 0.0f;
    f.downpipe = k != 1;
    Builder b = world.at(frames[k]);
    facade(b, style, f, dice);
  }
  const float rise = style.roof == Roof::flat ? 0.0f : 2.9f;
  const float inset = style.roof == Roof::flat ? -0.02f : 1.2f;
  const auto plan = [&](float d, float y) {  // the outline moved inwards by d
    const float k = d * miter;
    std::vector<glm::vec3> p{at(main_wall_m + d, cz + corner_facade_m), at(main_wall_m + d, cz + k),
                             at(cx + k, lane_wall_m + d), at(cx + corner_facade_m, lane_wall_m + d)};
    for (glm::vec3& v : p) v.y = y;
    return p;
  };
  const auto low = plan(-0.2f, eaves);
  const auto high = plan(inset, eaves + rise);
  const bool flip = sx * sz > 0;
  for (std::size_t k = 0; k < 3; ++k) {
    Builder b = world.at(frames[k]);
    const float w = glm::length(line[k + 1] - line[k]);
    if (style.roof == Roof::flat) {
      parapet(b, style, w, eaves, k > 0, k < 2, miter, glm::length(glm::vec3(frames[k][3]) - line[k]) < 0.01f);
      continue;
    }
    mansard_side(world, b, low[k], low[k + 1], high[k], high[k + 1], flip, w, k == 1 ? 1 : 3, rise, inset, eaves, style,
                 dice);
  }
  std::vector<glm::vec3> cap{high[0], high[1], high[2], high[3], at(cx + corner_facade_m, cz + corner_facade_m)};
  cap[4].y = eaves + rise;
  if (flip) std::reverse(cap.begin(), cap.end());
  world.fan(plain(glm::vec3(0.07f), Finish::stone), cap);
  if (style.roof == Roof::flat)
    terrace(scene, world.moved(at(cx + 5.5f, cz + 5.5f) + glm::vec3(0, eaves, 0)),
            at(cx + 5.5f, cz + 5.5f) + glm::vec3(0, eaves, 0), flip ? 1.5707963f : 0.0f);
  // Party walls towards the neighbours, up to the top of the mansard.
  const Paint blind = tiling(Mat::stucco, glm::vec3(0.4f, 0.36f, 0.32f));
  const auto up = [](glm::vec3 p, float y) { return glm::vec3(p.x, y, p.z); };
  const glm::vec3 a = line[0], c = line[3], e = at(cx + corner_facade_m, cz + corner_facade_m);
  const auto wall = [&](glm::vec3 p, glm::vec3 q) {
    const float t = eaves + rise;
    if (flip)
      world.quad(blind, up(p, 0), up(q, 0), up(q, t), up(p, t));
    else
      world.quad(blind, up(q, 0), up(p, 0), up(p, t), up(q, t));
  };
  wall(a, e);
  wall(e, c);
  chimney(world, up(0.5f * (a + e), eaves + rise - 0.3f), 2.0f, 3);
  chimney(world, up(0.5f * (c + e), eaves + rise - 0.3f), 2.0f, 2);
  const int node = add_node(scene, name, parent, scene.add_mesh(std::move(mesh)));
  for (std::size_t k = 0; k < 3; k += 2) {
    if (grounds[k].ground != Ground::shop) continue;
    add_light(scene, name + "_window_" + std::to_string(k), parent,
              glm::vec3(frames[k] * glm::vec4(0.5f * corner_facade_m, 2.1f, 1.0f, 1.0f)),
              {{1.0f, 0.72f, 0.42f}, 40.0f, 10.0f, 0, 0, false, 0.6f});
  }
  for (std::size_t k = 0; k < 3; ++k) {
    mark_drip(scene, node, frames[k] * glm::translate(glm::mat4(1.0f), {0.0f, eaves - 0.1f, 0.53f}),
              glm::length(line[k + 1] - line[k]), 2.0f, 2.0f, {.edge_share = 0.1f});
  }
}

}  // namespace petrichor::city
