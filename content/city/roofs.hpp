#pragma once
// Roofs over a rectangular house in its wall frame: x in [0, width], z from 0 (facade) to -depth.

#include "content/city/facade.hpp"

namespace petrichor::city {

struct RoofSpan {
  float width_m, depth_m, eaves_m;
};

void saddle_roof(Builder&, const Style&, RoofSpan, glm::vec3 tint, Dice&);
void mansard_roof(Builder&, const Style&, RoofSpan, glm::vec3 tint, Dice&);
void flat_roof(Builder&, const Style&, RoofSpan, Dice&);
void stepped_gable(Builder&, const Style&, RoofSpan, glm::vec3 tint, Dice&);
void gutter(Builder&, float x0, float x1, float y, float z);
void chimney(Builder&, glm::vec3 foot, float height, int pots);
void dormer(Builder&, const Style&, float x, float y, float z, float slope, glm::vec3 tint, Dice&);

}  // namespace petrichor::city
