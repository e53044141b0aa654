#pragma once
// Houses on their plots: what rows of houses and corner houses share.

#include <array>
#include <glm/glm.hpp>
#include <string>

#include "content/city/facade.hpp"
#include "content/city/scene.hpp"

namespace petrichor::city {

inline constexpr float corner_facade_m = 10.0f;  // from the cut corner along either street

struct Frontage {
  glm::vec3 from, to;  // along the wall, away from the crossing
  glm::vec3 out;
};

// The wall frame of the plot from a to c metres along a frontage.
glm::mat4 plot_frame(const Frontage&, float a, float c);

// A corner house: three facades round a cut corner, under a mansard that follows them or a terrace to stand on.
void add_corner(Scene&, const std::string& name, int sx, int sz, Style, const std::array<Facade, 3>& grounds,
                std::uint32_t seed);

}  // namespace petrichor::city
