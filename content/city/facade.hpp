#pragma once
// Walls with windows, mouldings and doors, in a wall frame (x right, y up, z out of the wall).

#include "content/city/builder.hpp"
#include "content/city/dice.hpp"

namespace petrichor::city {

enum class Head : std::uint8_t { none, lintel, hood, pediment, arch };
enum class Ground : std::uint8_t { none, shop, house, gate };
enum class Roof : std::uint8_t { saddle, mansard, flat, gable };

struct Style {
  Paint wall;
  Paint ground_wall;
  glm::vec3 trim{0.45f};    // stone dressings, linear albedo
  glm::vec3 joinery{0.5f};  // window frames
  glm::vec3 shutters{0.05f, 0.1f, 0.07f};
  Head head = Head::lintel;
  Roof roof = Roof::saddle;
  float ground_height_m = 4.0f;
  float floor_height_m = 3.2f;
  int floors = 4;      // above the ground floor
  float bay_m = 2.5f;  // about
  float window_width_m = 1.15f;
  float window_height_m = 1.9f;
  float lit = 0.30f;  // share of windows with somebody at home
  bool has_shutters = false;
  bool string_courses = true;
  bool quoins = false;
  bool dentils = false;
  float balconies = 0.0f;  // share of the bays of the first and third floor
};

struct Facade {
  float width_m = 10.0f;
  Ground ground = Ground::house;
  int goods = 0;  // which shop window
  int sign = -1;  // Sign of the fascia
  bool awning = false;
  glm::vec3 accent{0.03f, 0.06f, 0.05f};  // shop joinery and doors
  float miter_left = 0.0f, miter_right = 0.0f;
  bool downpipe = true;
  bool lettered = false;
};

float eaves_height_m(const Style&);

// A wall from y0 to y1 with rectangular openings, all in the plane z = 0.
struct Opening {
  float x0, x1, y0, y1;
};
void wall_with_openings(Builder&, const Paint&, float width, float y0, float y1, std::vector<Opening> openings);

// A sash in an opening: reveals, frame, glazing bars, pane, sill and head. Bottom middle at (x, y).
void window(Builder&, const Style&, float x, float y, float width, float height, Head head, bool shutters, Dice&);
void balcony(Builder&, const Style&, float x, float y, float width);
void door(Builder&, const Style&, glm::vec3 colour, float x, float width, float height, bool lamp_above);
void shop_front(Builder&, const Style&, const Facade&, float x0, float x1, Dice&);
void awning(Builder&, float x0, float x1, float y_top, float drop, float reach, glm::vec3 stripe, glm::vec3 ground);

void facade(Builder&, const Style&, const Facade&, Dice&);

}  // namespace petrichor::city
