#pragma once
// Simple toys, standing at the builder's origin on y = 0, about `size` metres tall.

#include "content/city/builder.hpp"
#include "content/city/dice.hpp"

namespace petrichor::city {

void ball(Builder, float size, glm::vec3 a, glm::vec3 c);
void bear(Builder, float size, glm::vec3 fur);
void train(Builder, float size, glm::vec3 colour);
void blocks(Builder, float size, Dice&);
void drum(Builder, float size, glm::vec3 colour);
void soldier(Builder, float size, glm::vec3 coat);
void house_toy(Builder, float size, glm::vec3 roof);
void rocking_horse(Builder, float size);
void carousel(Builder, float size);
void any_toy(Builder, float size, Dice&);
void sphere(Builder&, const Paint&, glm::vec3 centre, glm::vec3 radii, int around = 8, int up = 5);

}  // namespace petrichor::city
