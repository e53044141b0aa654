#pragma once
// A small street that has every kind of shelter: what charts and stability tests of occlusion ask about.

#include <memory>
#include <string>
#include <vector>

#include "engine/assets/model.hpp"
#include "systems/occlusion/stage.hpp"

namespace petrichor {

constexpr float awning_height_m = 3.0f;  // lower edge of the free-standing roof

// Ground, a free-standing roof of 4 x 8 m at 3 m, a house with an awning on either side, a bridge with a deck at 5 m,
// an arcade open towards -x. Along x the wind meets the roof's long edges.
std::shared_ptr<const Model> shelter_street();

// One of "awning", "house", "walls", "bridge", "arcade": places on surfaces under and around it, evenly in a
// lattice of about step_m.
std::vector<ShelterQuestion> shelter_places(const std::string& where, float step_m);

}  // namespace petrichor
