// Marlowe's, on the corner by the crossing: glass on three sides, a lit room full of toys, neon over the door.
#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "content/city/atlases.hpp"
#include "content/city/facade.hpp"
#include "content/city/lettering.hpp"
#include "content/city/neon.hpp"
#include "content/city/parts.hpp"
#include "content/city/plan.hpp"
#include "content/city/toys.hpp"

namespace petrichor::city {
namespace {

constexpr float wall_top_m = 4.2f;  // the corner house's ground floor
constexpr float floor_m = 0.30f;
constexpr float ceiling_m = 3.45f;
constexpr float riser_m = 0.62f;
constexpr float glass_top_m = 3.0f;
constexpr float fascia_top_m = 3.92f;
constexpr float back_z_m = -15.2f;  // interior walls
constexpr float back_x_m = 16.8f;

const glm::vec3 lacquer(0.16f, 0.010f, 0.014f);
const glm::vec3 gilt(0.75f, 0.5f, 0.2f);

struct Front {
  Scene& scene;
  int parent;
  glm::mat4 frame;
};

// Glass from x0 to x1 between slim bronze bars, on a panelled riser, under a fascia.
void glazing(const Front& front, Builder& b, float x0, float x1, int panes, bool door_in_middle) {
  const Paint wood = plain(lacquer, Finish::gloss);
  const Paint bronze = plain({0.30f, 0.19f, 0.09f}, Finish::brass);
  const Paint gold = plain(gilt, Finish::brass);
  const float z = -0.08f;
  for (int k = 0; k < panes; ++k) {
    const float a = x0 + (x1 - x0) * static_cast<float>(k) / static_cast<float>(panes);
    const float c = x0 + (x1 - x0) * static_cast<float>(k + 1) / static_cast<float>(panes);
    const bool is_door = door_in_middle && k == panes / 2;
    const float low = is_door ? floor_m + 0.35f : riser_m;
    const float deep = is_door ? -0.55f : z;
    b.quad({Mat::glass, glm::vec3(1.0f), {}}, {a, low, deep}, {c, low, deep}, {c, glass_top_m, deep},
           {a, glass_top_m, deep});
    mark_pane(front.scene, front.parent,
              front.frame * glm::translate(glm::mat4(1.0f), {0.5f * (a + c), 0.5f * (low + glass_top_m), deep}),
              {c - a, glass_top_m - low});
    if (is_door) {
      b.box(wood, {a, floor_m, deep - 0.03f}, {c, low, deep + 0.03f}, face_no_bottom);
      b.box(wood, {a, low, deep - 0.03f}, {a + 0.12f, 2.5f, deep + 0.03f}, face_all);
      b.box(wood, {c - 0.12f, low, deep - 0.03f}, {c, 2.5f, deep + 0.03f}, face_all);
      b.box(wood, {a, 2.38f, deep - 0.03f}, {c, 2.5f, deep + 0.03f}, face_all);
      b.cylinder(gold, {c - 0.2f, 1.1f, deep + 0.08f}, {c - 0.2f, 1.6f, deep + 0.08f}, 0.014f, 0.014f, 6);
      for (float s : {a, c}) {  // glass cheeks of the porch
        if (s == a)
          b.quad({Mat::glass, glm::vec3(1.0f), {}}, {s, riser_m, z}, {s, riser_m, deep}, {s, glass_top_m, deep},
                 {s, glass_top_m, z});
        else
          b.quad({Mat::glass, glm::vec3(1.0f), {}}, {s, riser_m, deep}, {s, riser_m, z}, {s, glass_top_m, z},
                 {s, glass_top_m, deep});
        b.box(wood, {s - 0.03f, 0.1f, deep}, {s + 0.03f, riser_m, z}, face_sides | face_top);
      }
      b.box(plain(glm::vec3(0.3f), Finish::stone), {a, 0.0f, deep}, {c, floor_m - 0.08f, 0.25f},
            face_no_back & ~face_bottom);
    } else {
      b.box(wood, {a, 0.1f, -0.2f}, {c, riser_m, 0.03f}, face_front | face_top);
      b.box(wood, {a + 0.14f, 0.24f, 0.03f}, {c - 0.14f, riser_m - 0.1f, 0.05f}, face_no_back);
      b.box(gold, {a, riser_m - 0.05f, 0.03f}, {c, riser_m - 0.03f, 0.045f}, face_front | face_top | face_bottom);
    }
  }
  for (int k = 0; k <= panes; ++k) {
    const float x = x0 + (x1 - x0) * static_cast<float>(k) / static_cast<float>(panes);
    b.box(bronze, {x - 0.025f, riser_m, z - 0.04f}, {x + 0.025f, glass_top_m, z + 0.04f},
          face_all & ~(face_top | face_bottom));
  }
  b.box(bronze, {x0, 2.5f, z - 0.03f}, {x1, 2.56f, z + 0.03f}, face_all & ~face_sides);
  // Fascia with a gilt line and a small cornice.
  b.box(wood, {x0, glass_top_m, -0.25f}, {x1, fascia_top_m, 0.10f}, face_front | face_bottom | face_back);
  for (float y : {glass_top_m + 0.05f, fascia_top_m - 0.08f})
    b.box(gold, {x0, y, 0.10f}, {x1, y + 0.02f, 0.112f}, face_front | face_top | face_bottom);
  const std::array<glm::vec2, 5> cornice{{{0.10f, fascia_top_m - 0.05f},
                                          {0.18f, fascia_top_m},
                                          {0.30f, fascia_top_m + 0.06f},
                                          {0.32f, fascia_top_m + 0.14f},
                                          {0.0f, fascia_top_m + 0.18f}}};
  b.moulding(wood, cornice, x0, x1);
}

void pilaster(Builder& b, float x) {
  const Paint wood = plain(lacquer, Finish::gloss);
  const Paint gold = plain(gilt, Finish::brass);
  b.box(wood, {x - 0.15f, 0.1f, -0.2f}, {x + 0.15f, fascia_top_m, 0.13f}, face_all & ~(face_top | face_bottom));
  b.box(wood, {x - 0.19f, 0.1f, 0.0f}, {x + 0.19f, 0.55f, 0.17f}, face_no_back);
  b.box(gold, {x - 0.18f, glass_top_m - 0.2f, 0.0f}, {x + 0.18f, glass_top_m - 0.06f, 0.16f}, face_no_back);
  b.box(wood, {x - 0.18f, fascia_top_m - 0.14f, 0.0f}, {x + 0.18f, fascia_top_m + 0.2f, 0.33f}, face_no_back);
}

void board(Builder& b, float x0, float x1) {
  const float half_h = 0.30f;
  const float half_w = std::min(0.5f * (x1 - x0) - 0.2f, half_h * sign_aspect(Sign::toys));
  const float cx = 0.5f * (x0 + x1);
  const float cy = 0.5f * (glass_top_m + fascia_top_m) - 0.01f;
  const float hh = half_w / sign_aspect(Sign::toys);
  b.picture(Mat::signs, glm::vec3(1.0f), sign_rect(Sign::toys), {cx - half_w, cy - hh, 0.115f},
            {cx + half_w, cy - hh, 0.115f}, {cx + half_w, cy + hh, 0.115f}, {cx - half_w, cy + hh, 0.115f});
}

void shelves(Builder b, float width, Dice& dice) {  // in a wall frame
  const Paint wood = plain({0.26f, 0.13f, 0.055f}, Finish::paint);
  b.quad(plain({0.42f, 0.33f, 0.19f}, Finish::matte), {0, floor_m, 0}, {width, floor_m, 0}, {width, ceiling_m, 0},
         {0, ceiling_m, 0});
  for (float y : {0.55f, 1.05f, 1.55f, 2.05f, 2.55f}) {
    b.box(wood, {0.1f, y, 0.0f}, {width - 0.1f, y + 0.035f, 0.36f}, face_front | face_top | face_bottom);
    for (float x = 0.35f; x < width - 0.3f;) {
      const float size = dice.between(0.24f, 0.38f);
      if (dice.chance(0.85f)) any_toy(b.moved({x, y + 0.036f, 0.18f}, dice.between(-0.3f, 0.3f)), size, dice);
      x += size * dice.between(1.15f, 1.5f);
    }
  }
  for (float x = 0.1f; x < width; x += (width - 0.2f) / 5.0f)
    b.box(wood, {x - 0.025f, floor_m, 0}, {x + 0.025f, 2.7f, 0.37f}, face_front | face_sides);
  b.box(glow(Glow::shop), {0.15f, 2.95f, 0.0f}, {width - 0.15f, 2.99f, 0.05f},
        face_front | face_bottom);  // a hidden strip over the shelves
}

void room(Scene& scene, int parent) {
  Mesh mesh;
  mesh.name = "toy_shop_room";
  Builder b(mesh);
  Dice dice{555};
  const float x0 = main_wall_m + 0.1f;
  const float z0 = -lane_wall_m - 0.1f;
  const float cut = corner_cut_m;
  const std::array<glm::vec3, 5> plan{{{x0, floor_m, back_z_m},
                                       {x0, floor_m, z0 - cut},
                                       {x0 + cut, floor_m, z0},
                                       {back_x_m, floor_m, z0},
                                       {back_x_m, floor_m, back_z_m}}};
  b.fan(plain({0.24f, 0.12f, 0.055f}, Finish::gloss), plan);
  std::array<glm::vec3, 5> above{plan[4], plan[3], plan[2], plan[1], plan[0]};
  for (glm::vec3& p : above) p.y = ceiling_m;
  b.fan(plain({0.62f, 0.55f, 0.42f}, Finish::matte), above);
  shelves(b.at(wall_frame({x0, 0, back_z_m}, {0, 0, 1})), back_x_m - x0, dice);
  shelves(b.at(wall_frame({back_x_m, 0, back_z_m}, {-1, 0, 0})), z0 - back_z_m, dice);
  // A counter with the till, display tables, and the large pieces in the windows.
  b.box(plain({0.20f, 0.09f, 0.035f}, Finish::gloss), {13.6f, floor_m, -12.8f}, {16.0f, 1.25f, -12.1f}, face_no_bottom);
  b.box(plain(gilt, Finish::brass), {14.4f, 1.25f, -12.7f}, {14.85f, 1.6f, -12.3f}, face_no_bottom);
  for (glm::vec2 t : {glm::vec2(11.6f, -11.0f), glm::vec2(13.9f, -9.3f)}) {
    Builder table = b.moved({t.x, floor_m, t.y});
    table.cylinder(plain({0.26f, 0.12f, 0.05f}, Finish::gloss), {0, 0.7f, 0}, {0, 0.76f, 0}, 0.75f, 0.75f, 16, true,
                   true);
    table.cylinder(plain({0.26f, 0.12f, 0.05f}, Finish::gloss), {0, 0, 0}, {0, 0.7f, 0}, 0.3f, 0.12f, 10);
    for (int k = 0; k < 5; ++k) {
      const float a = 1.2566f * static_cast<float>(k);
      any_toy(table.moved({0.45f * std::cos(a), 0.76f, 0.45f * std::sin(a)}, a), 0.3f, dice);
    }
  }
  bear(b.moved({9.7f, riser_m, -10.6f}, -1.2f), 1.15f, {0.36f, 0.18f, 0.06f});
  carousel(b.moved({12.4f, riser_m, -7.45f}), 1.25f);
  rocking_horse(b.moved({8.95f, riser_m, -12.6f}, -1.3f), 1.05f);
  train(b.moved({15.0f, riser_m, -7.25f}), 0.55f, {0.03f, 0.16f, 0.07f});
  ball(b.moved({13.5f, riser_m, -7.1f}), 0.42f, {0.6f, 0.05f, 0.04f}, {0.65f, 0.6f, 0.5f});
  house_toy(b.moved({14.1f, riser_m + 0.3f, -8.2f}), 0.8f, {0.35f, 0.07f, 0.04f});
  bear(b.moved({16.1f, riser_m, -7.5f}, -0.3f), 0.6f, {0.55f, 0.42f, 0.26f});
  drum(b.moved({8.75f, riser_m, -11.5f}), 0.5f, {0.05f, 0.12f, 0.4f});
  soldier(b.moved({8.6f, riser_m, -13.7f}, -1.57f), 0.9f, {0.55f, 0.04f, 0.04f});
  soldier(b.moved({8.6f, riser_m, -14.3f}, -1.57f), 0.9f, {0.04f, 0.12f, 0.45f});
  blocks(b.moved({8.75f, riser_m, -10.2f}, -1.4f), 0.55f, dice);
  // The platforms that the window pieces stand on.
  const Paint stage = plain({0.18f, 0.015f, 0.02f}, Finish::matte);
  b.box(stage, {x0, floor_m, -14.9f}, {x0 + 1.9f, riser_m, -10.0f}, face_right | face_top | face_front | face_back);
  b.box(stage, {11.6f, floor_m, z0 - 1.9f}, {16.6f, riser_m, z0}, face_back | face_top | face_sides);
  // Hanging things: lamps, stars, a balloon.
  for (glm::vec3 p : {glm::vec3(10.9f, 2.75f, -9.3f), glm::vec3(14.3f, 2.75f, -8.6f), glm::vec3(10.2f, 2.75f, -12.8f),
                      glm::vec3(14.3f, 2.75f, -12.4f)}) {
    b.cylinder(plain(glm::vec3(0.02f), Finish::iron), p, {p.x, ceiling_m, p.z}, 0.01f, 0.01f, 4);
    sphere(b, glow(Glow::candle), p, glm::vec3(0.15f), 10, 6);
  }
  sphere(b, plain({0.62f, 0.42f, 0.04f}, Finish::paint), {9.3f, 2.55f, -11.3f}, {0.3f, 0.36f, 0.3f}, 10, 7);
  b.box(plain({0.25f, 0.13f, 0.05f}, Finish::matte), {9.2f, 1.95f, -11.4f}, {9.4f, 2.08f, -11.2f});
  for (int k = 0; k < 9; ++k) {
    const glm::vec3 p(dice.between(8.6f, 15.5f), dice.between(2.35f, 2.85f), -7.2f - dice.between(0.0f, 2.5f));
    if (p.x - main_wall_m + p.z + lane_wall_m < 1.0f - 3.0f + 0.6f) continue;
    b.box(glow(Glow::shop), p - 0.025f, p + 0.025f);
  }
  add_mesh_node(scene, parent, std::move(mesh));
}

}  // namespace

void add_toy_shop(Scene& scene) {
  const int parent = scene.group("toy_shop");
  room(scene, parent);
  Mesh mesh;
  mesh.name = "toy_shop_front";
  const glm::mat4 main_frame = wall_frame({main_wall_m, 0, -19.5f}, {-1, 0, 0});
  const glm::mat4 cut_frame = wall_frame({main_wall_m, 0, -9.5f}, glm::normalize(glm::vec3(-1, 0, 1)));
  const glm::mat4 lane_frame = wall_frame({main_wall_m + corner_cut_m, 0, -lane_wall_m}, {0, 0, 1});
  const float cut_width = corner_cut_m * std::sqrt(2.0f);
  Builder world(mesh);
  Builder main_side = world.at(main_frame);
  Builder cut = world.at(cut_frame);
  Builder lane = world.at(lane_frame);
  const Paint stone = tiling(Mat::ashlar, glm::vec3(0.8f));

  glazing({scene, parent, main_frame}, main_side, 4.5f, 9.85f, 4, false);
  glazing({scene, parent, lane_frame}, lane, 0.15f, 5.6f, 4, false);
  glazing({scene, parent, cut_frame}, cut, 0.12f, cut_width - 0.12f, 3, true);
  for (float x : {4.5f, 9.85f}) pilaster(main_side, x);
  for (float x : {0.15f, 5.6f}) pilaster(lane, x);
  board(main_side, 4.7f, 9.7f);
  board(lane, 0.3f, 5.5f);
  // Stone above the fascia, and the rest of the ground floor: a house door and a window on each street.
  const auto rest = [&](Builder& b, float x0, float x1, float shop0, float shop1) {
    b.quad(stone, {shop0, fascia_top_m, 0}, {shop1, fascia_top_m, 0}, {shop1, wall_top_m, 0}, {shop0, wall_top_m, 0});
    Builder part = b.moved({x0, 0, 0});
    Style style;
    style.trim = {0.40f, 0.37f, 0.32f};
    style.joinery = {0.5f, 0.47f, 0.4f};
    Dice dice{91};
    const float w = x1 - x0;
    wall_with_openings(
        part, stone, w, 0.0f, wall_top_m,
        {{0.30f * w - 0.65f, 0.30f * w + 0.65f, 0.1f, 2.8f}, {0.75f * w - 0.55f, 0.75f * w + 0.55f, 1.15f, 3.0f}});
    door(part, style, {0.02f, 0.07f, 0.06f}, 0.30f * w, 1.3f, 2.7f, true);
    window(part, style, 0.75f * w, 1.15f, 1.1f, 1.85f, Head::hood, false, dice);
  };
  rest(main_side, 0.0f, 4.5f, 4.5f, 10.0f);
  rest(lane, 5.6f, 10.0f, 0.0f, 5.6f);
  cut.quad(stone, {0, fascia_top_m, 0}, {cut_width, fascia_top_m, 0}, {cut_width, wall_top_m, 0}, {0, wall_top_m, 0});
  awning(main_side, 4.55f, 9.8f, glass_top_m + 0.03f, 0.62f, 1.35f, {0.42f, 0.020f, 0.025f}, {0.52f, 0.47f, 0.38f});
  awning(lane, 0.2f, 5.55f, glass_top_m + 0.03f, 0.62f, 1.35f, {0.42f, 0.020f, 0.025f}, {0.52f, 0.47f, 0.38f});
  mark_drip(scene, parent, main_frame * glm::translate(glm::mat4(1.0f), {4.55f, glass_top_m - 0.83f, 1.35f}), 5.25f,
            1.4f, 1.5f, {.edge_share = 0.4f, .sites = awning_stripes(5.25f)});
  mark_drip(scene, parent, lane_frame * glm::translate(glm::mat4(1.0f), {0.2f, glass_top_m - 0.83f, 1.35f}), 5.35f,
            1.4f, 1.5f, {.edge_share = 0.4f, .sites = awning_stripes(5.35f)});

  // TOY SHOP in tubes over the door, ringed in blue.
  Builder tubes = cut.moved({0, 0, 0.12f});
  const float h = 0.46f;
  const float width = neon_width("TOY SHOP", 0.06f) * h;
  neon_text(tubes, Glow::neon_red, "TOY SHOP", 0.5f * (cut_width - width), 3.24f, h, 0.018f);
  std::vector<glm::vec3> ring;
  for (int k = 0; k < 28; ++k) {
    const float t = 6.2831853f * static_cast<float>(k) / 28.0f;
    const auto power = [](float v) { return std::copysign(std::pow(std::abs(v), 0.35f), v); };
    ring.emplace_back(0.5f * cut_width + 1.92f * power(std::cos(t)), 3.47f + 0.39f * power(std::sin(t)), 0.05f);
  }
  neon_line(tubes, Glow::neon_blue, ring, 0.013f, true);
  // A star above, and the hanging board with the bear.
  std::vector<glm::vec3> star;
  for (int k = 0; k < 10; ++k) {
    const float t = 1.5707963f + 6.2831853f * static_cast<float>(k) / 10.0f;
    const float r = (k & 1) ? 0.11f : 0.26f;
    star.emplace_back(0.5f * cut_width + r * std::cos(t), 4.33f + r * std::sin(t), 0.30f);
  }
  neon_line(tubes, Glow::neon_amber, star, 0.013f, true);
  Builder hanging = main_side.moved({9.3f, 0, 0});
  const Paint iron = plain(glm::vec3(0.025f), Finish::iron);
  hanging.box(iron, {-0.02f, 5.55f, 0.0f}, {0.02f, 5.59f, 1.15f});
  hanging.cylinder(iron, {0, 5.95f, 0.02f}, {0, 5.58f, 1.0f}, 0.012f, 0.012f, 4);
  for (float z : {0.35f, 0.95f}) hanging.cylinder(iron, {0, 5.38f, z}, {0, 5.56f, z}, 0.008f, 0.008f, 4);
  const float y0 = 4.62f, y1 = 5.38f, za = 0.27f, zb = 1.03f;
  hanging.box(plain(lacquer, Finish::gloss), {-0.025f, y0, za}, {0.025f, y1, zb});
  hanging.picture(Mat::signs, glm::vec3(1.0f), sign_rect(Sign::hanging_bear), {-0.027f, y0, za}, {-0.027f, y0, zb},
                  {-0.027f, y1, zb}, {-0.027f, y1, za});
  hanging.picture(Mat::signs, glm::vec3(1.0f), sign_rect(Sign::hanging_bear), {0.027f, y0, zb}, {0.027f, y0, za},
                  {0.027f, y1, za}, {0.027f, y1, zb});
  add_mesh_node(scene, parent, std::move(mesh));

  const glm::vec3 warm(1.0f, 0.70f, 0.38f);
  add_light(scene, "toy_shop_lamp_0", parent, {10.9f, 2.5f, -9.3f}, {warm, 170.0f, 18.0f, 0, 0, true, 0.15f});
  add_light(scene, "toy_shop_lamp_1", parent, {14.3f, 2.5f, -8.6f}, {warm, 170.0f, 18.0f, 0, 0, true, 0.15f});
  add_light(scene, "toy_shop_lamp_2", parent, {10.2f, 2.5f, -12.8f}, {warm, 150.0f, 16.0f, 0, 0, false, 0.15f});
  add_light(scene, "toy_shop_lamp_3", parent, {14.3f, 2.5f, -12.4f}, {warm, 120.0f, 12.0f, 0, 0, false, 0.15f});
  const auto before_cut = [&](float x, float y, float z) { return glm::vec3(cut_frame * glm::vec4(x, y, z, 1)); };
  add_light(scene, "toy_shop_neon_left", parent, before_cut(1.2f, 3.5f, 0.6f),
            {{1.0f, 0.09f, 0.05f}, 60.0f, 14.0f, 0, 0, false, 0.4f});
  add_light(scene, "toy_shop_neon_right", parent, before_cut(3.0f, 3.5f, 0.6f),
            {{1.0f, 0.10f, 0.12f}, 60.0f, 14.0f, 0, 0, false, 0.4f});
}

}  // namespace petrichor::city
