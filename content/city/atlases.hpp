#pragma once
// Pictures that do not repeat: interiors behind windows, goods behind shop windows, signs and posters.

#include <string>

#include "content/city/builder.hpp"
#include "content/city/canvas.hpp"

namespace petrichor::city {

struct Atlas {
  Picture base_colour;
  Picture emission;  // sRGB; multiplied by the material's emissive strength
};

inline constexpr float pane_strength_cd_m2 = 75.0f;
inline constexpr float shopfront_strength_cd_m2 = 34.0f;
inline constexpr float sign_strength_cd_m2 = 120.0f;

// 4 x 4 windows: 0..11 lit, 12..15 dark with curtains.
inline constexpr int lit_panes = 12;
inline constexpr int dark_panes = 4;
Atlas pane_atlas();
UvRect pane_rect(int index);

// 2 x 2 shop windows.
enum class Goods { books, cafe, bakery, tailor };
Atlas shopfront_atlas();
UvRect goods_rect(Goods);

enum class Sign {
  books,
  cafe,
  bakery,
  tailor,
  antiques,
  wines,
  clocks,
  florist,
  barber,
  pharmacy,
  toys,
  street_main,
  street_cross,
  bus_stop,
  news,
  telephone,
  hotel,
  number_plate,
  poster_concert,
  poster_sea,
  clock_face,
  hanging_bear,
  taxi,
  cinema,
  count
};
Atlas sign_atlas();
UvRect sign_rect(Sign);
float sign_aspect(Sign);  // width over height

}  // namespace petrichor::city
