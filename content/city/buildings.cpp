// The plots: which house stands where, in which dress.
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

constexpr float house_depth_m = 11.0f;

Style make_style(Dice& dice) {
  static const std::array<glm::vec3, 9> stucco{{{0.86f, 0.72f, 0.46f},
                                                {0.78f, 0.52f, 0.40f},
                                                {0.72f, 0.74f, 0.66f},
                                                {0.88f, 0.82f, 0.68f},
                                                {0.60f, 0.66f, 0.70f},
                                                {0.80f, 0.62f, 0.52f},
                                                {0.66f, 0.70f, 0.52f},
                                                {0.90f, 0.78f, 0.56f},
                                                {0.70f, 0.42f, 0.32f}}};
  static const std::array<glm::vec3, 5> joinery{{{0.55f, 0.53f, 0.48f},
                                                 {0.05f, 0.10f, 0.08f},
                                                 {0.16f, 0.08f, 0.04f},
                                                 {0.45f, 0.42f, 0.36f},
                                                 {0.10f, 0.13f, 0.16f}}};
  static const std::array<glm::vec3, 4> leaves{
      {{0.03f, 0.09f, 0.07f}, {0.10f, 0.05f, 0.03f}, {0.06f, 0.09f, 0.14f}, {0.14f, 0.13f, 0.10f}}};
  Style s;
  const int kind = dice.below(5);
  const glm::vec2 shift(dice.between(0.0f, 3.0f), dice.between(0.0f, 3.0f));
  s.trim = glm::vec3(0.40f, 0.375f, 0.33f) * dice.between(0.8f, 1.1f);
  s.joinery = joinery[static_cast<std::size_t>(dice.below(5))];
  s.shutters = leaves[static_cast<std::size_t>(dice.below(4))];
  s.floors = 3 + dice.below(3);
  s.floor_height_m = dice.between(2.95f, 3.4f);
  s.ground_height_m = dice.between(3.95f, 4.35f);
  s.bay_m = dice.between(2.3f, 2.9f);
  s.window_width_m = dice.between(1.0f, 1.25f);
  s.window_height_m = dice.between(1.7f, 2.0f);
  s.lit = dice.between(0.18f, 0.40f);
  switch (kind) {
    case 0:  // brick with stone dressings
      s.wall = tiling(Mat::brick, glm::vec3(dice.between(0.85f, 1.0f)), shift);
      s.ground_wall = tiling(Mat::ashlar, glm::vec3(0.85f), shift);
      s.head = dice.chance(0.5f) ? Head::arch : Head::lintel;
      s.quoins = dice.chance(0.5f);
      s.dentils = true;
      s.roof = dice.chance(0.45f) ? Roof::gable : Roof::saddle;
      break;
    case 1:  // palace stone
      s.wall = tiling(Mat::ashlar, glm::vec3(dice.between(0.8f, 1.0f)), shift);
      s.ground_wall = tiling(Mat::ashlar, glm::vec3(0.8f), shift);
      s.head = Head::pediment;
      s.dentils = true;
      s.roof = Roof::mansard;
      s.balconies = 0.45f;
      s.floors = std::min(s.floors, 4);
      break;
    default: {  // stucco in the town's colours
      const glm::vec3 tint = stucco[static_cast<std::size_t>(dice.below(9))] * dice.between(0.75f, 1.0f);
      s.wall = tiling(Mat::stucco, tint, shift);
      s.ground_wall =
          dice.chance(0.5f) ? tiling(Mat::ashlar, glm::vec3(0.8f), shift) : tiling(Mat::stucco, tint * 0.7f, shift);
      s.head = kind == 2 ? Head::hood : kind == 3 ? Head::lintel : Head::pediment;
      s.has_shutters = kind == 3;
      s.quoins = dice.chance(0.4f);
      s.dentils = kind == 4;
      s.roof = dice.chance(0.3f) ? Roof::mansard : Roof::saddle;
      s.balconies = dice.chance(0.5f) ? 0.4f : 0.12f;
      break;
    }
  }
  return s;
}

void side_walls(Builder& b, const Style& style, float w, float depth, float back_from, float eaves) {
  const Paint blind =
      tiling(Mat::stucco, style.wall.mat == Mat::stucco ? style.wall.colour * 0.6f : glm::vec3(0.4f, 0.36f, 0.32f));
  b.quad(blind, {0, 0, -depth}, {0, 0, 0}, {0, eaves, 0}, {0, eaves, -depth});
  b.quad(blind, {w, 0, 0}, {w, 0, -depth}, {w, eaves, -depth}, {w, eaves, 0});
  b.quad(blind, {w, back_from, -depth}, {0, back_from, -depth}, {0, eaves, -depth}, {w, eaves, -depth});
}

glm::vec3 roof_tint(Dice& dice) {
  return glm::vec3(1.0f, dice.between(0.85f, 1.0f), dice.between(0.8f, 1.0f)) * dice.between(0.7f, 1.0f);
}

// A house between party walls; marks its gutter and awning as drip sources.
void add_house(Scene& scene, const std::string& name, const glm::mat4& frame, const Style& style, const Facade& f,
               float depth, std::uint32_t seed) {
  Dice dice{seed};
  Mesh mesh;
  mesh.name = name;
  Builder b(mesh);
  facade(b, style, f, dice);
  const float eaves = eaves_height_m(style);
  side_walls(b, style, f.width_m, depth, f.ground == Ground::none ? style.ground_height_m : 0.0f, eaves);
  const RoofSpan span{f.width_m, depth, eaves};
  const glm::vec3 tint = roof_tint(dice);
  switch (style.roof) {
    case Roof::saddle:
      saddle_roof(b, style, span, tint, dice);
      break;
    case Roof::mansard:
      mansard_roof(b, style, span, tint, dice);
      break;
    case Roof::flat:
      flat_roof(b, style, span, dice);
      break;
    case Roof::gable:
      stepped_gable(b, style, span, tint, dice);
      break;
  }
  const int parent = scene.group("buildings");
  const int node = add_node(scene, name, parent, scene.add_mesh(std::move(mesh)), frame);
  if (style.roof == Roof::saddle || style.roof == Roof::mansard) {
    const float z = style.roof == Roof::saddle ? 0.66f : 0.53f;
    mark_drip(scene, node, glm::translate(glm::mat4(1.0f), {0.0f, eaves - 0.1f, z}), f.width_m, 0.5f * depth, 2.0f,
              {.edge_share = 0.04f});
  } else {
    mark_drip(scene, node, glm::translate(glm::mat4(1.0f), {0.0f, eaves - 0.05f, 0.5f}), f.width_m, 0.5f, 3.0f);
  }
  if (f.ground == Ground::shop && std::abs(frame[3].x) < 36.0f && std::abs(frame[3].z) < 36.0f) {
    add_light(scene, name + "_window", parent, glm::vec3(frame * glm::vec4(0.5f * f.width_m, 2.1f, 1.0f, 1.0f)),
              {{1.0f, 0.72f, 0.42f}, 34.0f, 9.0f, 0, 0, false, 0.6f});
  }
  if (f.awning)
    mark_drip(scene, node, glm::translate(glm::mat4(1.0f), {0.35f, 2.01f, 1.5f}), f.width_m - 0.7f, 1.5f, 1.5f,
              {.edge_share = 0.4f, .sites = awning_stripes(f.width_m - 0.7f)});
}

void add_row(Scene& scene, const std::string& name, const Frontage& line, std::uint32_t seed) {
  Dice dice{seed};
  const float length = glm::length(line.to - line.from);
  const int houses = static_cast<int>(std::lround(length / 10.2f));
  std::vector<float> cuts{0.0f};
  for (int k = 1; k < houses; ++k)
    cuts.push_back(length * (static_cast<float>(k) + dice.between(-0.16f, 0.16f)) / static_cast<float>(houses));
  cuts.push_back(length);
  for (int k = 0; k < houses; ++k) {
    const float a = cuts[static_cast<std::size_t>(k)];
    const float c = cuts[static_cast<std::size_t>(k) + 1];
    Style style = make_style(dice);
    if (style.roof == Roof::gable && c - a > 11.0f) style.roof = Roof::saddle;
    Facade f;
    f.width_m = c - a;
    f.ground = dice.chance(k < 2 ? 0.75f : 0.4f) ? Ground::shop : dice.chance(0.2f) ? Ground::gate : Ground::house;
    f.goods = dice.below(4);
    static const std::array<std::array<Sign, 3>, 4> names{{{Sign::books, Sign::antiques, Sign::clocks},
                                                           {Sign::cafe, Sign::wines, Sign::cafe},
                                                           {Sign::bakery, Sign::florist, Sign::bakery},
                                                           {Sign::tailor, Sign::barber, Sign::tailor}}};
    f.sign = static_cast<int>(names[static_cast<std::size_t>(f.goods)][static_cast<std::size_t>(dice.below(3))]);
    f.awning = dice.chance(0.45f);
    static const std::array<glm::vec3, 6> accents{{{0.015f, 0.05f, 0.035f},
                                                   {0.09f, 0.012f, 0.012f},
                                                   {0.015f, 0.03f, 0.07f},
                                                   {0.03f, 0.02f, 0.015f},
                                                   {0.10f, 0.06f, 0.02f},
                                                   {0.03f, 0.035f, 0.035f}}};
    f.accent = accents[static_cast<std::size_t>(dice.below(6))];
    add_house(scene, name + "_" + std::to_string(k), plot_frame(line, a, c), style, f, house_depth_m,
              mix(seed, static_cast<std::uint32_t>(k)));
  }
}

Style corner_style(Mat wall, glm::vec3 tint, Head head, int floors) {
  Style s;
  s.wall = tiling(wall, tint);
  s.ground_wall = tiling(Mat::ashlar, glm::vec3(0.8f));
  s.trim = glm::vec3(0.40f, 0.37f, 0.32f);
  s.joinery = {0.5f, 0.47f, 0.4f};
  s.head = head;
  s.floors = floors;
  s.floor_height_m = 3.25f;
  s.ground_height_m = 4.2f;
  s.bay_m = 2.55f;
  s.dentils = true;
  s.balconies = 0.3f;
  s.lit = 0.33f;
  s.roof = Roof::mansard;
  return s;
}

Style roof_to_stand_on(Style style) {
  style.roof = Roof::flat;
  return style;
}

}  // namespace

void add_buildings(Scene& scene) {
  for (int sx : {-1, 1}) {
    for (int sz : {-1, 1}) {
      const auto fx = static_cast<float>(sx);
      const auto fz = static_cast<float>(sz);
      const float main_from = lane_wall_m + corner_cut_m + corner_facade_m;
      const float lane_from = main_wall_m + corner_cut_m + corner_facade_m;
      const std::string quarter = std::string(sz < 0 ? "n" : "s") + (sx < 0 ? "w" : "e");
      const auto seed = static_cast<std::uint32_t>(100 + 10 * sx + sz);
      add_row(scene, "lamplighter_" + quarter,
              {{fx * main_wall_m, 0, fz * main_from}, {fx * main_wall_m, 0, fz * street_end_m}, {-fx, 0, 0}}, seed);
      add_row(scene, "weathercock_" + quarter,
              {{fx * lane_from, 0, fz * lane_wall_m}, {fx * street_end_m, 0, fz * lane_wall_m}, {0, 0, -fz}},
              seed + 1000);
    }
  }
  Facade shop;
  shop.ground = Ground::shop;
  shop.goods = static_cast<int>(Goods::cafe);
  shop.sign = static_cast<int>(Sign::cafe);
  shop.accent = {0.09f, 0.012f, 0.012f};
  Facade pharmacy = shop;
  pharmacy.goods = static_cast<int>(Goods::bakery);
  pharmacy.sign = static_cast<int>(Sign::pharmacy);
  pharmacy.accent = {0.01f, 0.06f, 0.03f};
  Facade books = shop;
  books.goods = static_cast<int>(Goods::books);
  books.sign = static_cast<int>(Sign::books);
  books.accent = {0.012f, 0.045f, 0.03f};
  Facade small = shop;
  small.sign = -1;
  Facade house;
  Facade none;
  none.ground = Ground::none;
  add_corner(scene, "corner_cafe", -1, -1, corner_style(Mat::stucco, {0.82f, 0.68f, 0.45f}, Head::pediment, 4),
             {shop, small, shop}, 301);
  add_corner(scene, "corner_toy_shop", 1, -1, corner_style(Mat::brick, glm::vec3(0.95f), Head::lintel, 4),
             {none, none, none}, 302);
  Facade books_cut = books;
  books_cut.sign = -1;
  add_corner(scene, "corner_books", -1, 1, roof_to_stand_on(corner_style(Mat::ashlar, glm::vec3(0.9f), Head::hood, 3)),
             {books, books_cut, house}, 303);
  Facade pharmacy_cut = pharmacy;
  pharmacy_cut.sign = -1;
  add_corner(scene, "corner_pharmacy", 1, 1, corner_style(Mat::stucco, {0.66f, 0.42f, 0.34f}, Head::hood, 4),
             {pharmacy, pharmacy_cut, house}, 304);

  // The ends of the streets.
  Style end = corner_style(Mat::ashlar, glm::vec3(0.85f), Head::pediment, 3);
  end.roof = Roof::saddle;
  Facade gate;
  gate.ground = Ground::gate;
  gate.width_m = 2.0f * main_wall_m;
  end.ground_height_m = gate_ground_m;
  Facade arch = gate;
  arch.ground = Ground::none;
  add_house(scene, "north_gate", wall_frame({-main_wall_m, 0, -street_end_m}, {0, 0, 1}), end, arch, house_depth_m,
            401);
  Style hotel = corner_style(Mat::brick, glm::vec3(0.9f), Head::hood, 5);
  hotel.roof = Roof::mansard;
  hotel.lit = 0.45f;
  add_house(scene, "south_hotel", wall_frame({main_wall_m, 0, street_end_m}, {0, 0, -1}), hotel, gate, house_depth_m,
            402);
  gate.width_m = 2.0f * lane_wall_m;
  Style west = corner_style(Mat::stucco, {0.7f, 0.74f, 0.66f}, Head::lintel, 3);
  west.roof = Roof::flat;
  add_house(scene, "west_house", wall_frame({-street_end_m, 0, lane_wall_m}, {1, 0, 0}), west, gate, house_depth_m,
            403);
  Style east = corner_style(Mat::brick, glm::vec3(0.85f), Head::arch, 2);
  east.roof = Roof::gable;
  add_house(scene, "east_house", wall_frame({street_end_m, 0, -lane_wall_m}, {-1, 0, 0}), east, gate, house_depth_m,
            404);
}

glm::mat4 plot_frame(const Frontage& line, float a, float c) {
  const glm::vec3 along = glm::normalize(line.to - line.from);
  const glm::vec3 p = line.from + along * a;
  const glm::vec3 q = line.from + along * c;
  const glm::vec3 right = glm::cross(glm::vec3(0, 1, 0), line.out);
  return wall_frame(glm::dot(p, right) < glm::dot(q, right) ? p : q, line.out);
}

}  // namespace petrichor::city
